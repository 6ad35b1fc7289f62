"""How long the next step of a transient run may be, beside what its error allows. Times scaled.

And when the next picture is due, by the clock alone, so that a restart does not matter.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from porolub.scene.history import period_of

EASY = 3.3  # Newton iterations that steps are to take on average, where Newton limits them
STEPS_OF_A_PERIOD = 40  # at least; with 30 what follows a reversal still costs rejections
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
