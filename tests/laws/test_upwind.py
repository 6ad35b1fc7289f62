"""The upwind function coth(Pe) - 1/Pe: its limits, its seams, its derivative."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.laws.upwind import streamline_diffusivity, upwind_derivative, upwind_function


def at(function, peclet):
    return float(function(np.array(peclet, dtype=float)))


@given(st.floats(0.5, 100.0))
def test_is_coth_minus_reciprocal(peclet):
    expected = np.cosh(peclet) / np.sinh(peclet) - 1 / peclet
    assert at(upwind_function, peclet) == pytest.approx(expected, rel=1e-13)


@given(st.floats(0.0, 1e6))
def test_lies_between_nothing_and_full_upwinding(peclet):
    value = at(upwind_function, peclet)
    assert 0.0 <= value <= min(1.0, peclet / 3 + 1e-15)
    assert value == at(upwind_function, -peclet)


def test_limits():
    assert at(upwind_function, 0.0) == 0.0
    assert at(upwind_function, 1e-5) == pytest.approx(1e-5 / 3, rel=1e-9)
    assert at(upwind_function, 1e5) == pytest.approx(1.0 - 1e-5, rel=1e-12)
    assert at(upwind_derivative, 0.0) == pytest.approx(1 / 3)


@pytest.mark.parametrize("function", [upwind_function, upwind_derivative])
def test_series_and_closed_form_meet(function):
    seam = 1e-2
    assert at(function, seam * (1 - 1e-9)) == pytest.approx(at(function, seam), rel=1e-7)


@given(st.floats(0.0, 50.0))
def test_derivative(peclet):
    step = 1e-4 * (1.0 + peclet)
    difference = at(upwind_function, peclet + step) - at(upwind_function, abs(peclet - step)) * (
        1.0 if peclet >= step else -1.0)
    assert at(upwind_derivative, peclet) == pytest.approx(difference / (2 * step), rel=1e-4)


@pytest.mark.parametrize("peclet", [2e2, 1e3, 1e6, 1e100])
def test_derivative_fades_as_the_inverse_square(peclet):
    assert at(upwind_derivative, peclet) == pytest.approx(peclet**-2.0, rel=1e-12)


@given(st.floats(0.1, 10.0), st.floats(0.01, 1.0), st.floats(0.05, 5.0))
def test_one_dimensional_transport_becomes_nodally_exact(speed, length, peclet):
    """With the extra diffusivity the central three-point scheme keeps exp(v x / c)."""
    diffusivity = speed * length / (2 * peclet)
    total = diffusivity + float(streamline_diffusivity(
        np.array(speed), np.array(length), diffusivity))
    left, here, right = np.exp(speed / diffusivity * length * np.array([-1.0, 0.0, 1.0]))
    transport = speed * (right - left) / 2
    spreading = total * (right - 2 * here + left) / length
    assert spreading == pytest.approx(transport, rel=1e-8)


def test_streamline_diffusivity_fades_with_refinement():
    length = 0.1 * 0.5 ** np.arange(3)
    extra = streamline_diffusivity(np.ones(3), length, 1.0)
    np.testing.assert_allclose(np.log2(extra[:-1] / extra[1:]), 2.0, atol=0.01)
    assert streamline_diffusivity(np.zeros(1), np.ones(1), 1.0) == 0.0
    assert streamline_diffusivity(np.ones(1), np.full(1, 0.2), 0.0) == pytest.approx(0.1)
