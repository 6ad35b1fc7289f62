"""Density over pressure: rho_0 at p = 0, the modulus 1/chi at any pressure, and its derivative."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.laws.fluid import CompressibleFluid

CHI = 0.4
PRESSURES = st.floats(-2.0, 3.0)


def density(pressure, chi=CHI):
    """rho / rho_0 and its slope."""
    excess, slope = CompressibleFluid(chi).excess_density(np.array(pressure))
    return 1.0 + excess, slope


def test_ambient_fluid_has_the_density_it_is_given():
    assert density(0.0) == (1.0, CHI)


@given(PRESSURES)
def test_the_bulk_modulus_is_the_same_at_any_pressure(pressure):
    ratio, slope = density(pressure)
    assert ratio > 0.0
    assert ratio / slope == pytest.approx(1.0 / CHI, rel=1e-12)


@given(PRESSURES, st.floats(0.1, 1.0))
def test_densities_multiply_as_pressures_add(pressure, step):
    product = density(pressure)[0] * density(step)[0]
    assert density(pressure + step)[0] == pytest.approx(product, rel=1e-12)


@given(PRESSURES)
def test_derivative_of_the_density(pressure):
    steps = np.array([1e-2, 5e-3])
    ratio, slope = density(pressure)
    rest = density(pressure + steps)[0] - ratio - steps * slope
    assert np.log2(rest[0] / rest[1]) == pytest.approx(2.0, abs=0.05)


@given(st.floats(1e-12, 1e-3))
def test_a_tiny_excess_is_not_lost_in_rounding(pressure):
    x = CHI * pressure
    excess, _ = CompressibleFluid(CHI).excess_density(np.array(pressure))
    assert excess == pytest.approx(x * (1.0 + x / 2.0 * (1.0 + x / 3.0)), rel=1e-11, abs=0.0)


def test_an_incompressible_fluid_has_no_excess_at_all():
    excess, slope = CompressibleFluid(0.0).excess_density(np.linspace(-3.0, 3.0, 7))
    assert not excess.any()
    assert not slope.any()
