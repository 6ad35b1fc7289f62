"""Values that may change with time: a plain number, or a History.

Every form of a history is continuous in time and defined for all t >= 0; time runs in s. A steady
run takes the value at t = 0.
"""

import math
from abc import abstractmethod
from dataclasses import dataclass

from porolub.scene.base import Section


@dataclass(frozen=True)
class Extreme:
    """The lowest or highest value a history takes (SI) and the first time it does, s."""

    value: float
    time: float


class History(Section):
    """A value that changes with time."""

    @abstractmethod
    def at(self, t: float) -> float:
        """Return the value (SI) at time ``t`` >= 0 in s."""

    @abstractmethod
    def kinks(self, start: float, end: float) -> list[float]:
        """Return the times between ``start`` and ``end``, both left out, where the slope jumps.

        Ascending, in s. A time step should end there, and none should reach across.
        """

    @property
    @abstractmethod
    def period(self) -> float | None:
        """The time after which all repeats, s; math.inf if it never does, None if constant."""

    @property
    @abstractmethod
    def lowest(self) -> Extreme:
        """The lowest value over all times t >= 0."""

    @property
    @abstractmethod
    def highest(self) -> Extreme:
        """The highest value over all times t >= 0."""


def value_at(history: float | History, t: float) -> float:
    """Return the value (SI) of a plain number or a history at time ``t`` in s."""
    return history.at(t) if isinstance(history, History) else history


def period_of(history: float | History) -> float | None:
    """Return the period, s; math.inf if it never repeats, None if nothing changes."""
    return history.period if isinstance(history, History) else None


def kinks_of(history: float | History, start: float, end: float) -> list[float]:
    """Return the times in the open interval where the slope jumps, ascending, s."""
    return history.kinks(start, end) if isinstance(history, History) else []


def lowest_of(history: float | History) -> Extreme:
    """Return the lowest value over all times."""
    return history.lowest if isinstance(history, History) else Extreme(history, 0.0)


def highest_of(history: float | History) -> Extreme:
    """Return the highest value over all times."""
    return history.highest if isinstance(history, History) else Extreme(history, 0.0)


def values_of(section: Section, path: str) -> dict[str, float | History]:
    """Return all values in a section and the sections within it that may change with time.

    Their keys are dotted and begin with ``path``; values that are not given are left out.
    """
    found: dict[str, float | History] = {}
    for key, value in section:
        here = f"{path}.{key}"
        if isinstance(value, History | float):
            found[here] = value
        elif isinstance(value, Section):
            found |= values_of(value, here)
    return found


def first_after_zero(time: float, period: float) -> float:
    """Return the first time t >= 0 that lies whole periods from ``time``; all in s."""
    return math.fmod(math.fmod(time, period) + period, period)
