"""What a case is called where people read it: the values of its axes."""

import math
from collections.abc import Mapping
from typing import Any

from porolub.scene.describe import readable

_WITH_PREFIX = ("m", "m/s", "s", "Pa", "Pa*s", "N", "N/m", "Hz", "rad/s", "B")
"""Units a prefix may stand before: 1 mm^2 is no thousandth of 1 m^2."""


def case_label(axes: Mapping[str, float | str], units: Mapping[str, str]) -> str:
    """Return for instance ``approach = 20 um, speed = 1 rad/s``.

    ``axes``: SI number or text by axis; ``units``: SI units of those that have one.
    """
    return ", ".join(f"{name} = {axis_text(v, units.get(name, ''))}" for name, v in axes.items())


def axis_text(value: Any, unit: str) -> str:
    """Return a number (SI) with four digits and a unit of handy size, a text as it is."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    if unit == "rad":
        return f"{math.degrees(value):.4g} deg"
    if unit in _WITH_PREFIX and value:
        return readable(value, unit)
    return f"{value:.4g} {unit}".rstrip()
