"""Terzaghi's consolidation: a block that feels a sudden load at t = 0, drained at its top.

The load meets the undeformed layer, so the pressure starts at the load everywhere but at the top.
In space linear pressure is of order 2, and so is the settlement: in confined compression the
strain is (p - s)/M point by point, so the pressure's error drives it.  Quadratic pressure is of
order 4 at the nodes.
"""

from functools import cache

import numpy as np
import pytest

from tests.physics import consolidation as block
from tests.physics.stepped import Steps, stepped

SPACE = 3e-4  # error of 32 elements, after the first hundredth of TAU


@cache
def loaded(across: int, end: float, degree: int = 1, order: int = 2,
           tolerance: float = 1e-3) -> Steps:
    tables = block.column(across, end, degree=degree, order=order, tolerance=tolerance)
    return stepped(tables, block.settlement)


def errors(run: Steps, T: float) -> tuple[float, float]:
    """Largest nodal error at the end, of p over the load and of u over the drained settlement."""
    look = run.last()
    where, p = look.pressure()
    down = -look.displacement()[:, 1] / block.SETTLED
    exact = block.settlement_of_excess(look.nodes[:, 1], T)
    p_exact = block.excess_pressure(where[:, 1], T)
    return float(np.abs(p / block.LOAD - p_exact).max()), float(np.abs(down - exact).max())


@pytest.mark.parametrize(("T", "U"), [(0.1, 0.356823), (0.5, 0.763950)])
def test_textbook_numbers(T: float, U: float) -> None:
    assert block.degree_of_consolidation(T) == pytest.approx(U, abs=1e-6)
    run = loaded(32, T, order=3, tolerance=1e-5)
    assert run["time"][-1] == pytest.approx(T * block.TAU, rel=1e-12)
    assert run.seen[-1] / block.SETTLED == pytest.approx(U, abs=1e-4)


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_degree_of_consolidation_follows_the_series(order: int, tolerance: float) -> None:
    run = loaded(32, 1.0, 1, order, tolerance)
    T = run["time"] / block.TAU
    error = np.abs(run.sight / block.SETTLED - block.degree_of_consolidation(T))
    assert error[T > 0.01].max() < 3.0 * tolerance + SPACE
    assert error.max() < 0.01, "at first the load is felt by one element"
    assert np.all(np.diff(run.sight) > 0.0)


def test_order_one_is_what_it_is() -> None:
    run = loaded(32, 1.0, order=1)
    T = run["time"] / block.TAU
    error = np.abs(run.sight / block.SETTLED - block.degree_of_consolidation(T))
    assert 2e-3 < error[T > 0.01].max() < 2e-2
    assert set(run["order"]) == {1.0}


@pytest.mark.parametrize("T", [0.01, 0.1, 0.5])
def test_profile_of_the_pressure(T: float) -> None:
    p, u = errors(loaded(32, T, order=3, tolerance=1e-5), T)
    assert p < (3e-3 if T < 0.05 else 3e-4)
    assert u < 4e-4


@pytest.mark.parametrize(("degree", "counts", "least"), [(1, (4, 8, 16), 1.9), (2, (3, 6), 3.5)])
def test_orders_in_space(degree: int, counts: tuple[int, ...], least: float) -> None:
    """At T = 0.1; what is left of the error in time is below 1e-5."""
    found = np.array([errors(loaded(n, 0.1, degree, 3, 1e-6), 0.1) for n in counts])
    orders = np.log2(found[:-1] / found[1:])
    assert np.all(orders > least), found


def test_no_fluid_appears_or_vanishes() -> None:
    for order in (1, 2, 3):
        assert loaded(32, 1.0, 1, order).fluid_error() < 1e-10


def test_what_leaves_is_what_the_top_comes_down() -> None:
    """The fluid cannot be compressed: its mass is density times width times settlement."""
    run = loaded(32, 1.0)
    lost = 1000.0 * 0.5e-3 * (run.sight - run.seen[0])
    assert -run["fluid_content"] == pytest.approx(lost, abs=1e-9 * lost[-1])
