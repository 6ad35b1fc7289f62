"""A harmonic about a mean:

    value(t) = mean + amplitude * shape(2 pi frequency t + phase),   shape = sine | cosine

as in Eqs. 23 and 24 of the reference paper.
"""

import math
from typing import Any, Generic, Literal, TypeVar

from pydantic import model_validator

from porolub.scene.base import refused
from porolub.scene.history import Extreme, History, first_after_zero
from porolub.scene.units import Angle, Frequency

Q = TypeVar("Q", bound=float)


class Harmonic(History, Generic[Q]):
    """A harmonic history; ``mean`` and ``amplitude`` in the unit of the quantity, SI.

    ``frequency`` in Hz, ``phase`` in rad.
    """

    mean: Q
    amplitude: Q
    frequency: Frequency
    shape: Literal["sine", "cosine"] = "sine"
    phase: Angle = 0.0

    @model_validator(mode="before")
    @classmethod
    def _is_no_profile(cls, data: Any) -> Any:
        if isinstance(data, dict) and "profile" in data:
            raise refused("named profiles are loads: they are known for load.force only", "profile")
        return data

    def at(self, t: float) -> float:
        """Return the value at time ``t`` in s."""
        return harmonic(t, self.mean, self.amplitude, self.frequency, self.shape, self.phase)

    def kinks(self, start: float, end: float) -> list[float]:
        """Return no times: a harmonic is smooth."""
        return []

    @property
    def period(self) -> float | None:
        """One over the frequency, s; None if the amplitude is 0."""
        return 1.0 / self.frequency if self.amplitude else None

    @property
    def lowest(self) -> Extreme:
        """mean - |amplitude|."""
        return self._extreme(-1.0)

    @property
    def highest(self) -> Extreme:
        """mean + |amplitude|."""
        return self._extreme(1.0)

    def _extreme(self, sign: float) -> Extreme:
        """Where the shape reaches +-1: the sine at a quarter turn, the cosine at none."""
        if not self.amplitude:
            return Extreme(self.mean, 0.0)
        half_turn = 0.0 if sign * self.amplitude > 0 else math.pi
        angle = half_turn + (0.0 if self.shape == "cosine" else math.pi / 2) - self.phase
        time = first_after_zero(angle / (2.0 * math.pi * self.frequency), 1.0 / self.frequency)
        return Extreme(self.mean + sign * abs(self.amplitude), time)


def harmonic(
    t: float, mean: float, amplitude: float, frequency: float, shape: str, phase: float
) -> float:
    """Return mean + amplitude * shape(2 pi frequency t + phase); t in s, phase in rad."""
    angle = 2.0 * math.pi * frequency * t + phase
    return mean + amplitude * (math.cos(angle) if shape == "cosine" else math.sin(angle))
