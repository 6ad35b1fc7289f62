"""What BDF looks back on: weights of the derivative, and which states a step uses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.solve.lookback import Entry, Lookback, derivative_weights


def entry(time: float, order: int = 1) -> Entry:
    return Entry(time, np.array([time]), {"pores": np.array([2.0 * time])}, 0.0, order)


steps = st.lists(st.floats(0.05, 20.0), min_size=1, max_size=5)
coefficients = st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=6)


@given(steps, coefficients, st.floats(-2.0, 2.0))
def test_weights_are_exact_for_polynomials(
        sizes: list[float], c: list[float], now: float) -> None:
    """k steps back, up to degree k; steps may differ by a factor of 400."""
    times = now - np.concatenate([[0.0], np.cumsum(sizes)])
    scaled = (times - now) / sizes[0]
    p = np.polynomial.Polynomial(c[: len(times)])
    terms = derivative_weights(times) * p(scaled)
    size = np.abs(terms).max() + 1.0 / sizes[0]
    assert terms.sum() == pytest.approx(p.deriv()(0.0) / sizes[0], abs=1e-11 * size)


@given(steps)
def test_weights_take_a_difference(sizes: list[float]) -> None:
    """What does not change has no rate; and the newest counts positive."""
    weights = derivative_weights(-np.concatenate([[0.0], np.cumsum(sizes)]))
    assert weights.sum() == pytest.approx(0.0, abs=1e-12 * np.abs(weights).max())
    assert weights[0] > 0.0


@pytest.mark.parametrize("expected", [[1.0, -1.0], [1.5, -2.0, 0.5],
                                      [11.0 / 6.0, -3.0, 1.5, -1.0 / 3.0]])
def test_equal_steps_give_the_textbook_formulas(expected: list[float]) -> None:
    times = 7.0 - 0.25 * np.arange(len(expected))
    assert derivative_weights(times) == pytest.approx(np.array(expected) / 0.25, rel=1e-12)


@pytest.mark.parametrize("highest", [1, 2, 3])
def test_a_start_takes_half_a_step_and_gains_an_order_with_each_step(highest: int) -> None:
    back = Lookback(highest)
    back.restart(entry(0.0))
    assert back.is_half(0.5, 1.0)
    assert not back.is_half(1.0, 1.0)
    assert back.order(half=True) == 1
    assert [e.time for e in back.nodes(half=True)] == [0.0]
    assert back.weights(0.5, half=True) == pytest.approx([2.0, -2.0])
    back.halfway(entry(0.5))
    for done in range(5):
        order = min(done + 2, highest)
        assert back.order(half=False) == order
        before = [float(done), *map(float, range(done - 1, -1, -1))]
        if done == 0:
            before = [0.0, 0.5]  # from the start to its half step: TSBDF's own order
        elif len(before) < order:
            before.append(0.5)
        assert [e.time for e in back.nodes(half=False)] == before[:order]
        assert len(back.weights(done + 1.0, half=False)) == order + 1
        back.accept(entry(done + 1.0, order))
        assert not back.is_half(done + 1.5, 1.0), "only a start takes half a step"
        assert back.steps == done + 1


def test_a_rate_is_that_of_the_interpolated_contents() -> None:
    """Contents that grow as 2 t have the rate 2 at every order and every step."""
    back = Lookback(3)
    back.restart(entry(0.0))
    back.halfway(entry(0.15))
    for time in (0.3, 0.35, 0.9, 1.0, 3.0):
        own, *others = back.weights(time, half=False)
        rate = own * 2.0 * time + sum(
            w * e.content["pores"][0]
            for w, e in zip(others, back.nodes(half=False), strict=True))
        assert rate == pytest.approx(2.0, rel=1e-12)
        back.accept(entry(time))


def test_no_more_is_kept_than_a_resumed_run_needs() -> None:
    back = Lookback(2)
    back.restart(entry(0.0))
    for time in range(1, 9):
        back.accept(entry(float(time)))
    assert [e.time for e in back.entries] == [8.0, 7.0, 6.0, 5.0]


def test_a_restart_forgets() -> None:
    back = Lookback(3)
    back.restart(entry(0.0))
    for time in (1.0, 2.0, 3.0):
        back.accept(entry(time))
    back.restart(entry(3.0))
    assert back.steps == 0
    assert [e.time for e in back.entries] == [3.0]
    assert [e.time for e in back.nodes(half=True)] == [3.0]
