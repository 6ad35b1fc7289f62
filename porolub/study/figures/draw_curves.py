"""Small multiples: the main results of a sweep over the axis it runs along."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from porolub.io.figure import BLUE, GREY, VERMILLION, heading, tidy
from porolub.io.words import Unit
from porolub.solve.report import Array
from porolub.study.figures.draw_quantities import (
    APPROACH,
    CONTACT_LENGTH,
    CONTACT_PRESSURE_MAX,
    FILM_MIN,
    FLUID_SHARE,
    FRICTION,
    FRICTION_FLUID,
    INFLOW,
    LOAD,
    OUTFLOW,
    PENETRATION,
    PRESSURE_MAX,
    Quantity,
    bracketed,
    plain,
    suited,
)
from porolub.study.figures.draw_regimes import band_handles, draw_bands, note_below
from porolub.study.figures.draw_stribeck import LINE_COLOURS
from porolub.study.figures.log_axis import figures, log_limits
from porolub.study.figures.view import View

_PAIRS = (
    ("friction coefficients", ((FRICTION, "μ"), (FRICTION_FLUID, "film $μ_f$"))),
    ("fluid share of the load", ((FLUID_SHARE, ""),)),
    ("load L", ((LOAD, ""),)),
    ("approach $v_0$", ((APPROACH, ""),)),
    ("least film thickness $h_{min}$", ((FILM_MIN, ""),)),
    ("contact length", ((CONTACT_LENGTH, "contact b"), (PENETRATION, "penetration $b_0$"))),
    ("highest pressure", ((PRESSURE_MAX, "fluid"), (CONTACT_PRESSURE_MAX, "contact"))),
    ("flow through the surface", ((INFLOW, "in"), (OUTFLOW, "out"))),
)
_STYLES = ("-", "--")
_WIDE = 30.0  # positive values that span more go on a logarithmic axis
_MOST = 12  # lines; more cannot be told apart
_FONT = 11
_SAME = 1e-6
_LONG = 16  # letters of a category under an axis


@dataclass(frozen=True)
class _Along:
    """The axis the curves run along, and its values in ``unit``."""

    k: int
    name: str
    unit: Unit
    x: Array
    scale: str
    texts: tuple[str, ...]


def draw_curves(view: View) -> Figure | None:
    """Draw panels over the one axis of numbers, a line for each combination of categories.

    Without numbers the categories of the last axis stand side by side. None with two or more axes
    of numbers and where nothing converged.
    """
    if len(view.numeric) > 1 or not view.converged.any():
        return None
    along = _along(view)
    shown = [(name, pairs) for name, pairs in _PAIRS if _tells(view, along, pairs)]
    if not shown:
        return None
    figure = Figure(figsize=(16, 8.2), dpi=100, layout="constrained")
    FigureCanvasAgg(figure)
    cells = len(shown) + 1  # one for the legend
    columns = min(cells, 4 if cells <= 8 else 5)
    grid = figure.subplots(-(-cells // columns), columns, squeeze=False).ravel()
    heading(figure, f"Results over {along.name} ({view.title})")
    lines = [line for line in view.lines(along.k) if view.converged[line.rows].any()]
    for ax, (name, pairs) in zip(grid, shown, strict=False):
        _panel(ax, view, along, name, pairs)
    for ax in grid[len(shown) :]:
        ax.set_axis_off()
    _legend(grid[len(shown)], view, along, [line.name for line in lines])
    failed = int((~view.converged).sum())
    more = len(lines) - _MOST
    note_below(
        figure,
        f"{failed} of {len(view.rows)} cases failed and are left out." if failed else "",
        f"{more} more lines are left out; see table.csv." if more > 0 else "",
    )
    return figure


def _along(view: View) -> _Along:
    k = [len(view.axes) - 1, *view.varied, *view.numeric][-1]
    axis, values = view.axes[k], view.along(k)
    if axis.numbers is None:
        texts = tuple(plain(text[:_LONG]) for text in axis.texts)
        return _Along(k, view.axis_name(k), Unit("", 1.0), values, "", texts)
    unit = suited(axis.unit, values, logarithmic=axis.scale == "log")
    return _Along(k, view.axis_name(k), unit, values / unit.size, axis.scale, ())


def _tells(view: View, along: _Along, pairs: tuple[tuple[Quantity, str], ...]) -> bool:
    """Whether a panel has something to show: not only zeros, and no repetition of the axis.

    Of load and approach one is given; a load that is the same everywhere is given, too.
    """
    quantity = pairs[0][0]
    values = [view.values(q) for q, _ in pairs]
    if not any(np.nan_to_num(v).any() for v in values):
        return False
    if quantity not in (LOAD, APPROACH):
        return True
    given, x = values[0], along.x * along.unit.size
    known_ = given[np.isfinite(given)]
    if len(view.rows) > 1 and len(known_) > 1 and np.ptp(known_) <= _SAME * np.abs(known_).max():
        return False
    repeats = np.abs(given - x) <= 1e-3 * np.maximum(np.abs(x), 1e-12)
    return not (along.scale and repeats[np.isfinite(given)].all())


def _panel(ax: Axes, view: View, along: _Along, name: str,
           pairs: tuple[tuple[Quantity, str], ...]) -> None:  # fmt: skip
    tidy(ax)
    ax.spines["right"].set_visible(False)
    everything = np.concatenate([view.values(q) for q, _ in pairs])
    logarithmic = _wide(everything)
    unit = view.unit(*(q for q, _ in pairs), logarithmic=logarithmic)
    ax.set_title(bracketed(name, unit), loc="left", fontsize=12)
    _x_axis(ax, along)
    _y_axis(ax, everything / unit.size, logarithmic, above=0.06 if along.scale else 0.25)
    lines = [line for line in view.lines(along.k) if view.converged[line.rows].any()][:_MOST]
    single = len(lines) == 1
    for n, line in enumerate(lines):
        rows = line.rows[view.converged[line.rows]]
        for (quantity, words), style, colour in zip(
            pairs, _STYLES, (VERMILLION, BLUE), strict=False
        ):
            ax.plot(
                along.x[rows], view.values(quantity)[rows] / unit.size,
                marker="o", lw=1.8, ms=3.5 if along.scale else 8,
                color=colour if single else LINE_COLOURS[n % len(LINE_COLOURS)],
                ls=style if along.scale else "", label=words if n == 0 else "_",
                mfc=None if style == "-" else "white" if along.scale else "none",
            )  # fmt: skip
    if single and along.scale:
        rows = lines[0].rows[view.converged[lines[0].rows]]
        draw_bands(ax, along.x[rows], view.regime[rows], names=False)
    if any(words for _, words in pairs):
        ax.legend(fontsize=10, loc="best", framealpha=0.8, edgecolor="none", handlelength=2.4)


def _wide(values: Array) -> bool:
    found = values[np.isfinite(values)]
    return bool(len(found)) and bool(found.min() > 0 and found.max() > _WIDE * found.min())


def _x_axis(ax: Axes, along: _Along) -> None:
    ax.set_xlabel(bracketed(along.name, along.unit), fontsize=12)
    ax.tick_params(labelsize=_FONT)
    if along.scale == "log":
        limits = log_limits(along.x)
        ax.set_xscale("log")
        ax.set_xlim(limits)
        figures(ax.xaxis, limits)
        return
    low, high = float(along.x.min()), float(along.x.max())
    margin = 0.05 * (high - low) or 0.5
    ax.set_xlim(low - margin, high + margin)
    if not along.scale:
        ax.set_xlim(-0.5, len(along.texts) - 0.5)
        ax.set_xticks(range(len(along.texts)), along.texts)
    else:
        ax.xaxis.set_major_locator(MaxNLocator(6))


def _y_axis(ax: Axes, values: Array, logarithmic: bool, above: float) -> None:
    """``above``: room over the highest value, where a legend may lie, as a part of the range."""
    if logarithmic:
        limits = log_limits(values, above=above)
        ax.set_yscale("log")
        ax.set_ylim(limits)
        figures(ax.yaxis, limits)
        return
    found = values[np.isfinite(values)]
    low, high = min(0.0, float(found.min())), max(0.0, float(found.max()))
    ax.set_ylim(low - 0.06 * (high - low), high + above * (high - low))
    ax.axhline(0, color=GREY, lw=0.8, zorder=0)


def _legend(ax: Axes, view: View, along: _Along, names: list[str]) -> None:
    """What colours stand for: categories, or regimes behind a single curve."""
    handles: list[Any] = []
    if len(names) > 1:
        handles = [Line2D([], [], color=LINE_COLOURS[n % len(LINE_COLOURS)], lw=2, label=name)
                   for n, name in enumerate(names[:_MOST])]  # fmt: skip
    elif along.scale:
        handles = band_handles(view.regime, between=":\n")
    if handles:
        ax.legend(handles=handles, loc="center left", fontsize=12, frameon=False, labelspacing=0.8)
