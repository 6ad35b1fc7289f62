"""Lubrication regimes in figures: colours, markers, bands behind a curve, and what they mean."""

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from numpy.typing import NDArray

from porolub.io.figure import BLUE, GREEN, GREY
from porolub.solve.report import Array
from porolub.study.work.regimes import (
    BOUNDARY,
    CRITERIA,
    ELASTOHYDRODYNAMIC,
    HYDRODYNAMIC,
    MIXED,
    REGIMES,
)

ORANGE = "#C77F00"
COLOURS = {HYDRODYNAMIC: BLUE, ELASTOHYDRODYNAMIC: GREEN, MIXED: ORANGE, BOUNDARY: GREY}
MARKERS = {HYDRODYNAMIC: "o", ELASTOHYDRODYNAMIC: "D", MIXED: "^", BOUNDARY: "s", "": "."}
_NAMES = {ELASTOHYDRODYNAMIC: "elastohydro-\ndynamic"}
_PALE = 0.12
_NARROW = 0.1  # of the width of the axes: a band's name stands upright
_NO_BAND = 0.012


def known(regimes: Iterable[str]) -> list[str]:
    """Return those of REGIMES that occur, from the thickest film to the closest contact."""
    found = set(regimes)
    return [regime for regime in REGIMES if regime in found]


def draw_bands(ax: Axes, x: Array, regimes: NDArray[np.str_], names: bool = True) -> None:
    """Shade the regimes along the x axis, whose scale and limits are set.

    x: (n,) ascending, in data units; regimes: (n,). Bands change half-way between the cases, on
    the axis's scale; where a case has no regime there is none.
    """
    to_axes = ax.transAxes.inverted()
    places = to_axes.transform(ax.transData.transform(np.column_stack([x, np.ones_like(x)])))[:, 0]
    ends = np.concatenate([[0.0], 0.5 * (places[1:] + places[:-1]), [1.0]])
    start = 0
    for regime, run in groupby(regimes.tolist()):
        stop = start + len(list(run))
        left, right = float(ends[start]), float(ends[stop])
        start = stop
        if not regime:
            continue
        width = right - left
        ax.add_patch(Rectangle((left, 0.0), width, 1.0, transform=ax.transAxes, lw=0, zorder=-2,
                               color=COLOURS[regime], alpha=_PALE))  # fmt: skip
        if names and width > _NO_BAND:
            upright = width < _NARROW
            ax.text(
                0.5 * (left + right), 0.985, regime if upright else _NAMES.get(regime, regime),
                transform=ax.transAxes, ha="center", va="top", color=COLOURS[regime],
                fontsize=11, fontweight="bold", rotation=90 if upright else 0, linespacing=0.95,
            )  # fmt: skip


def band_handles(regimes: Iterable[str], between: str = ": ") -> list[Any]:
    """Return handles for the legend of bands: each regime, ``between``, and what it asks for."""
    return [Patch(facecolor=to_rgba(COLOURS[regime], 2 * _PALE), edgecolor=COLOURS[regime],
                  label=f"{regime}{between}{CRITERIA[regime]}")
            for regime in known(regimes)]  # fmt: skip


def marker_handles(regimes: Iterable[str]) -> list[Any]:
    """Return handles for the legend of markers: each regime and what it asks for."""
    return [Line2D([], [], ls="", marker=MARKERS[regime], ms=7, color="black",
                   label=f"{regime}: {CRITERIA[regime]}") for regime in known(regimes)]  # fmt: skip


def legend_above(ax: Axes, handles: Sequence[Any], columns: int = 2) -> None:
    """Put a legend of several lines between the title and the axes."""
    if not handles:
        return
    rows = -(-len(handles) // columns)
    title = ax.get_title(loc="left")
    ax.set_title(title, loc="left", fontsize=14, pad=8 + 17.5 * rows, parse_math=False)
    ax.legend(
        handles=list(handles), loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns,
        fontsize=11, frameon=False, borderaxespad=0.2, borderpad=0.1, labelspacing=0.3,
    )  # fmt: skip


def note_below(figure: Figure, *sentences: str) -> None:
    """Put small print under the axes: what is left out and why."""
    text = " ".join(sentence for sentence in sentences if sentence)
    if text:
        figure.supxlabel(text, x=0.01, ha="left", fontsize=11, color=GREY)
