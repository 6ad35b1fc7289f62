"""Samples over time: on the samples exact, in between within them, kinks where the slope jumps."""

import itertools
import math
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from porolub.scene.curve import Curve
from porolub.scene.samples import Samples
from porolub.scene.units import Pressure
from tests.scene.scenes import sample_tables

TABLES = sample_tables("Pa", -100, 100)


def samples(**keys: Any) -> Samples[float]:
    return Samples[Pressure].model_validate(keys)


RAMP: dict[str, Any] = {"times": ["1 s", "2 s", "4 s"], "values": ["0 Pa", "3 Pa", "1 Pa"]}
CYCLE: dict[str, Any] = {
    "times": ["0 s", "250 ms", "1 s"],
    "values": ["1 Pa", "4 Pa", "1 Pa"],
    "repeat": True,
}


def test_lines_join_the_samples_and_hold_beyond_them() -> None:
    ramp = samples(**RAMP)
    assert [ramp.at(t) for t in (0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0)] == [0, 0, 1.5, 3, 2, 1, 1]
    assert ramp.period == math.inf
    assert ramp.kinks(0.0, 10.0) == [1.0, 2.0, 4.0]
    assert ramp.kinks(1.0, 4.0) == [2.0]


def test_samples_that_repeat_have_the_period_they_span() -> None:
    cycle = samples(**CYCLE)
    assert cycle.period == 1.0
    assert cycle.at(17.125) == pytest.approx(2.5)
    assert cycle.kinks(0.0, 2.0) == [0.25, 1.0, 1.25]
    assert cycle.kinks(0.25, 1.0) == []


def test_a_sample_on_a_straight_line_is_no_kink() -> None:
    straight = samples(times=["0 s", "0.1 s", "0.3 s"], values=["0 Pa", "1 Pa", "3 Pa"])
    assert straight.kinks(0.0, 1.0) == [0.3]


def test_a_smooth_curve_has_kinks_only_where_it_begins_and_ends_to_be_held() -> None:
    assert samples(**RAMP, interpolation="smooth").kinks(0.0, 10.0) == [1.0, 4.0]
    assert samples(**CYCLE, interpolation="smooth").kinks(0.0, 10.0) == []


@pytest.mark.parametrize("interpolation", ["linear", "smooth"])
def test_equal_values_are_a_constant(interpolation: str) -> None:
    flat = samples(times=["1 s", "2 s"], values=["3 Pa", "3 Pa"], interpolation=interpolation)
    assert flat.period is None
    assert flat.kinks(0.0, 9.0) == []
    assert flat.at(1.5) == 3.0


@pytest.mark.parametrize(
    ("keys", "lowest", "highest"),
    [(RAMP, (0.0, 0.0), (3.0, 2.0)), (CYCLE, (1.0, 0.0), (4.0, 0.25))],
)
def test_extremes_come_with_the_first_time_they_are_reached(
    keys: dict[str, Any], lowest: tuple[float, float], highest: tuple[float, float]
) -> None:
    history = samples(**keys)
    assert (history.lowest.value, history.lowest.time) == lowest
    assert (history.highest.value, history.highest.time) == highest


def test_what_repeats_repeats_before_its_first_sample_too() -> None:
    late = samples(times=["2 s", "2.5 s", "3 s"], values=["1 Pa", "2 Pa", "1 Pa"], repeat=True)
    assert late.at(0.5) == 2.0
    assert late.highest.time == 0.5
    assert late.kinks(0.0, 1.6) == [0.5, 1.0, 1.5]


@given(st.lists(st.floats(-1, 1), min_size=2, max_size=6))
def test_a_smooth_cycle_has_no_corner_where_it_closes(values: list[float]) -> None:
    """The slope there is that of a cycle which begins at any other of its samples."""
    n = len(values)
    turned = values[1:] + values[:1]
    times = [float(k) for k in range(n + 1)]
    one = Curve(times, [*values, values[0]], smooth=True, repeat=True)
    other = Curve(times, [*turned, turned[0]], smooth=True, repeat=True)
    assert [one.at(t / 7) for t in range(7 * n)] == pytest.approx(
        [other.at(t / 7 - 1) for t in range(7 * n)], abs=1e-9
    )


@given(TABLES)
def test_it_takes_the_samples_values_at_their_times(table: dict[str, Any]) -> None:
    history = samples(**table)
    pairs = zip(history.times, history.values, strict=True)
    assert all(history.at(t) == pytest.approx(v, abs=1e-9) for t, v in pairs)


@given(TABLES, st.floats(0, 50))
def test_it_stays_within_its_extremes(table: dict[str, Any], t: float) -> None:
    history = samples(**table)
    low, high = history.lowest.value, history.highest.value
    assert low - 1e-9 <= history.at(t) <= high + 1e-9
    assert history.at(history.lowest.time) == pytest.approx(low, abs=1e-9)
    assert history.at(history.highest.time) == pytest.approx(high, abs=1e-9)


@given(TABLES, st.floats(0, 50))
def test_it_repeats_after_its_period(table: dict[str, Any], t: float) -> None:
    history = samples(**table)
    assume(history.period not in (None, math.inf))
    assert history.at(t + (history.period or 0)) == pytest.approx(history.at(t), abs=1e-6)


@given(TABLES, st.floats(0, 20), st.floats(0.1, 20))
def test_between_kinks_the_slope_is_continuous(
    table: dict[str, Any], start: float, length: float
) -> None:
    """The slopes on both sides of a moment differ only by what the curvature lets them."""
    history = samples(**table)
    end, d = start + length, 1e-6
    ends = [start, *history.kinks(start, end), end]
    assert ends == sorted(ends)
    gaps = zip(history.times[:-1], history.times[1:], strict=True)
    shortest = min(b - a for a, b in gaps)
    bend = 20 * (max(history.values) - min(history.values)) / shortest**2  # bound of a cubic's
    for a, b in itertools.pairwise(ends):
        if b - a < 4 * d:
            continue
        for t in (a + 2 * d, (a + b) / 2, b - 2 * d):
            before = (history.at(t) - history.at(t - d)) / d
            after = (history.at(t + d) - history.at(t)) / d
            assert abs(after - before) <= bend * d + 1e-5


@given(st.lists(st.integers(-3, 3), min_size=2, max_size=8), st.booleans())
def test_lines_have_a_kink_at_every_sample_where_the_rise_changes(
    values: list[int], repeat: bool
) -> None:
    if repeat:
        values = [*values, values[0]]
    rises = [b - a for a, b in itertools.pairwise(values)]
    around = [rises[-1] if repeat else 0, *rises, rises[0] if repeat else 0]
    corners = [float(k) for k in range(len(values)) if around[k] != around[k + 1]]
    curve = Curve([float(k) for k in range(len(values))], values, smooth=False, repeat=repeat)
    assert curve.kinks(-0.5, len(values) - 0.5) == corners


def test_a_step_that_ends_on_a_kink_does_not_meet_it_again() -> None:
    cycle = Curve([0.1, 0.3, 0.8], [1.0, 2.0, 1.0], smooth=False, repeat=True)
    t, landed = 0.0, []
    while len(landed) < 500:
        t = cycle.kinks(t, t + 1.0)[0]
        landed.append(t)
    assert landed == cycle.kinks(0.0, t + 1e-9)
    assert len(landed) == len({round(x, 6) for x in landed})
