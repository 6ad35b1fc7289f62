"""All that changes with time in a scene, taken together: common period and kinks."""

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import TYPE_CHECKING

from porolub.scene.history import History, kinks_of, period_of, values_of

if TYPE_CHECKING:
    from porolub.scene.scene import Scene

LONGEST = 60  # a common period spans at most so many periods of any history
SAME_RATIO = 1e-9  # relative: ratios of periods nearer to a fraction than this are that fraction
SAME_TIME = 1e-12  # relative: kinks nearer to each other than this are one, but for rounding


def histories(scene: "Scene") -> dict[str, float | History]:
    """Return all values of a scene that may change with time, by their keys in the file."""
    found: dict[str, float | History] = {}
    for key in ("load", "motion"):
        section = getattr(scene, key)
        found |= values_of(section, key) if section is not None else {}
    for name, boundary in scene.boundary.items():
        found |= values_of(boundary, f"boundary.{name}")
    return found


def varying(scene: "Scene") -> dict[str, float]:
    """Return the periods (s; math.inf: never repeats) of all that changes, by key."""
    periods = {key: period_of(history) for key, history in histories(scene).items()}
    return {key: period for key, period in periods.items() if period is not None}


def common_period(periods: Iterable[float]) -> float | None:
    """Return the time after which all repeat together, s; None if there is none.

    Periods fit together if their ratios are fractions whose common period is at most 60 of any.
    """
    periods = list(periods)
    if not periods or math.inf in periods:
        return None
    longest = max(periods)
    turns = 1  # of the longest period
    for period in periods:
        ratio = Fraction(longest / period).limit_denominator(LONGEST)
        if abs(ratio * period - longest) > SAME_RATIO * longest:
            return None
        turns = math.lcm(turns, ratio.denominator)
    return turns * longest if turns * longest <= LONGEST * (1 + SAME_RATIO) * min(periods) else None


def kinks(scene: "Scene", start: float, end: float) -> list[float]:
    """Return the times between ``start`` and ``end`` where any value changes its slope abruptly.

    Ascending, in s. Times that differ by rounding only, also from ``start`` and ``end``, count
    once.
    """
    times = sorted(t for h in histories(scene).values() for t in kinks_of(h, start, end))
    chosen: list[float] = []
    for t in times:
        apart = SAME_TIME * t
        if t - (chosen[-1] if chosen else start) > apart and end - t > apart:
            chosen.append(t)
    return chosen
