"""Limits and orders of sequences: exact where they are exact, cautious where they are not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.study.accuracy.convergence import (
    ORDERS,
    SAFETY,
    UNCONFIRMED,
    extrapolated,
    observed_order,
)

LIMITS = st.floats(-1e3, 1e3)
SLOPES = st.floats(0.1, 1e3) | st.floats(-1e3, -0.1)
BELIEVED = st.floats(0.5, 6.0)
RATIOS = st.lists(st.floats(1.5, 3.0), min_size=2, max_size=5)


def sizes_of(ratios: list[float]) -> np.ndarray:
    """Falling sizes from 1, each a ratio smaller than the one before."""
    return 1 / np.cumprod([1.0, *ratios])


@given(a=LIMITS, b=SLOPES, p=BELIEVED, ratios=RATIOS)
def test_a_power_is_followed_exactly(a: float, b: float, p: float, ratios: list[float]) -> None:
    h = sizes_of(ratios)
    v = a + b * h**p
    order = observed_order(h[-3:], v[-3:])
    # what rounding makes of the smaller difference
    loss = 4e-16 * np.abs(v).max() / abs(v[-2] - v[-1])
    if loss > 1e-9:  # the last levels are all but equal
        return
    assert order == pytest.approx(p, abs=1e-6 + 1e3 * loss)
    found = extrapolated(h, v)
    assert found.limit == pytest.approx(a, abs=1e-6 * abs(v[-1] - a) + 1e3 * loss * abs(b))
    assert abs(found.limit - a) <= found.uncertain
    assert found.uncertain <= SAFETY * abs(v[-1] - a) * 1.001 + 1e-12 * np.abs(v).max()


@given(a=st.floats(1, 1e3), b=SLOPES, p=BELIEVED, noise=st.integers(0, 2**32 - 1))
def test_noise_moves_the_limit_no_more_than_it_says(
    a: float, b: float, p: float, noise: int
) -> None:
    h = sizes_of([2.0] * 4)
    v = a + b * h**p
    relative = 1e-9
    v = v * (1 + relative * np.random.default_rng(noise).uniform(-1, 1, len(v)))
    found = extrapolated(h, v, noise=1e-8)
    assert abs(found.limit - a) <= found.uncertain + 20 * relative * np.abs(v).max()


@given(a=LIMITS, b=SLOPES, q=st.floats(0.1, 1.5), n=st.integers(3, 6))
def test_what_oscillates_has_no_order(a: float, b: float, q: float, n: int) -> None:
    v = a + b * (-q) ** np.arange(n)
    found = extrapolated(sizes_of([2.0] * (n - 1)), v)
    assert found.order is None
    assert found.limit == v[-1]
    assert found.uncertain >= np.ptp(v[-3:])
    if q < 1:
        assert abs(found.limit - a) <= found.uncertain


def test_what_does_not_come_closer_has_no_order() -> None:
    h = [1, 0.5, 0.25]
    assert observed_order(h, [0, 1, 2]) is None
    assert observed_order(h, [0, 1, 3]) is None
    found = extrapolated(h, [0, 1, 3])
    assert (found.limit, found.uncertain, found.order) == (3, 3, None)


def test_two_values_that_agree_by_accident_are_not_believed() -> None:
    h, v = [1, 0.5, 0.25], [1.03, 1.001, 1.0]
    assert observed_order(h, v) == pytest.approx(np.log2(29))
    assert observed_order(h, v, orders=(0.3, 3.5)) is None
    assert extrapolated(h, v, orders=(0.3, 3.5)).uncertain == pytest.approx(0.03)
    assert observed_order(h, [2.0, 1 + 1e-9, 1.0]) is None
    assert ORDERS[1] < np.log2(1e9)


def test_equal_values_are_the_limit() -> None:
    found = extrapolated([1, 0.5, 0.25], [2.0, 2.0, 2.0])
    assert (found.limit, found.order) == (2.0, None)
    assert 0 < found.uncertain < 1e-11


def test_few_values_tell_little() -> None:
    one = extrapolated([1.0], [3.0])
    assert (one.limit, one.uncertain, one.order) == (3.0, np.inf, None)
    two = extrapolated([1.0, 0.5], [3.0, 4.0])
    assert (two.limit, two.uncertain, two.order) == (4.0, 1.0, None)


def test_failed_levels_are_passed_over() -> None:
    h = np.array([1, 0.5, 0.25, 0.125])
    v = 7 + 3 * h**2
    v[1] = np.nan
    found = extrapolated(h, v)
    assert found.limit == pytest.approx(7)
    assert found.order == pytest.approx(2)


def test_a_fourth_level_that_agrees_makes_it_surer() -> None:
    h = np.array([1, 0.5, 0.25, 0.125])
    v = 7 + 3 * h**2
    assert extrapolated(h[1:], v[1:]).uncertain == pytest.approx(SAFETY * 3 / 64)
    assert extrapolated(h, v).uncertain == pytest.approx(0.1 * 3 / 64)


def test_a_fourth_level_that_does_not_agree_makes_it_less_sure() -> None:
    h = np.array([1, 0.5, 0.25, 0.125])
    v = 7 + 3 * h**2
    v[0] = 11  # the coarser levels have another limit
    first, all_of_them = extrapolated(h[:3], v[:3]), extrapolated(h, v)
    assert all_of_them.limit == pytest.approx(7)
    assert all_of_them.uncertain == pytest.approx(abs(first.limit - 7))
    v[0] = 7  # and now they have none
    assert extrapolated(h, v).uncertain == pytest.approx(UNCONFIRMED * 3 / 64)


@pytest.mark.parametrize(
    ("sizes", "values"),
    [([1, 1], [1, 2]), ([1, 2], [1, 2]), ([1, 0], [1, 2]), ([1, 0.5], [1]), ([1], [np.nan])],
)
def test_what_is_no_sequence_is_refused(sizes: list[float], values: list[float]) -> None:
    with pytest.raises(ValueError, match="sizes must fall|no value"):
        extrapolated(sizes, values)
