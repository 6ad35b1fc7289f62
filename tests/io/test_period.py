"""Periods are found, cut out exactly and averaged over time."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.errors import SceneError
from porolub.io.period import Span, choose, cut, full_periods, mean
from tests.io.made_up_runs import case3


def history(*times: float) -> dict[str, np.ndarray]:
    time = np.array(times)
    return {"time": time, "load": 10 * time}


def test_the_last_full_period_is_chosen() -> None:
    data = history(0.0, 0.7, 1.0, 1.9, 2.0, 2.6)
    assert full_periods(data, 1.0) == range(1, 3)
    assert choose(data, 1.0) == Span(1.0, 2.0, 2)
    assert choose(data, 1.0, 1) == Span(0.0, 1.0, 1)


def test_rounding_takes_no_period_away() -> None:
    period = 1 / 3
    data = history(0.0, *(period * np.arange(1, 7) * (1 - 1e-15)))
    assert full_periods(data, period) == range(1, 7)
    from_rest = history(9e-7, 0.5, 1.0)  # begins a moment after t = 0
    assert full_periods(from_rest, 1.0) == range(1, 2)


def test_a_history_that_begins_later_lacks_the_first_periods() -> None:
    assert full_periods(history(1.5, 2.0, 4.2), 1.0) == range(3, 5)


@pytest.mark.parametrize("period", [None, math.inf, 3.0])
def test_without_a_full_period_it_is_the_whole_run(period: float | None) -> None:
    assert choose(history(0.5, 2.0), period) == Span(0.5, 2.0, None)


def test_a_period_the_run_does_not_have_is_refused() -> None:
    data = history(0.0, 2.5)
    with pytest.raises(SceneError, match=r"--period 3: the run has periods 1 to 2 of 1 s\."):
        choose(data, 1.0, 3)
    with pytest.raises(SceneError, match=r"--period 1: the run has no full period of 4 s\."):
        choose(data, 4.0, 1)
    for never in (None, math.inf):
        with pytest.raises(SceneError, match="nothing in this scene is periodic"):
            choose(data, never, 1)


def test_a_cut_has_its_ends_and_all_steps_between() -> None:
    data = history(0.0, 0.7, 1.2, 1.9, 2.6)
    part = cut(data, Span(1.0, 2.0, 2))
    np.testing.assert_allclose(part["time"], [1.0, 1.2, 1.9, 2.0])
    np.testing.assert_allclose(part["load"], 10 * part["time"])
    assert cut(data, Span(0.7, 0.7))["load"].tolist() == [7.0]


def test_a_value_that_is_missing_stays_missing() -> None:
    data = history(0.0, 1.0, 2.0, 3.0) | {"speed": np.array([1.0, np.nan, 3.0, 4.0])}
    part = cut(data, Span(0.5, 3.0))
    np.testing.assert_allclose(part["speed"], [np.nan, np.nan, 3.0, 4.0])


@given(st.integers(5, 60), st.floats(0.0, 2 * math.pi))
def test_the_mean_does_not_hang_on_the_steps(steps: int, phase: float) -> None:
    """Of a harmonic over a period that is its mean, however the steps are spread."""
    t = np.linspace(0, 1, 20 * steps + 1) ** 2
    values = 3.0 + np.sin(2 * math.pi * t + phase)
    assert mean(t, values) == pytest.approx(3.0, abs=40 / steps**2 / 100)


def test_the_mean_of_what_is_known() -> None:
    t = np.array([0.0, 1.0, 2.0, 4.0])
    assert mean(t, np.array([np.nan, 2.0, 4.0, 6.0])) == pytest.approx((3 + 10) / 3)
    assert mean(t, np.array([np.nan, np.nan, 5.0, np.nan])) == 5.0
    assert math.isnan(mean(t, np.full(4, np.nan)))
    assert mean(t[:1], np.array([7.0])) == 7.0


def test_the_made_up_run_has_five_periods() -> None:
    assert full_periods(case3(), 1.0) == range(1, 6)
