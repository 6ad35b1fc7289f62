"""Three dimensions know no direction: turned scenes and halves give the numbers of the whole."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.physics.rolling import rolling
from tests.physics.solid_files import barrel, cap, solid_file
from tests.physics.solved import solved

R, D = 0.1, 1e-3
SAME = 1e-6  # rounding through Newton
LOADS = ("load_total", "load_solid", "load_fluid")
FLOWS = ("inflow_left", "inflow_right", "outflow_left", "outflow_right")
LEVELS = ("approach", "contact_length", "contact_left", "contact_right", "pressure_max",
          "pressure_min", "contact_pressure_max", "friction_coefficient")


def crowned(symmetry: list[str], deep: int, force: str) -> dict[str, Any]:
    return rolling(20, 2, scene={"dimension": 3}, mesh={"deep": deep}, load={"force": force},
                   geometry={"shape": "barrel", "width": "20 mm", "crown_radius": "200 mm",
                             "symmetry": symmetry})


def test_half_a_joint_carries_half_the_load() -> None:
    """Whole, front half, back half: equal pressures and lengths, twice the loads and flows."""
    whole = solved(crowned([], 4, "12 N")).values
    for end in ("front", "back"):
        half = solved(crowned([end], 2, "6 N")).values
        for key in LOADS + FLOWS:
            assert 2.0 * half[key] == pytest.approx(whole[key], rel=SAME), (end, key)
        for key in LEVELS:
            assert half[key] == pytest.approx(whole[key], rel=SAME), (end, key)


def test_a_crown_s_end_is_ambient_and_a_slice_s_is_not() -> None:
    """The pressure of the surface at the back: zero at a real end, the slice's own elsewhere."""
    for symmetry, ambient in ((["front"], True), (["front", "back"], False)):
        tables = rolling(20, 2, scene={"dimension": 3}, mesh={"deep": 2}, load={"force": "3 N"},
                         geometry={"shape": "barrel", "width": "4 mm", "symmetry": symmetry})
        of = solved(tables)
        model = of.outcome.model
        dofs, mesh = model.dofs, model.mesh
        p = dofs.field("p", model.system.physical(dofs.to_local(of.outcome.x)))[:, 0]
        back = np.isin(dofs.nodes["p"], np.intersect1d(mesh.boundary_nodes("lubricated"),
                                                       mesh.boundary_nodes("back")))
        largest = np.abs(p[back]).max()
        assert largest == 0.0 if ambient else largest > 0.5 * np.abs(p).max()


@pytest.mark.parametrize("order", [(1, 2, 0), (2, 0, 1), (0, 2, 1)])
def test_a_turned_joint_is_the_same_joint(tmp_path: Path, order: tuple[int, ...]) -> None:
    """A barrel in a file with its axes renamed, rolling: a plane and an axis of any direction.

    The last is a reflection, under which an axis of rotation points the other way.
    """
    place, found = barrel(R, D, 0.08, 2e-3), []
    for k, axes in enumerate(((0, 1, 2), order)):
        turned = np.argsort(axes)
        normal, axis = np.array([0.0, -1.0, 0.0])[turned], np.array([0.0, 0.0, 1.0])[turned]
        mirrored = np.linalg.det(np.eye(3)[turned])
        path = solid_file(tmp_path / f"{k}.msh", (24, 2, 1), lambda q, t=turned: place(q)[:, t])
        tables = rolling(scene={"dimension": 3}, load={"force": "3 N"})
        del tables["mesh"]
        tables["geometry"] = {"shape": "file", "path": str(path), "plane_normal": normal.tolist(),
                              "symmetry": ["front", "back"]}
        tables["motion"]["axis"] = (mirrored * axis).tolist()
        tables["motion"]["speed"] = "0.3 rad/s"
        found.append(solved(tables).values)
    for key in ("approach", "load_solid", "load_fluid", "pressure_max", "pressure_min"):
        assert found[1][key] == pytest.approx(found[0][key], rel=SAME), key


@pytest.mark.parametrize("kind", ["sliding", "rotation"])
def test_a_sphere_has_no_preferred_direction(tmp_path: Path, kind: str) -> None:
    """A film under a rigid sphere, moved along x and along z over a mesh that looks alike."""
    reach = 4e-3
    square = np.arcsin(reach / R)
    values = []
    for along in ("x", "z"):
        order = [0, 1, 2] if along == "x" else [2, 1, 0]
        path = solid_file(tmp_path / f"{along}.msh", (12, 1, 12),
                          lambda q, o=order: cap(R, D, square, reach)(q)[:, o])
        moves: dict[str, Any] = {"kind": "sliding", "speed": "0.1 m/s", "direction": along}
        if kind == "rotation":
            moves = {"kind": "rotation", "speed": "1 rad/s",
                     "axis": "z" if along == "x" else [-1.0, 0.0, 0.0]}
        values.append(solved({
            "scene": {"dimension": 3}, "geometry": {"shape": "file", "path": str(path)},
            "film": {"viscosity": "0.1 Pa*s"}, "motion": moves, "load": {"approach": "-5 um"},
        }).values)
    assert values[0]["pressure_max"] > 1e3
    for key in ("pressure_max", "pressure_min"):
        assert values[1][key] == pytest.approx(values[0][key], rel=1e-9), key
    assert values[0]["pressure_min"] == pytest.approx(-values[0]["pressure_max"], rel=1e-3)


def test_an_oblique_motion_is_the_sum_of_its_components(tmp_path: Path) -> None:
    """Reynolds' equation of a rigid film is linear in the velocity."""
    path = solid_file(tmp_path / "cap.msh", (8, 1, 10), cap(R, D, 0.04, 5e-3))
    pressures = []
    for direction, speed in (([1.0, 0.0, 0.0], 0.3), ([0.0, 0.0, 1.0], 0.4),
                             ([0.6, 0.0, 0.8], 0.5)):
        of = solved({
            "scene": {"dimension": 3}, "geometry": {"shape": "file", "path": str(path)},
            "film": {"viscosity": "0.1 Pa*s"}, "load": {"approach": "-5 um"},
            "motion": {"kind": "sliding", "speed": f"{speed} m/s", "direction": direction},
        })
        dofs = of.outcome.model.dofs
        pressures.append(dofs.field("p", dofs.to_local(of.outcome.x))[:, 0])
    together = pressures[0] + pressures[1]
    np.testing.assert_allclose(pressures[2], together, atol=1e-9 * np.abs(together).max())
