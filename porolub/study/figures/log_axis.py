"""Logarithmic axes over whatever range the cases of a sweep happen to have."""

import math

import numpy as np
from matplotlib.axis import Axis
from matplotlib.ticker import LogLocator, NullFormatter, NullLocator, StrMethodFormatter

from porolub.solve.report import Array

_PLAIN = (1e-4, 1e5)  # figures between them are written out


def positive(values: Array) -> Array:
    """Return the values with NaN for what a logarithmic axis cannot show."""
    return np.where(values > 0, values, np.nan)


def log_limits(values: Array, below: float = 0.05, above: float = 0.05) -> tuple[float, float]:
    """Return limits around the positive values; margins are parts of their decades.

    Of one value, or none, there are limits too.
    """
    found = values[np.isfinite(values) & (values > 0)]
    if not len(found):
        return 0.1, 10.0
    low, high = math.log10(found.min()), math.log10(found.max())
    span = max(high - low, 0.3)
    middle = 0.5 * (low + high)
    low, high = min(low, middle - 0.5 * span), max(high, middle + 0.5 * span)
    return 10 ** (low - below * span), 10 ** (high + above * span)


def figures(axis: Axis, limits: tuple[float, float]) -> None:
    """Place and write figures on a logarithmic axis with these limits."""
    decades = math.log10(limits[1] / limits[0])
    subs = (1.0,) if decades > 3 else (1.0, 2.0, 5.0) if decades > 1 else tuple(range(1, 10))
    axis.set_major_locator(LogLocator(subs=subs, numticks=15))
    if _PLAIN[0] <= limits[0] and limits[1] <= _PLAIN[1]:
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    if decades > 3:
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_minor_locator(NullLocator())
