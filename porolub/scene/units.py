"""Quantities of a scene file: a number and a unit in, a plain SI float on the model.

A quantity is written ``"<number> <unit>"``, for instance ``"1 um^3/mm"``. A plain number is
refused where a unit is needed, and so is a unit of another dimension. Pint counts an angle as
dimensionless, so that 1 Hz and 1 rad/s look alike to it; here they are told apart.
"""

import math
import re
from dataclasses import dataclass
from decimal import Decimal
from functools import lru_cache
from typing import Annotated, Any

import pint
from pydantic import GetCoreSchemaHandler, SerializationInfo, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from porolub.scene.base import refused


@dataclass(frozen=True)
class Kind:
    """A physical dimension: its name, SI unit and an example a user can copy.

    ``angular`` says whether an angle must appear in the unit (true for rad/s, false for Hz).
    """

    name: str
    unit: str
    example: str
    angular: bool = False


LENGTH = Kind("a length", "m", "1 mm")
PRESSURE = Kind("a pressure", "Pa", "0.5 MPa")
VISCOSITY = Kind("a dynamic viscosity", "Pa*s", "1 mPa*s")
PERMEABILITY = Kind("a permeability (an area)", "m^2", "1 um^3/mm")
COMPRESSIBILITY = Kind("an inverse pressure", "1/Pa", "2.08 1/GPa")
DENSITY = Kind("a density", "kg/m^3", "1000 kg/m^3")
ANGLE = Kind("an angle", "rad", "5 deg", angular=True)
ANGULAR_SPEED = Kind("an angular speed", "rad/s", "1 rad/s", angular=True)
SPEED = Kind("a speed", "m/s", "0.1 m/s")
FREQUENCY = Kind("a frequency", "Hz", "1 Hz")
TIME = Kind("a time", "s", "5 s")
LINE_LOAD = Kind("a load per length (two-dimensional scene)", "N/m", "1.5 kN/m")
FORCE = Kind("a force (three-dimensional scene)", "N", "50 N")
MOBILITY = Kind("a hydraulic permeability (permeability over viscosity)", "m^2/(Pa*s)", "")
NUMBER = Kind("a number", "", "0.5")

# Only used to name what the user wrote when it is not what is needed; the order matters where
# two kinds share a dimension.
KINDS = (
    LENGTH, PRESSURE, VISCOSITY, PERMEABILITY, COMPRESSIBILITY, DENSITY, ANGLE, ANGULAR_SPEED,
    SPEED, FREQUENCY, TIME, LINE_LOAD, FORCE, MOBILITY,
)  # fmt: skip

_NUMBER_THEN_UNIT = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
_ANGLE_UNITS = ("radian", "degree", "turn", "arcminute", "arcsecond", "grade", "revolution")


class NotAQuantity(ValueError):
    """A text that is no quantity of the wanted kind; the message says why, without the key."""


@lru_cache(maxsize=1)
def registry() -> pint.UnitRegistry[Decimal]:
    """Return the one unit registry. Decimal, so that 1 um^3/mm is 1e-15 m^2 and not 9.99e-16."""
    return pint.UnitRegistry(non_int_type=Decimal)


def number_and_unit(text: str) -> tuple[Decimal, str] | None:
    """Split ``"1.5 kN/m"`` into its number and its unit, unchecked; None if it has no number."""
    match = _NUMBER_THEN_UNIT.fullmatch(text)
    return None if match is None else (Decimal(match[1]), match[2])


@lru_cache(maxsize=1024)
def parse(text: str, kind: Kind) -> float:
    """Return the SI value of ``text``, a quantity of ``kind``. Raises NotAQuantity."""
    parts = number_and_unit(text)
    wanted = f'{kind.name} is needed, such as "{kind.example}"'
    if parts is None:
        raise NotAQuantity(f"this is not a number with a unit; {wanted}")
    number, unit_text = parts
    if kind is NUMBER and not unit_text:
        return _finite(number)
    if not unit_text:
        raise NotAQuantity(f"the unit is missing; {wanted}")
    if "," in unit_text:
        raise NotAQuantity(f"a comma cannot stand in a number, write a point; {wanted}")
    return _finite(number * _si_factor(unit_text, kind, wanted))


@lru_cache(maxsize=256)
def _si_factor(unit_text: str, kind: Kind, wanted: str) -> Decimal:
    """Return how many SI units of ``kind`` a unit is; tables ask for the same one often."""
    unit = _unit(unit_text, wanted)
    if unit.dimensionality != registry().Quantity(1, kind.unit).dimensionality:
        raise NotAQuantity(f"this is {_describe(unit)}; {wanted}")
    if _has_angle(unit) != kind.angular:
        raise NotAQuantity(f"this is {_describe(unit)}; {wanted}")
    factor: Decimal = unit.to(kind.unit).magnitude
    return factor


