"""Stretches of a history: a full period or the whole run, with values at exactly its ends."""

import math
from dataclasses import dataclass

import numpy as np

from porolub.errors import SceneError
from porolub.solve.report import Array

History = dict[str, Array]
"""Columns of history.csv by name, ``time`` (s) among them; NaN where a step has no value."""

_ROUNDING = 1e-6  # of a period: what a last step may lack to the end of one
_SUDDEN = 1e-2  # of a period: from rest a run begins a moment after t = 0


@dataclass(frozen=True)
class Span:
    """From ``start`` to ``end`` in s; ``period``: which one it is, from 1, None: whole run."""

    start: float
    end: float
    period: int | None = None


def full_periods(history: History, period: float | None) -> range:
    """Return the numbers (from 1) of the periods, of ``period`` s, the history has as a whole.

    None or infinity: nothing is periodic, so there are none.
    """
    time = history["time"]
    if period is None or not math.isfinite(period) or not len(time):
        return range(0)
    first = math.ceil(time[0] / period - _SUDDEN) + 1
    return range(first, math.floor(time[-1] / period + _ROUNDING) + 1)


def choose(history: History, period: float | None, number: int | None = None) -> Span:
    """Return the span of a period, the last full one unless a number is given.

    Without a full period that is the whole run. Raises SceneError where the run does not have
    the period that was asked for.
    """
    known = full_periods(history, period)
    if number is not None and number not in known:
        if period is None or not math.isfinite(period):
            raise SceneError("--period: nothing in this scene is periodic; leave it out.")
        have = f"periods {known[0]} to {known[-1]}" if known else "no full period"
        raise SceneError(f"--period {number}: the run has {have} of {period:g} s.")
    if not known or period is None:
        return Span(float(history["time"][0]), float(history["time"][-1]))
    number = known[-1] if number is None else number
    return Span((number - 1) * period, number * period, number)


def cut(history: History, span: Span) -> History:
    """Return the rows within the span and, between steps on straight lines, those at its ends."""
    time = history["time"]
    inside = (time > span.start) & (time < span.end)
    at = np.concatenate([[span.start], time[inside], [span.end]])
    if span.start == span.end:
        at = at[:1]
    return {name: np.interp(at, time, values) for name, values in history.items()} | {"time": at}


def mean(time: Array, values: Array) -> float:
    """Return the mean over time of values on straight lines; steps with a NaN end do not count."""
    step = np.diff(time)
    middle = 0.5 * (values[1:] + values[:-1])
    known = np.isfinite(middle)
    total = step[known].sum()
    if total <= 0:
        finite = values[np.isfinite(values)]
        return float(finite[0]) if len(finite) else math.nan
    return float((middle * step)[known].sum() / total)
