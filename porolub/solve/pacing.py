"""How long the next step of a transient run may be, beside what its error allows. Times scaled.

And when the next picture is due, by the clock alone, so that a restart does not matter.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from porolub.scene.history import History, period_of
from porolub.solve.lookback import Lookback

EASY = 3.3  # Newton iterations that steps are to take on average, where Newton limits them
STEPS_OF_A_PERIOD = 40  # at least; with 30 what follows a reversal still costs rejections
RATE_ERROR = 5.0  # tolerances; of a given approach's rate, beside its largest
SAME_STOP = 1e-12  # of the time: stops nearer than this are one, but for rounding


def ease(iterations: float) -> float:
    """How much longer the next step may be, by how hard this one was for Newton.

    Steps that take more than EASY iterations cost more than two shorter ones, which are also
    more accurate and are rejected less.
    """
    return float(np.clip((EASY / max(iterations, 1.0)) ** 1.5, 0.5, 2.0))


def longest(scene: Any, unit: float) -> float:
    """No step may be longer: of each cycle enough is seen not to step over it."""
    periods = [p for p in map(period_of, scene.histories().values()) if p is not None]
    shortest = min(periods, default=np.inf)
    return float(min(scene.time.step_max or np.inf, shortest / STEPS_OF_A_PERIOD) / unit)


class GivenRate:
    """Steps over which BDF differences a given approach well.

    Between rigid walls the film's pressure is the approach's rate times a factor.  Its error is
    that of the rate, which TS does not see: TS looks at how smooth the pressure itself is, and
    where the pressure's highest derivative passes through zero it would take any step.
    """

    def __init__(self, approach: History, end: float, unit: float, tolerance: float) -> None:
        """``end`` in s, ``unit`` of scaled time in s."""
        self._at, self._unit = approach.at, unit
        span = min(end, approach.period or end)
        times = np.linspace(0.0, span, 401)
        moved = np.diff([approach.at(t) for t in times])
        self._allowed = RATE_ERROR * tolerance * float(np.abs(moved).max()) / times[1]

    def limit(self, size: float, lookback: Lookback) -> float:
        """The step of at most ``size`` (scaled) whose rate is good enough."""
        if lookback.steps == 0:  # a (re)start is short anyway
            return size
        for _ in range(20):
            error = self._error(size, lookback)
            if error <= self._allowed:
                break
            size *= float(np.clip((self._allowed / error) ** 0.5, 0.5, 0.95))
        return size

    def _error(self, size: float, lookback: Lookback) -> float:
        """|differenced rate - rate| at the end of a step, m/s."""
        t = lookback.entries[0].time + size
        weights = lookback.weights(t, half=False)
        times = np.array([t, *(e.time for e in lookback.nodes(half=False))]) * self._unit
        values = np.array([self._at(time) for time in times])
        e = 1e-3 * size * self._unit  # from before t alone: there may be a kink at it
        rate = 3.0 * values[0] - 4.0 * self._at(times[0] - e) + self._at(times[0] - 2.0 * e)
        return float(abs(weights @ values / self._unit - rate / (2.0 * e)))


def given_rate(scene: Any, unit: float) -> GivenRate | None:
    """For a scene whose only unknown is the film's pressure under an approach that changes."""
    approach = scene.load.approach if scene.load is not None else None
    if scene.solid is not None or not isinstance(approach, History):
        return None
    return GivenRate(approach, scene.time.end, unit, scene.time.tolerance)


def landing(size: float, left: float) -> float:
    """A step that ends at the stop, or leaves as much again for another one."""
    if size >= left * (1 - 1e-9):
        return left
    return left / 2 if 2 * size > left else size


def stops(scene: Any, unit: float) -> list[tuple[float, bool]]:
    """Times to land on exactly, ascending, and whether the slope of something jumps there."""
    end, period = scene.time.end, scene.period
    count = int(end / period * (1 + 1e-12)) if period is not None else 0
    found = [(n * period, False) for n in range(1, count + 1)] + [(end, False)]
    found += [(t, True) for t in scene.kinks(0.0, end)]
    apart: list[tuple[float, bool]] = []
    for t, kink in sorted(found):
        before = apart.pop() if apart and t - apart[-1][0] <= SAME_STOP * t else (t, False)
        apart.append((t, kink or before[1]))
    apart[-1] = end, apart[-1][1]
    return [(t / unit, kink) for t, kink in apart]


def next_picture(scene: Any, now: float) -> float:
    """When the first picture after the time reached is due; both in s."""
    apart = (scene.period or scene.time.end) / max(scene.time.frames, 1)
    return float((int(now / apart * (1 + 1e-9)) + 1) * apart * (1 - 1e-9))
