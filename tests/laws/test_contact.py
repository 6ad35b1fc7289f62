"""Contact as one equation: its zeros are contact or a gap, never both, never tension."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.laws.contact import complementarity

C = 2.5
NUMBERS = st.floats(-1.0, 1.0)


def law(pressure, gap, *smoothing):
    return complementarity(np.array(pressure), np.array(gap), C, *smoothing)


def point(pressure, gap, *smoothing):
    """Value and derivatives at one point, as numbers."""
    return tuple(float(a[0]) for a in law([pressure], [gap], *smoothing))


@pytest.mark.parametrize(
    ("pressure", "gap", "sign"),
    [
        (0.0, 0.3, 0),  # open
        (0.4, 0.0, 0),  # closed and pressed
        (0.0, 0.0, 0),  # just touching
        (0.4, 0.3, 1),  # pressure across a gap
        (-0.4, 0.3, -1),  # tension across a gap
        (-0.4, 0.0, -1),  # glue
        (0.0, -0.3, -1),  # overlap without pressure
        (0.4, -0.3, -1),  # overlap
        (-0.4, -0.3, -1),
    ],
)
def test_zero_exactly_where_contact_is_possible(pressure, gap, sign):
    assert np.sign(point(pressure, gap)[0]) == sign


@given(NUMBERS, NUMBERS)
def test_is_the_minimum(pressure, gap):
    value, by_pressure, by_gap = point(pressure, gap)
    assert value == pytest.approx(min(pressure, C * gap), abs=1e-15)
    if abs(pressure - C * gap) > 1e-12:  # one branch or the other
        assert (by_pressure, by_gap) == ((1.0, 0.0) if pressure < C * gap else (0.0, C))


def test_a_kink_has_the_derivative_of_one_of_its_branches():
    _, by_pressure, by_gap = law([0.0, 0.5], [0.0, 0.5 / C])
    assert set(zip(by_pressure, by_gap, strict=True)) <= {(1.0, 0.0), (0.0, C)}


@given(st.floats(1e-3, 1.0), st.floats(1e-3, 0.5))
def test_smooth_minimum_is_zero_on_the_central_path(pressure, t):
    gap = t**2 / (C * pressure)
    assert point(pressure, gap, t)[0] == pytest.approx(0.0, abs=1e-13)
    assert point(1.1 * pressure, gap, t)[0] > 0
    assert point(pressure, 0.9 * gap, t)[0] < 0


@given(NUMBERS, NUMBERS, st.floats(0.2, 1.0))
def test_derivative_of_the_smooth_minimum(pressure, gap, t):
    value, by_pressure, by_gap = point(pressure, gap, t)
    errors = []
    for step in 1e-2 * np.array([1.0, 0.5]):
        moved = point(pressure + step, gap - step, t)[0]
        errors.append(abs(moved - value - step * (by_pressure - by_gap)))
    assert errors[1] > 1e-9, "nothing was tested"
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


@given(NUMBERS, NUMBERS)
def test_smooth_minimum_tends_to_the_minimum_from_below(pressure, gap):
    exact = min(pressure, C * gap)
    distance = [exact - point(pressure, gap, t)[0] for t in (1e-1, 1e-2, 1e-3)]
    assert all(-1e-15 <= d <= t for d, t in zip(distance, (1e-1, 1e-2, 1e-3), strict=True))
    assert distance[0] > distance[2]
