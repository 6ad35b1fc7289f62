"""effects.png: unknowns, Newton iterations and times with the effects added one at a time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from porolub.io.figure import BLUE, GREEN, GREY, VERMILLION, heading, label, tidy
from porolub.study.accuracy.effects_table import Cost
from porolub.study.accuracy.measured import Floats


def draw_effects(title: str, found: Sequence[Cost]) -> Figure:
    """Draw a bar for each step, effects from top to bottom: unknowns, iterations, times."""
    figure = Figure(figsize=(12, 7), dpi=100, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(1, 4, sharey=True)
    places = np.arange(float(len(found)))
    _bars(axes[0], places, _column(found, "unknowns"), BLUE, "unknowns")
    _bars(axes[1], places, _column(found, "newton_iterations"), GREY, "Newton iterations")
    _bars(axes[2], places, _column(found, "wall"), GREEN, "wall time [s]")
    assembly = 1e3 * _column(found, "assembly")
    solve = 1e3 * _column(found, "linear_solve")
    axes[3].barh(places, assembly, color=VERMILLION, label="assembly")
    axes[3].barh(places, solve, left=assembly, color=BLUE, label="linear solve")
    label(axes[3], "a Newton iteration [ms]")
    figure.legend(loc="outside lower right", ncols=2, fontsize=11, frameon=False)
    _finish(axes[3])
    axes[0].set_yticks(places, [c.effects if c.converged else f"{c.effects}\n({c.status})"
                                for c in found], fontsize=12)  # fmt: skip
    axes[0].invert_yaxis()
    heading(figure, f"What the effects cost ({title})")
    return figure


def _column(found: Sequence[Cost], name: str) -> Floats:
    return np.array([getattr(cost, name) for cost in found], float)


def _bars(ax: Axes, places: Floats, values: Floats, colour: str, name: str) -> None:
    bars = ax.barh(places, np.nan_to_num(values), color=colour)
    texts = ["" if np.isnan(v) else f"{v:,.0f}" if v >= 100 else f"{v:.3g}" for v in values]
    ax.bar_label(bars, texts, padding=3, fontsize=11)
    label(ax, name)
    _finish(ax)


def _finish(ax: Axes) -> None:
    tidy(ax)
    ax.spines["right"].set_visible(False)
    ax.set_xlim(right=1.22 * max(ax.get_xlim()[1], 1e-9))
    ax.locator_params(axis="x", nbins=4)
