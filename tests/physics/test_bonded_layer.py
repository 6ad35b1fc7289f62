"""Dry contact of a rigid plane with a thin elastic layer bonded to a rigid cylinder.

Frictionless, plane strain.  Exact: the integral equation with the kernel of the bonded layer
(``layer_kernel``), for a layer that is flat on the scale of the contact; a layer on a cylinder of
radius R differs by O(d/R), which the test lets vanish.  Limit a >> d, compressible (Johnson,
Contact Mechanics, 5.8): each column alone, a^2 = 2 R delta, P = (2/3) M a^3/(R d).
"""

from functools import cache

import numpy as np
import pytest

from tests.physics.layer_kernel import indentation
from tests.physics.solved import Solved, solved

E, D = 1e6, 1e-3  # Young's modulus, Pa; thickness, m


@cache
def pressed(nu: float, radius: float, half: float, elements: int, **load: str) -> Solved:
    """Contact on a layer of `half` thicknesses to each side, `elements` per thickness."""
    return solved({
        "geometry": {"shape": "sector", "outer_radius": f"{radius} m", "thickness": f"{D} m",
                     "half_angle": f"{half * D / radius} rad"},
        "mesh": {"along": round(2 * half * elements), "across": elements},
        "solid": {"law": "linear", "young_modulus": f"{E} Pa", "poisson_ratio": nu,
                  "base": "bonded"},
        "contact": {},
        "load": load,
    })


def shear(nu: float) -> float:
    return E / (2.0 * (1.0 + nu))


@pytest.mark.parametrize("nu", [0.3, 0.45])
@pytest.mark.parametrize("ratio", [0.9, 1.7, 3.3])
def test_matches_the_exact_layer_within_half_a_percent(nu: float, ratio: float) -> None:
    """Load given; approach, peak and half-width found. d/R = 1/1000, 12 elements per d."""
    a, radius, elements = ratio * D, 1.0, 12
    exact = indentation(a, radius, D, shear(nu), nu)
    s = pressed(nu, radius, ratio + 5.0, elements, force=f"{exact.force} N/m")
    assert s.values["approach"] == pytest.approx(exact.approach, rel=5e-3)
    assert s.values["contact_pressure_max"] == pytest.approx(exact.peak, rel=5e-3)
    assert s.values["contact_length"] / 2.0 == pytest.approx(a, abs=0.5 * D / elements)
    inside = np.abs(s.surface.x) < 0.9 * a
    error = s.surface.p_c - exact.pressure(s.surface.x)
    assert np.abs(error[inside]).max() < 0.02 * exact.peak


def test_what_remains_is_the_curvature_of_the_layer() -> None:
    """Given approach, nu = 0.45, a/d = 2: the load errs by -0.13 % for d/R = 1/1000, as d/R."""
    errors = []
    for radius in (1.0, 4.0, 16.0):
        exact = indentation(2.0 * D, radius, D, shear(0.45), 0.45)
        s = pressed(0.45, radius, 10.0, 8, approach=f"{exact.approach} m")
        errors.append(s.values["load_solid"] / exact.force - 1.0)
    assert abs(errors[0]) < 2e-3, errors
    assert errors[1] / errors[0] == pytest.approx(0.25, abs=0.02), errors
    assert abs(errors[2]) < 1e-4, errors


def test_wide_contact_is_that_of_independent_columns() -> None:
    """Given approach, nu = 0.3: the load tends to (2/3) M a^3/(R d) with (d/a)^2."""
    nu = 0.3
    modulus = 2.0 * shear(nu) * (1.0 - nu) / (1.0 - 2.0 * nu)
    errors = []
    for ratio in (10, 20, 40):
        a, radius = ratio * D, ratio**2 / 100.0  # the same approach: 0.5 % of the thickness
        s = pressed(nu, radius, ratio + 5.0, 4, approach=f"{a**2 / (2.0 * radius)} m")
        errors.append(s.values["load_solid"] / (2.0 / 3.0 * modulus * a**3 / (radius * D)) - 1.0)
        assert s.values["contact_length"] / 2.0 == pytest.approx(a, abs=0.25 * D)
    errors = np.abs(errors)
    assert errors[-1] < 2e-4, errors
    assert np.all(np.abs(np.log2(errors[:-1] / errors[1:]) - 2.0) < 0.2), errors
