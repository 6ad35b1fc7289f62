"""What `porolub check` expects, against matrices and factors that are really made."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc

from porolub.mesh import build_mesh
from porolub.scene import Scene, scene_from_dict
from porolub.scene.cost import direct_factors, expected_cost
from porolub.scene.stencil import count_nonzeros, mesh_parts
from porolub.solve.model import Model, build_model, scales_of
from tests.mesh.scenes import box_file, sector_file
from tests.scene.scenes import ROLLING, changed

BARREL = changed(
    ROLLING, scene={"dimension": 3}, mesh={"along": 9, "across": 2, "deep": 3},
    geometry={"shape": "barrel", "width": "2 mm"}, load={"force": "1 N"})
PLANE = changed(ROLLING, mesh={"along": 12, "across": 3})
TIME = {"end": "1 s"}
SCENES = {
    "plane": PLANE,
    "equal order": changed(PLANE, mesh={"pressure_degree": 2}),
    "lowest order": changed(PLANE, mesh={"degree": 1}),
    "triangles": changed(PLANE, mesh={"element": "triangle"}),
    "at rest, material": changed(PLANE, pores={"carry": None}, motion=None,
                                 conventions={"frame": "material"}),
    "in time": changed(PLANE, time=TIME, solid={"inertia": True, "density": "1 g/cm^3"}),
    "given approach": changed(PLANE, load={"force": None, "approach": "9 um"}),
    "no film": changed(PLANE, film=None),
    "no contact": changed(PLANE, contact=None),
    "impermeable": changed(PLANE, pores=None),
    "dry": changed(PLANE, pores=None, film=None, motion=None),
    "rigid": changed(PLANE, solid=None, pores=None, contact=None),
    "barrel": BARREL,
    "barrel, lowest order": changed(BARREL, mesh={"degree": 1}),
    "barrel, impermeable": changed(BARREL, pores=None),
}


def model(scene: Scene) -> Model:
    thickness = getattr(scene.geometry, "thickness", 1e-3)
    mesh = build_mesh(scene, MPI.COMM_SELF, length_scale=thickness)
    return build_model(scene, mesh, scales_of(scene, thickness))


def entries(of: Model) -> tuple[int, int]:
    """Entries of the matrix, and those the rows of prescribed values would have had."""
    matrix = of.system.create_matrix()
    count = int(matrix.getInfo()["nz_used"])
    fixed = len(of.system.constraints.fixed)
    matrix.destroy()
    return count, fixed * (count // of.dofs.size) * 2


@pytest.mark.parametrize("name", SCENES)
def test_entries_are_those_of_the_matrix(name: str) -> None:
    """But for the rows of prescribed values, of which the matrix has the diagonal only."""
    scene = scene_from_dict(SCENES[name])
    count, fixed = entries(model(scene))
    assert count <= count_nonzeros(scene) <= count + fixed


def free(tables: dict[str, Any], names: tuple[str, ...]) -> Scene:
    """The layer alone, nothing prescribed."""
    bare = changed(tables, film=None, contact=None, load=None, motion=None, pores={"carry": None})
    return scene_from_dict(changed(bare, boundary={n: {"traction": "1 Pa"} for n in names}))


@pytest.mark.parametrize("cells", ["quad", "triangle", "hexahedron"])
def test_without_prescribed_values_they_are_exact(cells: str) -> None:
    if cells == "hexahedron":
        names: tuple[str, ...] = ("inlet", "outlet", "bone", "front", "back")
        scene = free(BARREL, names)
    else:
        scene = free(changed(PLANE, mesh={"element": cells}), ("inlet", "outlet", "bone"))
    assert count_nonzeros(scene) == entries(model(scene))[0]


@pytest.mark.parametrize("kind", ["triangle", "quad", "tetra", "hexahedron"])
def test_files_are_counted_as_exactly(tmp_path: Path, kind: str) -> None:
    dim = 3 if kind in ("tetra", "hexahedron") else 2
    sides = ("inlet", "outlet", "bone") if dim == 2 else (
        "left", "right", "bottom", "top", "front", "back")
    if dim == 2:
        path = sector_file(tmp_path / "mesh.msh", quads=kind == "quad")
    else:
        path = box_file(tmp_path / "mesh.msh", order=1, hexahedra=kind == "hexahedron")
    tables = changed(PLANE, scene={"dimension": dim}, mesh=None)
    tables["geometry"] = {"shape": "file", "path": str(path)}
    scene = free(tables, sides)
    parts = mesh_parts(scene)
    assert parts.numbers[kind] == parts.elements > 0
    assert count_nonzeros(scene) == entries(model(scene))[0]


@pytest.mark.parametrize(("tables", "within"), [
    (changed(ROLLING, mesh={"along": 60, "across": 10}), 1.25),
    (changed(BARREL, mesh={"along": 24, "across": 3, "deep": 4}), 1.6),
])
def test_factors_are_those_of_the_direct_solver(tables: dict[str, Any], within: float) -> None:
    scene = scene_from_dict(tables)
    of = model(scene)
    matrix, x = of.system.create_matrix(), of.dofs.vector()
    of.dofs.set_scalar("v0", x, 0.02)
    of.system.jacobian(x, matrix)
    pc = PETSc.PC().create(PETSc.COMM_SELF)
    pc.setOptionsPrefix("cost_")
    pc.setOperators(matrix)
    pc.setType("lu")
    pc.setFactorSolverType("mumps")
    pc.setUp()
    found = pc.getFactorMatrix().getMumpsInfog(29), pc.getFactorMatrix().getMumpsRinfog(3)
    for thing in (pc, matrix, x):
        thing.destroy()
    counted = direct_factors(scene)
    for one, other in zip(found, (counted.entries, counted.operations), strict=True):
        assert 1 / within < one / other < within


def test_a_file_costs_about_what_a_block_of_its_elements_costs(tmp_path: Path) -> None:
    path = box_file(tmp_path / "box.msh", order=1, hexahedra=True)
    file = changed(PLANE, scene={"dimension": 3}, mesh=None, film=None, contact=None, load=None,
                   motion=None, pores={"carry": None})
    file["geometry"] = {"shape": "file", "path": str(path)}
    built = changed(file, mesh={"along": 7, "across": 3, "deep": 9})
    built["geometry"] = {"shape": "block", "width": "2 mm", "thickness": "1 mm", "depth": "3 mm"}
    one, other = (scene_from_dict(t) for t in (file, built))
    assert mesh_parts(one) == mesh_parts(other)
    assert expected_cost(one).entries == expected_cost(other).entries
    assert 0.5 < direct_factors(one).entries / direct_factors(other).entries < 2.0


def test_more_ranks_share_the_memory_but_not_the_program() -> None:
    cost = expected_cost(scene_from_dict(changed(BARREL, mesh={"along": 80, "across": 4,
                                                               "deep": 20})))
    for solving in (cost.direct, cost.fieldsplit):
        each = np.array([solving.memory_per_rank(n) for n in (1, 4, 16, 1000)])
        assert (np.diff(each) < 0).all()
        assert each[0] == solving.memory
        assert each[1] > solving.memory / 4
        assert each[-1] > 1e8
