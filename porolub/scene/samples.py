"""Samples over time, joined by straight lines or by a monotone cubic (see Curve)."""

import math
from functools import cached_property
from typing import Annotated, Generic, Literal, Self, TypeVar

from pydantic import StrictBool, model_validator

from porolub.scene.base import refused
from porolub.scene.curve import Curve
from porolub.scene.history import Extreme, History, first_after_zero
from porolub.scene.units import TIME, Quantity

Q = TypeVar("Q", bound=float)
SampleTime = Annotated[float, Quantity(TIME, at_least=0)]


class Samples(History, Generic[Q]):
    """Values at increasing times (s >= 0); values in the unit of the quantity, SI.

    Outside their times they are held constant. With ``repeat`` the last sample is the first of the
    next period, so their values are equal.
    """

    times: tuple[SampleTime, ...]
    values: tuple[Q, ...]
    interpolation: Literal["linear", "smooth"] = "linear"
    repeat: StrictBool = False

    @model_validator(mode="after")
    def _are_samples(self) -> Self:
        times, values = self.times, self.values
        if len(times) != len(values):
            raise refused(f"as many values as times are needed, not {len(values)} and {len(times)}")
        if len(times) < 2:
            raise refused("at least two samples are needed")
        later = first_not_increasing(times)
        if later is not None:
            raise refused(
                f"the times must increase, but {times[later]:g} s follows {times[later - 1]:g} s"
            )
        if self.repeat and values[0] != values[-1]:
            raise refused(
                "with repeat = true the last value must equal the first: it is the same moment "
                "of the cycle"
            )
        return self

    def at(self, t: float) -> float:
        """Return the value at time ``t`` in s."""
        return self._curve.at(t)

    def kinks(self, start: float, end: float) -> list[float]:
        """Return the samples between ``start`` and ``end`` where the slope jumps, in s."""
        return self._curve.kinks(start, end)

    @property
    def period(self) -> float | None:
        """The time the samples span if they repeat, s, else math.inf; None if all are equal."""
        if min(self.values) == max(self.values):
            return None
        return self.times[-1] - self.times[0] if self.repeat else math.inf

    @property
    def lowest(self) -> Extreme:
        """The lowest sample: neither interpolation goes below it."""
        return self._extreme(min(self.values))

    @property
    def highest(self) -> Extreme:
        """The highest sample: neither interpolation goes above it."""
        return self._extreme(max(self.values))

    def _extreme(self, value: float) -> Extreme:
        number = self.values.index(value)
        if number == 0 and not self.repeat:
            return Extreme(value, 0.0)  # held since the start
        time = self.times[number]
        if self.repeat:
            time = first_after_zero(time, self.times[-1] - self.times[0])
        return Extreme(value, time)

    @cached_property
    def _curve(self) -> Curve:
        return Curve(self.times, self.values, self.interpolation == "smooth", self.repeat)


def first_not_increasing(times: tuple[float, ...] | list[float]) -> int | None:
    """Return the number of the first time that is not later than the one before, from 0."""
    return next((i for i in range(1, len(times)) if times[i] <= times[i - 1]), None)
