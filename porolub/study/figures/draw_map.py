"""Maps of a sweep over two axes: filled contours, the cases, and where regimes meet."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from porolub.io.figure import CONTACT_ZONE, VERMILLION, label, new_figure
from porolub.solve.report import Array
from porolub.study.figures.draw_quantities import (
    CONTACT_LENGTH,
    FILM_MIN,
    FLUID_SHARE,
    FRICTION,
    PRESSURE_MAX,
    Quantity,
    bracketed,
)
from porolub.study.figures.draw_regimes import known, legend_above, note_below
from porolub.study.figures.log_axis import figures, log_limits
from porolub.study.figures.map_grid import Grid, Side, regime_numbers, roomiest
from porolub.study.figures.view import View
from porolub.study.work.regimes import CRITERIA, REGIMES

MAPPED = {
    "friction_coefficient": FRICTION,
    "fluid_share": FLUID_SHARE,
    "film_min": FILM_MIN,
    "contact_length": CONTACT_LENGTH,
    "pressure_max": PRESSURE_MAX,
}
"""What is mapped, by the name in the file's name, the most important first."""
_NOTHING = {FILM_MIN: "contact: no film", CONTACT_LENGTH: "no contact"}
_WIDE = 20.0  # positive values that span more have logarithmic levels
_BANDS = 12
_MANY = 1500  # cases; more points would hide the map
_HALO = [withStroke(linewidth=3, foreground="white")]


@dataclass(frozen=True)
class _Levels:
    """Boundaries of the colours; on ``logarithmic`` ones values are logarithms to draw with.

    ``least``: the lowest value above zero where zero means that there is none of it, else None.
    """

    values: Array
    logarithmic: bool
    least: float | None = None


def draw_map(view: View, axes: tuple[int, int], quantity: Quantity) -> Figure | None:
    """Draw a quantity over two of the axes; None where it does not vary or too few converged."""
    grid = Grid.of(view, *axes)
    unit = view.unit(quantity)
    values = view.values(quantity) / unit.size
    levels = _levels(values, quantity in _NOTHING)
    if levels is None or not _has_area(grid.on_grid(values)):
        return None
    figure, (ax,) = new_figure(f"{_plain(quantity)} ({view.title})", legend=True)
    _side(ax, grid.x, "x")
    _side(ax, grid.y, "y")
    handles = _fill(figure, ax, grid, values, levels, quantity, bracketed(quantity.name, unit))
    _regimes(ax, grid, view)
    handles += _cases(ax, grid, view)
    legend_above(ax, handles, columns=4)
    note_below(figure, _criteria(view))
    return figure


def _plain(quantity: Quantity) -> str:
    """Titles are the user's text, without mathematics."""
    words = quantity.name.split(" $")[0]
    return words[0].upper() + words[1:].removesuffix(" μ").removesuffix(" b").removesuffix(" p")


def _criteria(view: View) -> str:
    """What the names of regimes stand for, in two lines."""
    notes = [f"{name}: {CRITERIA[name]}" for name in known(view.regime.tolist())]
    return "\n".join(filter(None, (".   ".join(notes[:2]), ".   ".join(notes[2:]))))


def _has_area(values: Array) -> bool:
    known = np.isfinite(values)
    return bool((known[1:, 1:] & known[:-1, 1:] & known[1:, :-1] & known[:-1, :-1]).any())


