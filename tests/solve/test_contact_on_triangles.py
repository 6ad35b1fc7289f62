"""Contact on faces of tetrahedra: even pressure, and agreement with hexahedra on a curved layer."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from porolub.fem.dofs import nodal_points
from porolub.fem.domains import Domain, nodal_shares
from porolub.mesh import build_mesh
from porolub.scene import Scene
from porolub.scene.read import scene_from_dict
from porolub.solve.derived import scalars
from porolub.solve.steady import Outcome, SteadySolver
from tests.mesh.scenes import barrel_file, box_file, scene

SIDES = {"top": "lubricated", "bottom": "bone", "left": "inlet", "right": "outlet"}
DRY: dict[str, Any] = {
    "scene": {"title": "dry", "dimension": 3},
    "solid": {"law": "neo-hookean", "shear_modulus": "0.5 MPa", "bulk_modulus": "5 MPa"},
    "contact": {"friction": 0.45},
}


def dry(path: Path, approach: str, **geometry: Any) -> Scene:
    """A dry layer on a mesh file, pressed in by that much."""
    geometry = {"shape": "file", "path": str(path), **geometry}
    return scene_from_dict({**DRY, "geometry": geometry, "load": {"approach": approach}})


def solved(what: Scene) -> Outcome:
    outcome = SteadySolver(what, MPI.COMM_SELF).solve()
    assert outcome.converged, outcome.message
    return outcome


@pytest.mark.parametrize("hexahedra", [False, True])
def test_a_flat_block_pressed_evenly_has_one_pressure(tmp_path: Path, hexahedra: bool) -> None:
    path = box_file(tmp_path / "box.msh", order=2, hexahedra=hexahedra, names=SIDES)
    outcome = solved(dry(path, "20 um", plane_normal=[0, 1, 0]))
    model, dofs = outcome.model, outcome.model.dofs
    pressure = dofs.field("l", dofs.to_local(outcome.x))
    corners = dofs.nodes["l"] < model.mesh.nvertices
    assert corners.any() == hexahedra
    assert np.ptp(pressure) < 1e-10 * pressure.max()
    # uniaxial stretch 1 - 0.02: G J^(-5/3) 2/3 (J^2 - 1) + K (J - 1), J = 0.98, in Pa
    J = 0.98
    expected = -(0.5e6 * J ** (-5 / 3) * 2 / 3 * (J**2 - 1) + 5e6 * (J - 1))
    found = scalars(model, outcome.x)
    assert found["load_solid"] == pytest.approx(expected * 6e-6, rel=1e-9)
    assert found["contact_pressure_max"] == pytest.approx(expected, rel=1e-9)


def test_tetrahedra_and_hexahedra_of_a_curved_layer_agree(tmp_path: Path) -> None:
    found = {}
    for hexahedra in (False, True):
        path = barrel_file(tmp_path / "barrel.msh", hexahedra=hexahedra, counts=(24, 3, 3))
        outcome = solved(dry(path, "50 um"))
        found[hexahedra] = scalars(outcome.model, outcome.x)
    for key, tolerance in (
        ("load_solid", 5e-3),
        ("contact_pressure_max", 0.01),
        ("contact_area", 0.1),  # nodes that touch: half an element at either end
        ("contact_length", 0.1),
    ):
        assert found[False][key] == pytest.approx(found[True][key], rel=tolerance), key


@pytest.mark.parametrize("kind", ["box", "barrel"])
def test_nodal_weights_are_positive_and_add_up_to_the_area(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "mesh.msh"
    if kind == "box":
        box_file(path, order=2, hexahedra=False, names=SIDES)
    else:
        barrel_file(path, hexahedra=False)
    mesh = build_mesh(scene("file", 3, path=path), MPI.COMM_SELF, length_scale=1e-3)
    domain = Domain("facets:lubricated", mesh, 4)
    weights = np.zeros(len(mesh.coordinates))
    np.add.at(weights, mesh.cells[domain.cells], nodal_shares(domain))
    points = nodal_points(mesh, "lubricated")
    assert (points >= mesh.nvertices).all()
    np.testing.assert_array_equal(np.flatnonzero(weights), points)
    assert (weights[points] > 0).all()
    assert weights.sum() == pytest.approx(domain.weights.sum(), rel=1e-12)
    x, z = mesh.coordinates[:, 0], mesh.coordinates[:, 2]
    at = domain.position
    for power in range(3):  # exact to degree 2 on flat triangles, nearly so on curved ones
        exact = (domain.weights * (at[..., 0] ** power + at[..., 2] ** power)).sum()
        bound = 1e-12 if kind == "box" else 1e-4
        assert weights @ (x**power + z**power) == pytest.approx(exact, rel=bound), power
