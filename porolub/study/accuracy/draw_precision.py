"""precision.png: what accuracy costs; error over wall time and over unknowns or steps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator

from porolub.io.figure import CONTACT_ZONE, heading, label, tidy
from porolub.study.accuracy.measured import Floats, Measured, Trial
from porolub.study.accuracy.tables import level_name
from porolub.study.figures.draw_stribeck import LINE_COLOURS
from porolub.study.figures.log_axis import figures, log_limits, positive

if TYPE_CHECKING:
    from porolub.study.accuracy.study import Study

MOST = 4  # quantities side by side
_MARKERS = "osD^vP*X"
_NAMES = {"friction_coefficient": "friction coefficient", "load_fluid": "fluid load",
          "load_solid": "solid load", "load_total": "load"}  # fmt: skip


def draw_precision(study: Study) -> Figure:
    """Draw the errors of at most MOST quantities, a column each, a line for each strategy."""
    shown = study.found[:MOST]
    figure = Figure(figsize=(12, 7), dpi=100, layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(2, len(shown), sharey="col", squeeze=False)
    strategies = list(dict.fromkeys(t.setting.strategy for t in study.trials))
    costs = (("wall time [s]", np.array([t.wall for t in study.trials])), _work(study))
    for column, found in enumerate(shown):
        for row, (name, cost) in enumerate(costs):
            ax = grid[row, column]
            _panel(ax, study.trials, strategies, cost, found)
            label(ax, name, f"error [{'%' if found.relative else 'SI'}]")
            if row == 0:
                ax.set_title(_name(found), fontsize=13)
    heading(figure, f"What accuracy costs ({study.title})")
    handles: list[Any] = [
        Line2D([], [], color=_colour(n), marker=_marker(n), lw=1.5, ms=7, label=name)
        for n, name in enumerate(strategies)
    ]
    handles.append(Patch(facecolor=CONTACT_ZONE, label="below what is known of the limit"))
    figure.legend(handles=handles, loc="outside lower center", ncols=min(len(handles), 5),
                  fontsize=11, frameon=False)  # fmt: skip
    return figure


def _work(study: Study) -> tuple[str, Floats]:
    """What the levels refine, as a number that grows with it."""
    unknowns = np.array([t.unknowns for t in study.trials])
    steps = np.array([t.steps for t in study.trials])
    kind = level_name(study.varied)
    if kind == "mesh":
        return "unknowns", unknowns
    return ("steps", steps) if kind == "tolerance" else ("unknowns x steps", unknowns * steps)


def _panel(ax: Axes, trials: Sequence[Trial], strategies: Sequence[str], cost: Floats,
           found: Measured) -> None:  # fmt: skip
    tidy(ax)
    ax.spines["right"].set_visible(False)
    percents = 100.0 if found.relative else 1.0
    floor = found.uncertain * percents if np.isfinite(found.uncertain) else 0.0
    errors = positive(np.maximum(found.errors * percents, floor))  # less is not known
    drawn = np.isfinite(errors) & np.isfinite(positive(cost))
    for n, strategy in enumerate(strategies):
        mine = drawn & np.array([t.setting.strategy == strategy for t in trials])
        ax.plot(cost[mine], errors[mine], color=_colour(n), marker=_marker(n), lw=1.5, ms=7)
    x, y = log_limits(cost[drawn]), log_limits(errors[drawn])
    ax.set(xscale="log", yscale="log", xlim=x, ylim=y)
    figures(ax.xaxis, x)
    ax.xaxis.set_major_locator(LogLocator(subs=_few(x[1] / x[0])))
    figures(ax.yaxis, y)
    ax.grid(True, which="major", color="#E0E0E0", lw=0.6, zorder=0)
    if y[0] < floor:
        ax.axhspan(y[0], min(floor, y[1]), color=CONTACT_ZONE, lw=0, zorder=-2)


def _few(ratio: float) -> tuple[float, ...]:
    """Figures of a decade there is room for on a narrow axis whose ends have this ratio."""
    if ratio < 4:
        return (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)
    return (1.0, 2.0, 5.0) if ratio < 20 else (1.0, 3.0) if ratio < 1000 else (1.0,)


def _name(found: Measured) -> str:
    name, _, which = found.quantity.partition(".")
    words = _NAMES.get(name, name.replace("_", " "))
    return f"{words}, {which}" if which else words


def _colour(n: int) -> str:
    return LINE_COLOURS[n % len(LINE_COLOURS)]


def _marker(n: int) -> str:
    return _MARKERS[n % len(_MARKERS)]
