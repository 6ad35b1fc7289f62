"""A block of the paper's solid under a load on its drained top: steady, finite strain.

With J = l the stretch and C = diag(1, l^2, 1), the paper's weighted W (a the Biot coefficient)
gives P(l) = (2 a G/3) (l^(1/3) - l^(-5/3)) + (1 - a) K (l - 1), and p = 0 throughout.  The
solution is linear in space: every mesh must reproduce it to the solver's tolerance.
"""

from typing import Any

import numpy as np
import pytest

from tests.physics.solved import Solved, solved

G, K, BIOT, THICKNESS = 0.5e6, 5e6, 0.9, 1e-3


def stress(stretch: float, shear: float = BIOT * G, bulk: float = (1.0 - BIOT) * K) -> float:
    """Nominal stress, tension positive, Pa."""
    return (2.0 * shear / 3.0 * (stretch ** (1.0 / 3.0) - stretch ** (-5.0 / 3.0))
            + bulk * (stretch - 1.0))


def block(load: float, dimension: int = 2, frame: str = "spatial", **sections: Any) -> Solved:
    deep = {"depth": "1.5 mm"} if dimension == 3 else {}
    count = {"deep": 2} if dimension == 3 else {}
    return solved({
        "scene": {"dimension": dimension},
        "geometry": {"shape": "block", "width": "2 mm", "thickness": f"{THICKNESS} m", **deep},
        "mesh": {"along": 3, "across": 4, **count},
        "solid": {"law": "neo-hookean", "shear_modulus": f"{G} Pa", "bulk_modulus": f"{K} Pa"},
        "pores": {"biot": BIOT, "permeability": "1 um^3/mm", "viscosity": "1 mPa*s"},
        "boundary": {"top": {"traction": f"{load} Pa", "pressure": "0 Pa"}},
        "conventions": {"frame": frame},
        **sections,
    })


def check(of: Solved, stretch: float) -> None:
    height = of.fields.nodes[:, 1]
    u = of.fields.displacement
    assert u[:, 1] == pytest.approx((stretch - 1.0) * height, rel=1e-9, abs=1e-9 * THICKNESS)
    assert np.abs(np.delete(u, 1, axis=1)).max() < 1e-9 * THICKNESS
    assert of.fields.jacobian == pytest.approx(np.full(len(u), stretch), rel=1e-9)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("stretch", [0.3, 0.5, 0.8, 0.97, 1.2])
def test_stretch_under_a_load(dimension: int, stretch: float) -> None:
    s = block(-stress(stretch), dimension)
    check(s, stretch)
    assert s.fields.pressure is not None
    assert np.abs(s.fields.pressure).max() < 1e-9 * abs(stress(stretch))


def test_the_frame_of_the_pressure_does_not_matter_when_drained() -> None:
    check(block(-stress(0.8), frame="material"), 0.8)


def test_without_pores_the_moduli_count_in_full() -> None:
    load = -stress(0.8, G, K)
    boundary = {"top": {"traction": f"{load} Pa"}}
    s = block(load, boundary=boundary, pores=None)
    check(s, 0.8)


def test_given_displacement_of_the_top() -> None:
    top = {"displacement": {"y": f"{-0.3 * THICKNESS} m"}, "pressure": "0 Pa"}
    check(block(0.0, boundary={"top": top}), 0.7)


def test_stress_of_von_mises() -> None:
    """Cauchy: s_y = P, s_x = s_z from dW = (a G/3) J^(-5/3) (1 - l^2) + (1 - a) K (l - 1)."""
    stretch = 0.8
    s = block(-stress(stretch))
    lateral = BIOT * G / 3.0 * stretch ** (-5.0 / 3.0) * (1.0 - stretch**2)
    lateral += (1.0 - BIOT) * K * (stretch - 1.0)
    exact = abs(stress(stretch) - lateral)
    assert s.fields.von_mises == pytest.approx(np.full(len(s.fields.von_mises), exact), rel=1e-8)


def test_a_pressure_difference_drives_darcy_flow_through_the_block() -> None:
    """Small strain: 1 Pa below and 0 above give a linear pressure and the flux kappa/(eta d)."""
    held = {"displacement": {"x": "0 m", "y": "0 m"}}
    below = {**held, "pressure": "1 Pa"}
    s = block(0.0, boundary={"top": {**held, "pressure": "0 Pa"}, "bottom": below})
    height = s.fields.nodes[:, 1]
    assert s.fields.pressure == pytest.approx(1.0 - height / THICKNESS, abs=1e-5)
    assert s.fields.flux is not None
    flux = np.full(len(height), 1e-15 / 1e-3 / THICKNESS)
    assert s.fields.flux[:, 1] == pytest.approx(flux, rel=1e-4)
    assert s.values["mass_balance_error"] < 1e-8