def _unit(unit_text: str, wanted: str) -> Any:
    """Return one of the given unit as a pint quantity."""
    try:
        unit: Any = registry().Quantity(unit_text)
    except Exception as error:  # pint evaluates an expression: its errors have no common base
        raise NotAQuantity(f'the unit "{unit_text}" is not known; {wanted}') from error
    if unit.magnitude != 1:
        raise NotAQuantity(f"this is not one number with a unit; {wanted}")
    return unit


def _has_angle(unit: Any) -> bool:
    return any(angle in str(name) for name, _ in unit.unit_items() for angle in _ANGLE_UNITS)


def _describe(unit: Any) -> str:
    """Name the kind of a unit, for instance ``a length``."""
    for kind in KINDS:
        same = registry().Quantity(1, kind.unit).dimensionality == unit.dimensionality
        if same and kind.angular == _has_angle(unit):
            return kind.name.split(" (")[0]
    return "a pure number" if unit.dimensionless else f"a quantity in {unit.units:~C}"


def _finite(value: Decimal) -> float:
    result = float(value)
    if not math.isfinite(result):
        raise NotAQuantity("the value must be finite")
    return result


@dataclass(frozen=True)
class Quantity:
    """Annotation that reads a float field from a quantity of ``kind`` and checks its range.

    The bounds are SI numbers or, to be quoted to the user as they stand, quantities.
    """

    kind: Kind
    above: float | str | None = None
    at_least: float | str | None = None
    below: float | str | None = None
    at_most: float | str | None = None

    def kind_in(self, context: Any) -> Kind:
        """Return the kind; ``context`` may hold the scene's dimension (see LoadForce)."""
        return self.kind

    def read(self, value: Any, info: ValidationInfo) -> float:
        """Return the SI value of ``value``; raises refused(...)."""
        kind = self.kind_in(info.context)
        try:
            if kind is NUMBER and isinstance(value, int | float) and not isinstance(value, bool):
                result = _finite(Decimal(value))
            elif isinstance(value, str):
                result = parse(value, kind)
            elif isinstance(value, int | float) and not isinstance(value, bool):
                raise NotAQuantity(
                    f'a plain number has no unit; {kind.name} is needed, such as "{kind.example}"'
                )
            else:
                raise NotAQuantity(f'{kind.name} is needed, such as "{kind.example}"')
            self._check_range(result, kind)
        except NotAQuantity as error:
            raise refused(str(error)) from error
        return result

    def _check_range(self, value: float, kind: Kind) -> None:
        def si(bound: float | str) -> float:
            return parse(bound, kind) if isinstance(bound, str) else bound

        tests = (
            (self.above, "greater than", lambda b: value > b),
            (self.at_least, "at least", lambda b: value >= b),
            (self.below, "less than", lambda b: value < b),
            (self.at_most, "at most", lambda b: value <= b),
        )
        given = [(bound, word, test) for bound, word, test in tests if bound is not None]
        if not all(test(si(bound)) for bound, _, test in given):
            allowed = " and ".join(f"{word} {bound}" for bound, word, _ in given)
            raise NotAQuantity(f"the value must be {allowed}")

    def write(self, value: float, info: SerializationInfo) -> str | float:
        """Return ``value`` as a scene file has it; reads back to the same float."""
        unit = self.kind_in(info.context).unit
        return f"{value!r} {unit}" if unit else value

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(
            self.read,
            serialization=core_schema.plain_serializer_function_ser_schema(
                self.write, info_arg=True, when_used="json"
            ),
        )


class LoadForce(Quantity):
    """A load: N/m of depth in a two-dimensional scene, N in a three-dimensional one."""

    def kind_in(self, context: Any) -> Kind:
        return FORCE if (context or {}).get("dimension", 2) == 3 else LINE_LOAD


Length = Annotated[float, Quantity(LENGTH)]
PositiveLength = Annotated[float, Quantity(LENGTH, above=0)]
Pressure = Annotated[float, Quantity(PRESSURE)]
Modulus = Annotated[float, Quantity(PRESSURE, above=0)]
Viscosity = Annotated[float, Quantity(VISCOSITY, above=0)]
Permeability = Annotated[float, Quantity(PERMEABILITY, above=0)]
Storage = Annotated[float, Quantity(COMPRESSIBILITY, at_least=0)]
Compressibility = Annotated[float, Quantity(COMPRESSIBILITY, above=0)]
Density = Annotated[float, Quantity(DENSITY, above=0)]
Angle = Annotated[float, Quantity(ANGLE)]
SectorAngle = Annotated[float, Quantity(ANGLE, above=0, below="90 deg")]
AngularSpeed = Annotated[float, Quantity(ANGULAR_SPEED)]
Speed = Annotated[float, Quantity(SPEED)]
PositiveSpeed = Annotated[float, Quantity(SPEED, above=0)]
Frequency = Annotated[float, Quantity(FREQUENCY, above=0)]
PositiveTime = Annotated[float, Quantity(TIME, above=0)]
Force = Annotated[float, LoadForce(LINE_LOAD)]
