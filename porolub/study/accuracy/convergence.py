"""From values on finer and finer levels to their limit: observed order, Richardson extrapolation.

A sequence v_i = a + b h_i^p is followed exactly. One that oscillates, that does not come closer, or
whose differences are noise has no order; its last value stands for the limit, and how far the last
three lie apart for the uncertainty.

Source: P. J. Roache, Annual Review of Fluid Mechanics 29 (1997) 123-160.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

Floats = NDArray[np.float64]
ORDERS = (0.3, 8.0)
"""Orders that are believed, unless told: below, the limit would lie far beyond all values; above,
it looks the same where two values agree by accident."""
SAFETY, UNCONFIRMED = 1.25, 3.0
"""Roache's factors, by which the distance of limit and last value is taken larger: in general, and
where the levels before have no order."""
OF_CORRECTION = 0.1
"""What the limit is at least uncertain by, of its distance from the last value."""


@dataclass(frozen=True)
class Extrapolation:
    """``limit`` of a sequence and by how much it is ``uncertain``, in the unit of the values;
    ``order``: the observed one, None where there is none."""

    limit: float
    uncertain: float
    order: float | None = None


def observed_order(
    sizes: ArrayLike,
    values: ArrayLike,
    noise: float = 1e-12,
    orders: tuple[float, float] = ORDERS,
) -> float | None:
    """Return p of a + b h^p through three values at falling sizes; None where there is no order.

    sizes, values: (3,); noise: what differences are not believed below, of the largest value;
    orders: the least and the largest that are believed.
    """
    h, v = np.asarray(sizes, float), np.asarray(values, float)
    first, last = float(v[0] - v[1]), float(v[1] - v[2])
    if min(abs(first), abs(last)) <= noise * np.abs(v).max() or first * last <= 0:
        return None
    coarse, fine = np.log(h[:-1] / h[1:])

    def excess(p: float) -> float:
        """Of the ratio of differences that order p has."""
        return float(np.log(np.expm1(p * coarse) / -np.expm1(-p * fine))) - np.log(first / last)

    low, high = orders
    if excess(low) > 0 or excess(high) < 0:
        return None
    return float(brentq(excess, low, high, xtol=1e-14))


def extrapolated(
    sizes: Sequence[float] | Floats,
    values: Sequence[float] | Floats,
    noise: float = 1e-12,
    orders: tuple[float, float] = ORDERS,
) -> Extrapolation:
    """Return the limit at size 0 of values at falling sizes; levels that are NaN are passed over.

    sizes, values: (n,). Of one value nothing is known but the value; of two, the limit is the
    second. From four on, the limit of the levels without the last tells how uncertain that of all
    is. Raises ValueError where sizes do not fall or no value is finite.
    """
    h, v = np.asarray(sizes, float), np.asarray(values, float)
    if h.shape != v.shape or (np.diff(h) >= 0).any() or (h <= 0).any():
        raise ValueError("sizes must fall, be greater than 0 and as many as the values")
    known = np.isfinite(v)
    if not known.any():
        raise ValueError("no value is finite")
    h, v = h[known], v[known]
    floor = float(noise * np.abs(v).max())
    last = float(v[-1])
    if len(v) < 3:
        return Extrapolation(last, max(abs(last - float(v[0])), floor) if len(v) == 2 else np.inf)
    order = observed_order(h[-3:], v[-3:], noise, orders)
    if order is None:
        return Extrapolation(last, max(float(np.ptp(v[-3:])), floor))
    limit = _limit(h, v, order)
    correction = abs(limit - last)
    uncertain = SAFETY * correction
    if len(v) > 3:
        before = observed_order(h[-4:-1], v[-4:-1], noise, orders)
        if before is None:
            uncertain = UNCONFIRMED * correction
        else:
            change = abs(limit - _limit(h[:-1], v[:-1], before))
            uncertain = max(change, OF_CORRECTION * correction)
    uncertain = min(uncertain, max(float(np.ptp(v[-3:])), correction))
    return Extrapolation(limit, max(uncertain, floor), order)


def _limit(h: Floats, v: Floats, order: float) -> float:
    """Limit of a sequence of this order, from its last two values."""
    return float(v[-1] + (v[-1] - v[-2]) / np.expm1(order * np.log(h[-2] / h[-1])))
