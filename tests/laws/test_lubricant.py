"""Thin film: conductance from the velocity profile, shear stress at the wall, film thickness."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.laws.lubricant import Newtonian, film_thickness

ETA, H_MIN = 3e-3, 0.2
LAW = Newtonian(ETA, H_MIN)
HEIGHTS = st.floats(0.01, 2.0)


def profile(y, h, slope, speed):
    """Velocity between a wall at rest (y = 0) and one that moves at `speed` (y = h)."""
    return slope / (2 * ETA) * y * (y - h) + speed * y / h


@given(HEIGHTS, st.floats(-5.0, 5.0))
def test_conductance_is_the_flux_of_the_parabolic_profile(h, slope):
    y, weight = np.polynomial.legendre.leggauss(3)
    y, weight = (y + 1) * h / 2, weight * h / 2
    flux = weight @ profile(y, h, slope, 0.0)
    assert -LAW.conductance(np.array(h)) * slope == pytest.approx(flux, rel=1e-12, abs=1e-15)


@given(st.floats(0.3, 2.0), st.floats(-5.0, 5.0), st.floats(-2.0, 2.0))
def test_shear_stress_is_that_of_the_profile_at_the_moving_wall(h, slope, speed):
    step = 1e-3 * h  # the profile is a parabola: the central difference is exact
    shear = ETA * (profile(h + step, h, slope, speed) - profile(h - step, h, slope, speed))
    found = LAW.shear_stress(np.array(h), np.array(slope), np.array(speed))
    assert found == pytest.approx(shear / (2 * step), rel=1e-10, abs=1e-10)


@given(st.floats(0.0, H_MIN))
def test_shear_stress_is_bounded_where_the_film_vanishes(h):
    found = LAW.shear_stress(np.array(h), np.array(0.0), np.array(2.0))
    assert found == pytest.approx(ETA * 2.0 / H_MIN)


@given(HEIGHTS)
def test_derivative_of_the_conductance(h):
    steps = h * np.array([1e-2, 5e-3])
    slope = LAW.conductance_derivative(np.array(h))
    rest = LAW.conductance(h + steps) - LAW.conductance(np.array(h)) - steps * slope
    assert np.log2(rest[0] / rest[1]) == pytest.approx(2.0, abs=0.05)


def test_a_closed_film_conducts_nothing():
    gap = np.array([-0.3, -1e-300, 0.0, 1e-300, 0.4])
    h, slope = film_thickness(gap)
    np.testing.assert_array_equal(h, [0.0, 0.0, 0.0, 1e-300, 0.4])
    np.testing.assert_array_equal(slope, [0.0, 0.0, 0.0, 1.0, 1.0])
    np.testing.assert_array_equal(LAW.conductance(h[:3]), 0.0)
    np.testing.assert_array_equal(LAW.conductance_derivative(h[:3]), 0.0)