def _levels(values: Array, may_vanish: bool) -> _Levels | None:
    found = values[np.isfinite(values)]
    if len(found) < 4 or np.ptp(found) <= 1e-6 * np.abs(found).max():
        return None
    least = None
    if may_vanish and found.max() <= 0:
        return None
    if may_vanish and found.min() <= 1e-9 * found.max():
        found = found[found > 1e-9 * found.max()]
        least = float(found.min())
    low, high = float(found.min()), float(found.max())
    if low > 0 and high > _WIDE * low:
        return _Levels(_log_levels(low, high), True, least)
    if least is not None:  # from zero on, so that the edge has a colour of its own
        low = 0.0
    ticks = MaxNLocator(_BANDS, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    return _Levels(np.asarray(ticks), False, least)


def _log_levels(low: float, high: float) -> Array:
    """1, 2, 5, 10, ... (or whole decades) from below to above."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    steps = (1, 2, 5) if len(decades) < 7 else (1,)
    levels = np.array([step * 10.0**d for d in decades for step in steps])
    first = max(int(np.searchsorted(levels, low * (1 + 1e-9), "right")) - 1, 0)
    last = int(np.searchsorted(levels, high * (1 - 1e-9)))
    return levels[first : last + 1]


def _fill(figure: Figure, ax: Axes, grid: Grid, values: Array, levels: _Levels,
          quantity: Quantity, name: str) -> list[Patch | Line2D]:  # fmt: skip
    """Paint the colours with lines between them; where there is none of it, it is grey."""
    bounds = list(np.log10(levels.values) if levels.logarithmic else levels.values)
    shown = values
    if levels.logarithmic:
        shown = np.log10(values if levels.least is None else np.maximum(values, levels.least / 2))
    x, y, z = grid.finer(shown)
    rim = 1e-6 * (bounds[-1] - bounds[0])  # what lies on the lowest bound has its colour, too
    z = np.ma.masked_invalid(np.clip(z, bounds[0] + rim, bounds[-1] - rim))
    painted = ax.contourf(x, y, z, bounds, cmap="viridis", norm=BoundaryNorm(bounds, 256),
                          zorder=0)  # fmt: skip
    handles: list[Patch | Line2D] = []
    if levels.least is not None:
        there = grid.finer(np.where(np.isnan(values), np.nan, values >= levels.least))[2]
        ax.contourf(x, y, np.ma.masked_invalid(there), [-0.5, 0.5], colors=[CONTACT_ZONE],
                    zorder=0.5)  # fmt: skip
        z = np.ma.masked_where(np.nan_to_num(there, nan=1.0) < 0.5, z)
        handles.append(Patch(color=CONTACT_ZONE, label=_NOTHING[quantity]))
    figures_at = {float(b): f"{v:.4g}" for b, v in zip(bounds, levels.values, strict=True)}
    lines = ax.contour(x, y, z, bounds[1:-1], colors="black", linewidths=0.6, linestyles="-",
                       alpha=0.7, zorder=1)  # fmt: skip
    for text in ax.clabel(lines, fmt=figures_at, fontsize=10, inline_spacing=2):
        text.set(alpha=1.0, path_effects=[withStroke(linewidth=2, foreground="white", alpha=0.7)])
    bar = figure.colorbar(painted, ax=ax, pad=0.02, aspect=30)
    bar.set_label(name, fontsize=13)
    bar.set_ticks(bounds, labels=list(figures_at.values()))
    bar.ax.tick_params(labelsize=11)
    return handles


def _regimes(ax: Axes, grid: Grid, view: View) -> None:
    """Draw lines half-way between cases of different regimes, and name the regimes."""
    numbers = regime_numbers(view)
    if not np.isfinite(numbers).any():
        return
    place = np.zeros(1)
    for n in range(1, len(REGIMES)):
        x, y, beyond = grid.finer(np.where(np.isnan(numbers), np.nan, numbers >= n))
        place = place + np.where(np.isnan(beyond), np.nan, beyond > 0.5)
        if np.nanmin(numbers) < n <= np.nanmax(numbers):
            line = ax.contour(x, y, np.ma.masked_invalid(beyond), [0.5], colors="black",
                              linewidths=2, linestyles="--", zorder=3)  # fmt: skip
            line.set(path_effects=[withStroke(linewidth=4, foreground="white", alpha=0.6)])
    for n, name in enumerate(REGIMES):
        middle = roomiest(place == n)
        if middle is not None:
            ax.text(x[middle[1]], y[middle[0]], name, ha="center", va="center", fontsize=12,
                    fontweight="bold", path_effects=_HALO, zorder=5)  # fmt: skip


def _cases(ax: Axes, grid: Grid, view: View) -> list[Patch | Line2D]:
    """Mark the cases: points, and crosses where they failed."""
    x, y = grid.x.values[grid.order[:, 0]], grid.y.values[grid.order[:, 1]]
    good = view.converged
    handles: list[Patch | Line2D] = []
    if good.any() and len(good) <= _MANY:
        handles += ax.plot(x[good], y[good], "o", ms=3, color="black", clip_on=False, zorder=4,
                           label="case")  # fmt: skip
    if not good.all():
        name = f"failed ({int((~good).sum())})"
        handles += ax.plot(x[~good], y[~good], "x", ms=10, mew=2.5, color=VERMILLION,
                           clip_on=False, zorder=6, label=name)  # fmt: skip
    return handles


def _side(ax: Axes, side: Side, which: str) -> None:
    low, high = float(side.values[0]), float(side.values[-1])
    axis = ax.xaxis if which == "x" else ax.yaxis
    limits = low, high
    if side.logarithmic:
        (ax.set_xscale if which == "x" else ax.set_yscale)("log")
        limits = log_limits(side.values, 0.0, 0.0)
        figures(axis, limits)
    (ax.set_xlim if which == "x" else ax.set_ylim)(limits)
    text = bracketed(side.name, side.unit)
    label(ax, **{which: text})
    if which == "x":
        ax.spines["right"].set_visible(False)
