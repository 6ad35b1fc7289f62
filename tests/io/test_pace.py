"""The estimate of the wall time left knows tiny first steps, even steps and growing steps."""

import pytest

from porolub.io.pace import ENOUGH, Pace


def test_even_steps_go_on_as_they_are() -> None:
    pace = Pace(2.0, 7.0, wall=100.0)
    for i in range(1, 21):
        pace.step(2.0 + 0.05 * i, wall=100.0 + 3.0 * i)
        if i >= ENOUGH:
            assert pace.left() == pytest.approx(3.0 * (100 - i))


def test_tiny_first_steps_are_forgotten() -> None:
    pace = Pace(0.0, 5.0, wall=0.0)
    time, step, wall = 0.0, 1e-6, 0.0
    while time < 1.0:
        time, wall, step = time + step, wall + 1.0, min(1.3 * step, 0.02)
        pace.step(time, wall)
    whole_run = wall / time * (5.0 - time)
    left = pace.left()
    assert left == pytest.approx((5.0 - time) / 0.02, rel=0.03)
    assert whole_run > 1.3 * left


def test_steps_that_grow_with_time_are_not_taken_for_even_ones() -> None:
    """Consolidation from rest: each doubling of time costs the same ten seconds."""
    pace = Pace(0.0, 1024.0, wall=0.0)
    for i in range(11):
        pace.step(2.0**i, wall=10.0 * i)
    assert pace.left() == 0.0
    pace = Pace(0.0, 1024.0, wall=0.0)
    for i in range(9):
        pace.step(2.0**i, wall=10.0 * i)
    left, even = pace.left(), 10.0 / 128 * (1024 - 256)
    assert left == pytest.approx((20.0 * even) ** 0.5)


def test_a_few_steps_tell_nothing() -> None:
    pace = Pace(0.0, 1.0, wall=0.0)
    for i in range(1, ENOUGH):
        pace.step(0.01 * i, wall=float(i))
        assert pace.left() is None
    pace.step(0.01 * ENOUGH, wall=float(ENOUGH))
    assert pace.left() == pytest.approx(100 - ENOUGH)


def test_a_step_beyond_the_end_leaves_nothing() -> None:
    pace = Pace(0.0, 1.0, wall=0.0)
    for i in range(1, 12):
        pace.step(0.1 * i, wall=float(i))
    assert pace.left() == 0.0
