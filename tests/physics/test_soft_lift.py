"""Lift of a cylinder on a thin, compressible, impermeable layer, no cavitation.

In the thin limit each column of the layer answers alone, h = h0 + x^2/(2R) + d p/M.  With
l = sqrt(2 R h0), X = x/l, P = p h0^2/(eta U l) and L = (d/M) eta U l/h0^3,
    (H^3 P')' = -6 H',   H = 1 + X^2 + L P,   P = 0 far away
(the body's side at X < 0 converges when the plane moves to -X), and the lift per eta U l^2/h0^2
is F = int P dX: F -> (3 pi/8) L for small L (Skotheim and Mahadevan 2004), 0.48594 at L = 1.
Scene: bonded layer, nu = 0.3, film, no pores; what remains is O((d/l)^2).
"""

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_bvp

from tests.physics.solved import Solved, solved

Array = NDArray[np.float64]
R, D, ETA = 10.0, 1e-3, 1e-3
E, NU = 1.5e6, 0.3
MODULUS = E * (1.0 - NU) / ((1.0 + NU) * (1.0 - 2.0 * NU))


@cache
def reference(softness: float, reach: float):
    """Solution of the equation on |X| <= reach with P = 0 at the ends, and its lift.

    Unknowns P, the constant flux c and the running lift; H^3 P' = c - 6 H.
    """
    X = np.sinh(np.linspace(-np.arcsinh(reach), np.arcsinh(reach), 801))

    def slopes(X: Array, y: Array) -> Array:
        H = 1.0 + X**2 + softness * y[0]
        return np.vstack([(y[1] - 6.0 * H) / H**3, 0.0 * X, y[0]])

    def ends(left: Array, right: Array) -> Array:
        return np.array([left[0], right[0], left[2]])

    guess = np.vstack([2.0 * X / (1.0 + X**2) ** 2, 8.0 + 0.0 * X, 0.0 * X])
    found = solve_bvp(slopes, ends, X, guess, tol=1e-9, max_nodes=100000)
    assert found.success, found.message
    return found.sol, float(found.y[2, -1])


@cache
def lifted(softness: float, width: float, reach: float, elements: int,
           sense: float = -1.0) -> tuple[Solved, float]:
    """The scene with l = `width` thicknesses, and the pressure scale eta U l/h0^2 (Pa)."""
    wide = width * D
    h0 = wide**2 / (2.0 * R)
    speed = softness * h0**3 * MODULUS / (D * ETA * wide)
    s = solved({
        "geometry": {"shape": "sector", "outer_radius": f"{R} m", "thickness": f"{D} m",
                     "half_angle": f"{reach * wide / R} rad"},
        "mesh": {"along": elements, "across": 2},
        "solid": {"law": "linear", "young_modulus": f"{E} Pa", "poisson_ratio": NU,
                  "base": "bonded"},
        "film": {"viscosity": f"{ETA} Pa*s"},
        "motion": {"kind": "sliding", "speed": f"{sense * speed} m/s"},
        "load": {"approach": f"{-h0} m"},
    })
    return s, ETA * speed * wide / h0**2


def lift(softness: float, width: float, reach: float, elements: int) -> float:
    s, scale = lifted(softness, width, reach, elements)
    return s.values["load_fluid"] / (scale * width * D)


def orders(errors: list[float]) -> Array:
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_reference_has_the_known_lifts() -> None:
    assert reference(1.0, 50.0)[1] == pytest.approx(0.48594, rel=1e-4)
    assert reference(0.01, 50.0)[1] == pytest.approx(0.01 * 3.0 * np.pi / 8.0, rel=1e-3)


@pytest.mark.parametrize(("softness", "tolerance"), [(1.0, 1e-3), (0.1, 3e-3)])
def test_lift_and_pressure_follow_the_thin_layer(softness: float, tolerance: float) -> None:
    """l/d = 20, |X| <= 8, 480 elements."""
    s, scale = lifted(softness, 20.0, 8.0, 480)
    P, exact = reference(softness, 8.0)
    assert lift(softness, 20.0, 8.0, 480) == pytest.approx(exact, rel=tolerance)
    profile = P(s.surface.s / (20.0 * D))[0]
    assert s.surface.p / scale == pytest.approx(profile, abs=0.01 * profile.max())
    assert s.values["mass_balance_error"] < 1e-8


def test_lift_of_an_unbounded_film() -> None:
    """|X| <= 20: L = 1 within 0.2 % of 0.48594."""
    assert lift(1.0, 20.0, 20.0, 800) == pytest.approx(0.48594, rel=2e-3)


def test_small_lift_is_proportional_to_softness() -> None:
    """L = 0.02: 1 % of the pressure's own size, so the two halves must cancel that well."""
    assert lift(0.02, 20.0, 20.0, 1600) == pytest.approx(0.02 * 3.0 * np.pi / 8.0, rel=0.02)


def test_what_remains_falls_with_the_square_of_the_thickness() -> None:
    errors = [abs(lift(1.0, width, 8.0, 960) / reference(1.0, 8.0)[1] - 1.0)
              for width in (5.0, 10.0, 20.0)]
    assert orders(errors)[0] == pytest.approx(2.0, abs=0.2), errors
    assert errors[-1] < 2e-4, errors  # where the mesh begins to show


def test_converges_with_the_elements() -> None:
    """l/d = 20: lift and film upwinding converge together, faster than first order."""
    errors = [abs(lift(1.0, 20.0, 8.0, n) / lift(1.0, 20.0, 8.0, 960) - 1.0)
              for n in (60, 120, 240)]
    assert np.all(orders(errors) > 1.8), errors
    assert errors[-1] < 2e-3, errors


def test_reversing_the_plane_mirrors_the_film() -> None:
    forth, _ = lifted(1.0, 20.0, 8.0, 240)
    back, _ = lifted(1.0, 20.0, 8.0, 240, sense=1.0)
    assert back.surface.p[::-1] == pytest.approx(forth.surface.p, abs=1e-8 * forth.surface.p.max())
    assert back.values["load_fluid"] == pytest.approx(forth.values["load_fluid"], rel=1e-8)
