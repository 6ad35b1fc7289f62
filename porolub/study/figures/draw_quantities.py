"""What the figures of a sweep show: columns of the table, what they are called, their units."""

import math
from dataclasses import dataclass

import numpy as np

from porolub.io.words import Unit
from porolub.solve.report import Array

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "μ"), (1e-9, "n"))
_PREFIXED = ("m", "Pa", "Pa*s", "N", "N/m", "s", "Hz")
_FLOWS = {"kg/(m*s)": "g/(m*s)", "kg/s": "g/s"}
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Quantity:
    """A column of the table, or the sum of several, and what it is called."""

    columns: tuple[str, ...]
    name: str


FRICTION = Quantity(("friction_coefficient",), "friction coefficient μ")
FRICTION_FLUID = Quantity(("friction_fluid",), "friction coefficient of the film $μ_f$")
LOAD_RATIO = Quantity(("load_ratio",), "load ratio $Γ = L_f/L_s$")
FLUID_SHARE = Quantity(("load_fluid", "load_total"), "fluid share of the load $L_f/L$")
"""The one quotient among them."""
LOAD = Quantity(("load_total",), "load L")
APPROACH = Quantity(("approach",), "approach $v_0$")
FILM_MIN = Quantity(("film_min",), "least film thickness $h_{min}$")
CONTACT_LENGTH = Quantity(("contact_length",), "contact length b")
PENETRATION = Quantity(("penetration_length",), "penetration length $b_0$")
PRESSURE_MAX = Quantity(("pressure_max",), "highest fluid pressure p")
CONTACT_PRESSURE_MAX = Quantity(("contact_pressure_max",), "highest contact pressure $p_c$")
INFLOW = Quantity(("inflow_left", "inflow_right"), "flow into the layer $M_{in}$")
OUTFLOW = Quantity(("outflow_left", "outflow_right"), "flow out of the layer $M_{out}$")


def suited(unit: str, *values: Array, logarithmic: bool = False) -> Unit:
    """Return the unit with the prefix that suits the values (SI, NaN left out).

    Units that take no prefix (powers and most quotients) get a power of ten where their figures
    would be long. ``logarithmic``: the middle of the decades decides, not the largest.
    """
    sizes = np.abs(np.concatenate([np.ravel(v) for v in values] or [np.zeros(0)]))
    sizes = sizes[np.isfinite(sizes) & (sizes > 0)]
    if not len(sizes):
        return Unit(_shown(unit), 1.0)
    size = float(np.sqrt(sizes.min()) * np.sqrt(sizes.max()) if logarithmic else sizes.max())
    if unit in _FLOWS:
        size, scale, unit = size * 1e3, 1e-3, _FLOWS[unit]
    elif unit == "rad":
        return Unit("°", math.pi / 180)
    elif unit in _PREFIXED:
        scale = 1.0
    else:
        return _with_power(unit, size, logarithmic)
    factor, prefix = next((p for p in _PREFIXES if size >= p[0] * 0.9999999), _PREFIXES[-1])
    return Unit(prefix + _shown(unit), factor * scale)


def _with_power(unit: str, size: float, logarithmic: bool) -> Unit:
    """A logarithmic axis has its powers of ten at the figures."""
    if logarithmic or 1e-3 < size < 1e5:
        return Unit(_shown(unit), 1.0)
    power = 3 * math.floor(math.log10(size) / 3)
    return Unit(f"10{str(power).translate(_RAISED)} {_shown(unit)}".rstrip(), 10.0**power)


def _shown(unit: str) -> str:
    """Write a unit as figures do: ``m²``, ``Pa s``."""
    for power in "23":
        unit = unit.replace(f"^{power}", power.translate(_RAISED))
    return unit.replace("*", " ")


def plain(text: str) -> str:
    """Return a user's text as figures can take it: a dollar sign begins no formula."""
    return text.replace("$", r"\$")


def bracketed(name: str, unit: Unit) -> str:
    """Return the label of an axis: ``load L [N/m]``."""
    return f"{name} [{unit.name}]" if unit.name else name
