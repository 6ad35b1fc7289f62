"""Where to put the nodes of a line: graded toward given places, or by a fixed size ratio.

Element sizes follow h(s) = size + growth * max(0, distance to the nearest edge - band). With
n counting elements, ds/dn = h, so neighbouring elements differ by a factor of at most
exp(growth), and the ticks are the places where the integral of 1/h is a whole number. The
growth is chosen so that the number of elements comes out as asked.
"""

import logging
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]
MAX_RATIO = 1.25
"""Largest ratio of neighbouring element sizes along the surface."""

log = logging.getLogger(__name__)


def _pieces(low: float, high: float, edges: Sequence[float], band: float) -> tuple[Array, Array]:
    """Break points of the distance function in [low, high] and its values there."""
    at = np.unique(np.asarray(edges, dtype=float))
    breaks = np.concatenate([[low, high], at - band, at + band, (at[1:] + at[:-1]) / 2])
    breaks = np.unique(np.clip(breaks, low, high))
    distance = np.abs(breaks[:, None] - at[None, :]).min(axis=1)
    return breaks, np.maximum(0.0, distance - band)


def _counts(breaks: Array, sizes: Array) -> Array:
    """Elements in each piece: integral of 1/h for h linear between `sizes`."""
    jump = np.diff(sizes)
    relative = jump / sizes[:-1]
    small = np.abs(relative) < 1e-6
    safe = np.where(small, 1.0, relative)
    mean = np.where(small, 1 - relative / 2, np.log1p(safe) / safe)  # of sizes[:-1] / h
    return np.diff(breaks) / sizes[:-1] * mean


def graded_ticks(
    length: float, count: int, edges: Sequence[float], size: float, band: float = 0.0
) -> Array:
    """Positions (count + 1,) in [-length/2, length/2], finest at `edges`.

    `size` is the element size wanted within `band` of the edges. Neighbouring elements
    differ by at most MAX_RATIO; if `count` is too small for that, the smallest size is
    raised and the log says so. Lengths share one unit; `count` elements exactly.
    """
    low, high = -length / 2, length / 2
    if size * count >= length:
        return np.linspace(low, high, count + 1)
    breaks, distance = _pieces(low, high, edges, band)
    steepest = float(np.log(MAX_RATIO))

    def excess(growth: float, smallest: float) -> float:
        return float(_counts(breaks, smallest + growth * distance).sum()) - count

    growth, smallest = steepest, size
    if excess(steepest, size) > 0:
        smallest = brentq(lambda h: excess(steepest, h), size, length / count, xtol=1e-14 * length)
        log.warning(
            "mesh.along = %d is too small for an edge size of %.3g: taking %.3g (mesh units).",
            *(count, size, smallest),
        )
    else:
        growth = brentq(lambda g: excess(g, size), 0.0, steepest, xtol=1e-15)
    sizes = smallest + growth * distance
    # number of elements left of each break point, scaled to close on `count` exactly
    total = np.concatenate([[0.0], np.cumsum(_counts(breaks, sizes))])
    total *= count / total[-1]
    wanted = np.arange(1, count)
    piece = np.clip(np.searchsorted(total, wanted, side="right") - 1, 0, len(breaks) - 2)
    share = (wanted - total[piece]) / np.diff(total)[piece]
    relative = np.diff(sizes)[piece] / sizes[piece]
    small = np.abs(relative) < 1e-6
    safe = np.where(small, 1.0, relative)
    # solves log(1 + relative t) / log(1 + relative) = share for the place t in the piece
    inside = np.where(small, share, np.expm1(share * np.log1p(safe)) / safe)
    ticks = breaks[piece] + inside * np.diff(breaks)[piece]
    return np.concatenate([[low], ticks, [high]])


def uniform_ticks(count: int, ratio: float = 1.0) -> Array:
    """Logical positions (count + 1,) in [0, 1] in geometric progression.

    `ratio` is the size of the last element (at 1) over that of the first.
    """
    if count == 1 or ratio == 1.0:
        return np.linspace(0.0, 1.0, count + 1)
    sizes = ratio ** (np.arange(count) / (count - 1))
    ticks = np.concatenate([[0.0], np.cumsum(sizes)]) / sizes.sum()
    ticks[-1] = 1.0
    return ticks
