"""Values of a scene file as numbers, without knowing the key they are meant for."""

import math
from dataclasses import dataclass
from decimal import Decimal
from functools import lru_cache
from typing import Any

from porolub.scene.units import KINDS, NUMBER, Kind, NotAQuantity, number_and_unit, parse, registry


@dataclass(frozen=True)
class Amount:
    """A number with a unit: ``number`` in the SI unit of its kind, ``given`` in ``unit``."""

    number: float
    given: Decimal
    unit: str
    kind: Kind

    def given_in(self, unit: str) -> Decimal:
        """Return the number in another unit of its kind."""
        if unit == self.unit:
            return self.given
        one = registry().Quantity(Decimal(1), self.unit or "dimensionless")
        factor: Decimal = one.to(unit or "dimensionless").magnitude
        return self.given * factor


def amount(value: Any) -> Amount | None:
    """Return a TOML value as an amount; None if it is none, or not finite.

    A plain number is an amount of the kind NUMBER. Angles count: 1 rad/s is no 1 Hz.
    """
    if isinstance(value, str):
        return _read(value)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return Amount(float(value), Decimal(repr(value)), "", NUMBER)


@lru_cache(maxsize=1024)
def _read(text: str) -> Amount | None:
    parts = number_and_unit(text)
    kind = _kind_of(parts[1]) if parts is not None else None
    if parts is None or kind is None:
        return None
    try:
        return Amount(parse(text, kind), *parts, kind)
    except NotAQuantity:  # not finite
        return None


@lru_cache(maxsize=256)
def _kind_of(unit: str) -> Kind | None:
    """Return the kind of quantity that has this unit; None if no key of a scene takes it."""
    for kind in (NUMBER, *KINDS):
        try:
            parse(f"1 {unit}", kind)
        except NotAQuantity:
            continue
        return kind
    return None


def written(number: Decimal, unit: str) -> str:
    """Return a quantity as it stands in a scene file: ``12.5 um``."""
    plain = number == 0 or Decimal("1e-6") <= abs(number) < Decimal("1e9")
    digits = f"{number.normalize():f}" if plain else f"{number.normalize():e}"
    digits = "0" if number == 0 else digits
    return f"{digits} {unit}" if unit else digits
