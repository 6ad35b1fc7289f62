"""The Stribeck curve: friction over the Sommerfeld number, one curve or a family of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from porolub.io.figure import BLUE, GREEN, GREY, VERMILLION, label, new_figure
from porolub.io.words import digits
from porolub.solve.report import Array
from porolub.study.figures.draw_quantities import FRICTION, bracketed, suited
from porolub.study.figures.draw_regimes import (
    COLOURS,
    MARKERS,
    ORANGE,
    band_handles,
    draw_bands,
    known,
    legend_above,
    marker_handles,
    note_below,
)
from porolub.study.figures.log_axis import figures, log_limits, positive
from porolub.study.figures.view import Line, View

SOMMERFELD = "Sommerfeld number $ηU/L$"
_SAME = 1.01  # Sommerfeld numbers that differ by less make no curve
_NAMED = 10  # lines in a legend
LINE_COLOURS = (
    BLUE, VERMILLION, GREEN, "#CC79A7", ORANGE, "#56B4E9", GREY, "#000000"
)  # fmt: skip


def draw_stribeck(view: View) -> Figure | None:
    """Draw friction over the Sommerfeld number, both logarithmic; None where there is no curve.

    One curve stands before bands of its regimes; of several axes there is one curve for each
    combination of the others than the one it runs along, and markers tell the regimes.
    """
    lines = stribeck_lines(view)
    x, y = view.sommerfeld, positive(view.values(FRICTION))
    drawn = np.isfinite(x) & np.isfinite(y)
    if not lines or not varies(x[drawn]):
        return None
    figure, (ax,) = new_figure(f"Friction over the Sommerfeld number ({view.title})", legend=True)
    _set_up(ax, x[drawn], y[drawn])
    if len(lines) == 1:
        _one(ax, view, lines[0])
    else:
        _family(figure, ax, view, lines)
    note_below(figure, left_out(view, drawn))
    return figure


def stribeck_lines(view: View) -> list[Line]:
    """Return the lines along the last axis of numbers on which the Sommerfeld number changes.

    Without such an axis each case is a line of its own, and of axes of numbers that do not change
    it there are none.
    """
    numeric = view.numeric
    for k in reversed(numeric):
        lines = list(view.lines(k))
        if any(varies(view.sommerfeld[line.rows]) for line in lines):
            return lines
    if numeric:
        return []
    places = [{k: int(row[k]) for k in view.varied} for row in view.positions]
    return [Line(np.array([n]), view.words(fixed), fixed) for n, fixed in enumerate(places)]


def varies(x: Array) -> bool:
    """Return whether Sommerfeld numbers (NaN left out) make a curve."""
    known = x[np.isfinite(x)]
    return len(known) > 1 and bool(known.max() > _SAME * known.min())


def by_sommerfeld(view: View, line: Line, *shown: Array) -> Line:
    """Return the line in the order of Sommerfeld number, without cases that are not ``shown``.

    shown: (n,) values of the view; NaN in any of them, or no Sommerfeld number, leaves a case out.
    """
    rows = line.rows
    for values in (view.sommerfeld, *shown):
        rows = rows[np.isfinite(values[rows])]
    rows = rows[np.argsort(view.sommerfeld[rows], kind="stable")]
    return Line(rows, line.name, line.fixed)


def left_out(view: View, drawn: Any) -> str:
    """Return a sentence on the cases that a figure does not show; "" if there are none."""
    failed, others = int((~view.converged).sum()), int((view.converged & ~drawn).sum())
    parts = []
    if failed:
        parts.append(f"{failed} failed")
    if others:
        parts.append(f"{others} without load, film or friction")
    return f"Left out of {len(drawn)} cases: {', '.join(parts)}." if parts else ""


def sommerfeld_axis(ax: Axes, x: Array) -> None:
    """Make the x axis one of Sommerfeld numbers."""
    limits = log_limits(x)
    ax.set_xscale("log")
    ax.set_xlim(limits)
    figures(ax.xaxis, limits)
    label(ax, SOMMERFELD)


def _set_up(ax: Axes, x: Array, y: Array) -> None:
    limits = log_limits(y, below=0.16, above=0.16)
    ax.set_yscale("log")
    ax.set_ylim(limits)
    figures(ax.yaxis, limits)
    sommerfeld_axis(ax, x)
    label(ax, y=FRICTION.name)
    ax.spines["right"].set_visible(False)


def _one(ax: Axes, view: View, line: Line) -> None:
    friction = positive(view.values(FRICTION))
    rows = by_sommerfeld(view, line, friction).rows
    x, y, regimes = view.sommerfeld[rows], friction[rows], view.regime[rows]
    draw_bands(ax, x, regimes)
    ax.plot(x, y, color="black", lw=1.5, zorder=2)
    for regime in (*known(regimes), ""):
        mine = regimes == regime
        ax.plot(x[mine], y[mine], ls="", marker=MARKERS[regime], ms=7, zorder=3,
                color=COLOURS.get(regime, "black"))  # fmt: skip
    _minimum(ax, x, y)
    legend_above(ax, band_handles(regimes))


def _minimum(ax: Axes, x: Array, y: Array, name: str = "") -> None:
    at = int(np.argmin(y))
    ax.plot(x[at], y[at], "o", ms=15, mfc="none", mec=VERMILLION, mew=2, zorder=4)
    place = ax.transAxes.inverted().transform(ax.transData.transform((x[at], y[at])))[0]
    side = "left" if place < 0.15 else "right" if place > 0.85 else "center"
    ax.annotate(
        f"minimum μ = {digits(y[at])} at {_power(x[at])}{name}", (x[at], y[at]), (0, -14),
        textcoords="offset points", ha=side, va="top", fontsize=12, color=VERMILLION,
    )  # fmt: skip


def _power(value: float) -> str:
    mantissa, exponent = f"{value:.2e}".split("e")
    return f"${mantissa}\\cdot 10^{{{int(exponent)}}}$"


def _family(figure: Figure, ax: Axes, view: View, lines: list[Line]) -> None:
    friction = positive(view.values(FRICTION))
    colours, handles = _colours(figure, ax, view, lines)
    lowest: tuple[float, float, str] | None = None
    for line, colour in zip(lines, colours, strict=True):
        rows = by_sommerfeld(view, line, friction).rows
        x, y, regimes = view.sommerfeld[rows], friction[rows], view.regime[rows]
        ax.plot(x, y, color=colour, lw=1.5, zorder=2)
        for regime in (*known(regimes), ""):
            mine = regimes == regime
            ax.plot(x[mine], y[mine], ls="", marker=MARKERS[regime], ms=6, color=colour, zorder=3)
        if len(y) and (lowest is None or y.min() < lowest[1]):
            at = int(np.argmin(y))
            lowest = float(x[at]), float(y[at]), line.name
    if lowest is not None:
        _minimum(ax, np.array([lowest[0]]), np.array([lowest[1]]), f" ({lowest[2]})")
    handles += marker_handles(view.regime[np.isfinite(friction)])
    legend_above(ax, handles)


def _colours(
    figure: Figure, ax: Axes, view: View, lines: list[Line]
) -> tuple[list[Any], list[Any]]:
    """Colour of each line and handles for the legend; a colour bar instead where that suits."""
    others = list(lines[0].fixed)
    if len(others) == 1 and others[0] in view.numeric:
        k = others[0]
        axis = view.axes[k]
        logarithmic = axis.scale == "log"
        everywhere = np.asarray(axis.numbers, float)
        unit = suited(axis.unit, everywhere, logarithmic=logarithmic)
        values = everywhere / unit.size
        norm = (LogNorm if logarithmic else Normalize)(values.min(), values.max())
        scale = ScalarMappable(norm, "viridis")
        bar = figure.colorbar(scale, ax=ax, pad=0.02, aspect=30)
        bar.set_label(bracketed(view.axis_name(k), unit), fontsize=13)
        bar.ax.tick_params(labelsize=11)
        return [scale.to_rgba(values[line.fixed[k]]) for line in lines], []
    colours = [LINE_COLOURS[n % len(LINE_COLOURS)] for n in range(len(lines))]
    handles: list[Any] = [Line2D([], [], color=colour, lw=2, label=line.name)
                          for colour, line in zip(colours, lines, strict=True)]  # fmt: skip
    if len(handles) > _NAMED:
        more = Line2D([], [], ls="", label=f"and {len(handles) - _NAMED} more")
        handles = [*handles[:_NAMED], more]
    return colours, handles
