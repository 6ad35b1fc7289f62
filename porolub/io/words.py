"""How numbers are shown to people: one unit for each quantity, four digits."""

from dataclasses import dataclass

FIELDS = {
    "u": "displacement",
    "p": "fluid pressure",
    "l": "contact pressure",
    "v0": "approach",
    "j": "volume change",
    "displacement": "displacement",
    "pore_pressure": "pore pressure",
    "film_pressure": "film pressure",
    "volume_change": "volume change",
    "contact_pressure": "contact pressure",
    "approach": "approach",
}
"""What the unknowns are called, by the name they have in the solver or in a scene's cost."""


@dataclass(frozen=True)
class Unit:
    """A unit to show and its size in SI units."""

    name: str
    size: float

    def text(self, value: float | None) -> str:
        """Write an SI value in this unit with four digits; a dash for None."""
        if value is None:
            return "-"
        return f"{self.digits(value)} {self.name}".rstrip()

    def digits(self, value: float | None) -> str:
        """Write an SI value in this unit with four digits, without the unit's name."""
        return "-" if value is None else digits(value / self.size)


def digits(value: float) -> str:
    """Write a number with four significant digits, 0 as such."""
    if value == 0:
        return "0"
    if abs(value) < 1e-3:
        return f"{value:.3e}"
    text = f"{value:#.4g}"
    return text if "e" in text else text.rstrip(".")


def seconds(value: float) -> str:
    """Write a duration: ``0.42 s``, ``12.3 s``, ``3 min 05 s``, ``2 h 03 min``."""
    if value < 10:
        return f"{value:.2f} s"
    if value < 99.95:
        return f"{value:.1f} s"
    minutes, rest = divmod(round(value), 60)
    if minutes < 60:
        return f"{minutes} min {rest:02d} s"
    return f"{minutes // 60} h {minutes % 60:02d} min"


def clock(value: float) -> str:
    """Write a duration in one word, for tables: ``0:03:05``."""
    minutes, rest = divmod(round(value), 60)
    return f"{minutes // 60}:{minutes % 60:02d}:{rest:02d}"


def short_time(value: float) -> str:
    """Write a time of the simulation with three digits: ``1.25 s``, ``4.10 ms``, ``12.0 us``."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if abs(value) >= 0.9995 * size:
            return f"{value / size:#.3g}".rstrip(".") + f" {unit}"
    return f"{value / 1e-9:.3g} ns" if value else "0 s"


ONE = Unit("", 1.0)
MILLIMETRE = Unit("mm", 1e-3)
SQUARE_MILLIMETRE = Unit("mm^2", 1e-6)
MICROMETRE = Unit("um", 1e-6)
KILOPASCAL = Unit("kPa", 1e3)
MEGABYTE = Unit("MB", 1e6)
LINE_LOAD = Unit("kN/m", 1e3)
FORCE = Unit("N", 1.0)
LINE_MASS_FLOW = Unit("(g/m)/s", 1e-3)
MASS_FLOW = Unit("g/s", 1e-3)
NEWTON_PER_METRE = Unit("N/m", 1.0)


def load_unit(dimension: int) -> Unit:
    """Unit of a load: per depth in a two-dimensional scene."""
    return LINE_LOAD if dimension == 2 else FORCE


def mass_flow_unit(dimension: int) -> Unit:
    """Unit of a mass flow: per depth in a two-dimensional scene."""
    return LINE_MASS_FLOW if dimension == 2 else MASS_FLOW
