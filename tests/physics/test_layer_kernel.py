"""The reference itself: kernel and integral equation of the bonded layer against their limits."""

import numpy as np
import pytest

from tests.physics.layer_kernel import gauss, indentation, kernel

R, D, SHEAR = 1.0, 1e-3, 1e6


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_kernel_is_a_column_for_long_waves_and_a_half_space_for_short_ones(nu: float) -> None:
    u = np.array([1e-3, 30.0])
    slope = (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu) ** 2)  # w = p d/M
    long, short = kernel(u, nu)
    assert long == pytest.approx(slope * u[0], rel=1e-4)
    assert short == pytest.approx(1.0, abs=1e-12)


def test_narrow_contact_is_hertzian() -> None:
    a, nu = 0.01 * D, 0.3
    s = indentation(a, R, D, SHEAR, nu)
    assert s.force == pytest.approx(np.pi * a**2 * 2.0 * SHEAR / (1.0 - nu) / (4.0 * R), rel=1e-4)
    assert s.peak == pytest.approx(2.0 * s.force / (np.pi * a), rel=1e-8)
    assert s.spread == pytest.approx(a / 2.0, rel=1e-8)


def test_wide_contact_is_that_of_columns() -> None:
    a, nu = 30.0 * D, 0.3
    s = indentation(a, R, D, SHEAR, nu)
    modulus = 2.0 * SHEAR * (1.0 - nu) / (1.0 - 2.0 * nu)
    assert s.force == pytest.approx(2.0 / 3.0 * modulus * a**3 / (R * D), rel=0.02)
    assert s.approach == pytest.approx(a**2 / (2.0 * R), rel=0.02)


def test_more_terms_change_nothing() -> None:
    few, many = (indentation(2.0 * D, R, D, SHEAR, 0.45, n) for n in (10, 16))
    for name in ("force", "approach", "peak", "spread"):
        assert getattr(few, name) == pytest.approx(getattr(many, name), rel=1e-7)


def test_pressure_deforms_the_surface_to_the_cylinder() -> None:
    """Through the kernel again, by plain quadrature: w(x) = delta - x^2/(2R) in the contact."""
    a, nu = 1.3 * D, 0.3
    s = indentation(a, R, D, SHEAR, nu, terms=12)
    angle = (np.arange(2000) + 0.5) * np.pi / 2000
    places = a * np.cos(angle)
    load = s.pressure(places) * a * np.sin(angle) * np.pi / 2000
    k, w = gauss(np.linspace(0.0, 600.0 / a, 600), 12)
    transform = np.cos(np.outer(k, places)) @ load
    x = np.array([0.0, 0.5, 0.9]) * a
    sunk = np.cos(np.outer(x, k)) @ (w * kernel(k * D, nu) / k * transform)
    sunk *= (1.0 - nu) / (np.pi * SHEAR)
    assert sunk == pytest.approx(s.approach - x**2 / (2.0 * R), rel=1e-5)
