"""A block under tractions and pressures on named boundaries: no plane, no film, no contact."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from porolub.scene import scene_from_dict
from tests.run.output import Output, run

G, K, BIOT, D = 0.5e6, 2e6, 0.9, 1e-3
SOLID = {"shear_modulus": f"{G} Pa", "bulk_modulus": f"{K} Pa"}
PORES = {"biot": BIOT, "permeability": "1 um^3/mm", "viscosity": "1 mPa*s", "carry": False}
ROLLER = {"displacement": {"normal": "0 mm"}}


def pressed(directory: Path, law: str, boundary: dict[str, Any], **sections: Any) -> Output:
    scene = scene_from_dict({
        "geometry": {"shape": "block", "width": "4 mm", "thickness": f"{D} m"},
        "mesh": {"along": 5, "across": 4}, "solid": {"law": law, **SOLID},
        "boundary": boundary, **sections})
    return run(directory, scene)


def test_confined_compression_of_a_drained_block(tmp_path: Path) -> None:
    """P(l) = (2 a G/3)(l^(1/3) - l^(-5/3)) + (1 - a) K (l - 1) = -traction, uniform stretch l."""
    top = {"traction": "0.1 MPa", "pressure": "0 Pa"}
    found = pressed(tmp_path, "neo-hookean", {"top": top}, pores=PORES)

    def stress(stretch: float) -> float:
        shear = 2 * BIOT * G / 3 * (stretch ** (1 / 3) - stretch ** (-5 / 3))
        return shear + (1 - BIOT) * K * (stretch - 1)

    stretch = brentq(lambda x: stress(x) + 0.1e6, 0.5, 1.0, xtol=1e-14)
    fields = found.fields
    np.testing.assert_allclose(fields.jacobian, stretch, rtol=1e-9)
    np.testing.assert_allclose(
        fields.displacement[:, 1], (stretch - 1) * fields.nodes[:, 1], atol=1e-12)
    assert np.abs(fields.pressure).max() < 1e-4


def test_seepage_through_a_linear_block_is_reproduced(tmp_path: Path) -> None:
    """p linear, and M u'' = a p' with u = 0 below and the traction a p = 0 on top: u quadratic."""
    boundary = {"bottom": {**ROLLER, "pressure": "20 kPa"}, "top": {"pressure": "0 Pa"}}
    found = pressed(tmp_path, "linear", boundary, pores=PORES)
    fields, M = found.fields, K + 4 * G / 3
    y = fields.nodes[:, 1]
    np.testing.assert_allclose(fields.pressure, 20e3 * (1 - y / D), atol=1e-7)
    # u'(y) = a p / M, so that the total stress M u' - a p vanishes
    u = BIOT * 20e3 / M * (y - y**2 / (2 * D))
    np.testing.assert_allclose(fields.displacement[:, 1], u, atol=1e-14)
    np.testing.assert_allclose(fields.flux[:, 1], 1e-12 * 20e3 / D, rtol=1e-9)
    assert found.summary["mass_balance_error"] < 1e-10
    assert found.summary["effects"] == ["solid", "pores"]


def test_a_traction_by_components_shears_a_block(tmp_path: Path) -> None:
    """Simple shear of a linear block: u_x = tau y / G, with the matching tractions at the sides."""
    tau = 1e3
    boundary = {
        "bottom": {"displacement": {"x": "0 mm", "y": "0 mm"}},
        "top": {"traction": {"x": f"{tau} Pa"}},
        "right": {"traction": {"y": f"{tau} Pa"}}, "left": {"traction": {"y": f"{-tau} Pa"}},
    }
    found = pressed(tmp_path, "linear", boundary)
    nodes, u = found.fields.nodes, found.fields.displacement
    np.testing.assert_allclose(u[:, 0], tau / G * nodes[:, 1], atol=1e-14)
    np.testing.assert_allclose(u[:, 1], 0.0, atol=1e-14)
    np.testing.assert_allclose(found.fields.von_mises, np.sqrt(3) * tau, rtol=1e-9)


def test_a_block_may_be_pressed_by_many_elements(tmp_path: Path) -> None:
    found = pressed(tmp_path, "neo-hookean", {"top": {"displacement": {"y": "-0.5 mm"}}})
    np.testing.assert_allclose(found.fields.jacobian, 0.5, rtol=1e-9)
    assert found.summary["status"] == "converged"


def test_what_a_plain_block_does_not_have_is_null_and_not_written(tmp_path: Path) -> None:
    found = pressed(tmp_path, "linear", {"top": {"traction": "1 kPa"}})
    for key in ("approach", "film_min", "contact_length", "friction_coefficient",
                "load_balance_error", "pressure_max"):
        assert found.summary[key] is None, key
    names = {path.name for path in tmp_path.iterdir()}
    assert "surface.csv" not in names
    assert "surface.png" not in names
    assert {"von_mises.png", "fields.h5", "checkpoint.h5"} <= names
    assert found.summary["dofs"] == {"displacement": 2 * 11 * 9, "total": 2 * 11 * 9}
    assert found.summary["von_mises_max"] == pytest.approx(found.fields.von_mises.max())
