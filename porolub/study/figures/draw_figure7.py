"""Figures 7a and 7b of the paper: friction, load ratio and lengths over the Sommerfeld number."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from porolub.io.figure import BLUE, GREEN, VERMILLION, label, new_figure, tidy
from porolub.solve.report import Array
from porolub.study.figures.draw_quantities import (
    APPROACH,
    CONTACT_LENGTH,
    FILM_MIN,
    FRICTION,
    FRICTION_FLUID,
    LOAD_RATIO,
    PENETRATION,
    bracketed,
)
from porolub.study.figures.draw_regimes import draw_bands, legend_above, note_below
from porolub.study.figures.draw_stribeck import (
    by_sommerfeld,
    left_out,
    sommerfeld_axis,
    stribeck_lines,
    varies,
)
from porolub.study.figures.log_axis import figures, log_limits, positive
from porolub.study.figures.view import Line, View

_ZERO = 1e-12  # m; a gap in contact is zero but for rounding


def draw_figure7(view: View) -> dict[str, Figure]:
    """Return figure7a.png and figure7b.png; none where the sweep is not a single curve."""
    lines = stribeck_lines(view)
    if len(lines) != 1 or not varies(view.sommerfeld):
        return {}
    line = by_sommerfeld(view, lines[0])
    drawn = np.isfinite(view.sommerfeld)
    made = {"figure7a.png": _friction(view, line), "figure7b.png": _lengths(view, line)}
    for figure, zeros in zip(made.values(), _HIDDEN, strict=True):
        if figure is not None:
            note_below(figure, zeros, left_out(view, drawn))
    return {name: figure for name, figure in made.items() if figure is not None}


_HIDDEN = (
    "Without contact there is no load ratio.",
    "Zeros are not shown: b without contact, $b_0$ while standing off, $h_{min}$ in contact.",
)


def _friction(view: View, line: Line) -> Figure | None:
    values = [positive(view.values(q)[line.rows]) for q in (FRICTION, FRICTION_FLUID)]
    if not any(np.isfinite(v).any() for v in values):
        return None
    figure, ax = _axes(view, line, "Friction and load ratio", np.concatenate(values))
    handles = []
    for quantity, y, colour, style in zip(
        (FRICTION, FRICTION_FLUID), values, (VERMILLION, BLUE), ("-", "--"), strict=True
    ):
        handles += _curve(ax, view, line, y, colour, style, quantity.name)
    label(ax, y="friction coefficients $μ$, $μ_f$")
    # without contact it is a quotient by what rounding leaves of zero
    touching = view.values(FILM_MIN)[line.rows] <= _ZERO
    ratio = np.where(touching, positive(view.values(LOAD_RATIO)[line.rows]), np.nan)
    if np.isfinite(ratio).any():
        right = ax.twinx()
        tidy(right)
        handles += _curve(right, view, line, ratio, GREEN, "-.", LOAD_RATIO.name)
        limits = log_limits(ratio, 0.1, 0.3)
        right.set_yscale("log")
        right.set_ylim(limits)
        figures(right.yaxis, limits)
        label(right, y=LOAD_RATIO.name, colour=GREEN)
    else:
        ax.spines["right"].set_visible(False)
    legend_above(ax, handles, columns=3)
    return figure


def _lengths(view: View, line: Line) -> Figure | None:
    quantities = (CONTACT_LENGTH, PENETRATION, FILM_MIN)
    values = [view.values(q)[line.rows] for q in quantities]
    values = [np.where(v > _ZERO, v, np.nan) for v in values]
    approach = view.values(APPROACH)[line.rows]
    all_values = np.concatenate([*values, positive(np.abs(approach))])
    if not np.isfinite(all_values).any():
        return None
    unit = view.unit(*quantities, APPROACH, logarithmic=True)
    figure, ax = _axes(view, line, "Lengths", all_values / unit.size)
    handles = []
    for quantity, y, colour, style in zip(
        quantities, values, (VERMILLION, GREEN, BLUE), ("-", "--", "-."), strict=True
    ):
        handles += _curve(ax, view, line, y / unit.size, colour, style, quantity.name)
    for sign, face, name in ((1.0, "black", "$|v_0|$, pressed in"),
                             (-1.0, "white", "$|v_0|$, standing off")):  # fmt: skip
        y = positive(sign * approach) / unit.size  # in two: its size passes through zero
        handles += _curve(ax, view, line, y, "black", ":", name, face)
    label(ax, y=bracketed("lengths", unit))
    ax.spines["right"].set_visible(False)
    legend_above(ax, handles, columns=3)
    return figure


def _axes(view: View, line: Line, what: str, y: Array) -> tuple[Figure, Axes]:
    figure, (ax,) = new_figure(f"{what} over the Sommerfeld number ({view.title})", legend=True)
    limits = log_limits(y, 0.05, 0.14)
    ax.set_yscale("log")
    ax.set_ylim(limits)
    figures(ax.yaxis, limits)
    x = view.sommerfeld[line.rows]
    sommerfeld_axis(ax, x)
    draw_bands(ax, x, view.regime[line.rows])
    return figure, ax


def _curve(ax: Axes, view: View, line: Line, y: Array, colour: str, style: str, name: str,
           face: str | None = None) -> list[Any]:  # fmt: skip
    """A curve through the cases that have the value; gone from the legend where none has."""
    if not np.isfinite(y).any():
        return []
    return ax.plot(view.sommerfeld[line.rows], y, color=colour, lw=2, ls=style, marker="o", ms=5,
                   mfc=face or colour, label=name)  # fmt: skip
