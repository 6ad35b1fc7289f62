"""The unknowns that are announced are those a mesh of these elements has."""

import itertools
from pathlib import Path
from typing import Any

import gmsh
import pytest

from porolub.errors import SceneError
from porolub.scene import estimate_unknowns, scene_from_dict
from porolub.scene.geometry import MeshFile
from tests.scene.scenes import CUBE, ROLLING, changed


def lattice(cells: tuple[int, ...], degree: int) -> int:
    """Count distinct nodes by placing those of every element."""
    nodes = set()
    for corner in itertools.product(*(range(n) for n in cells)):
        for step in itertools.product(range(degree + 1), repeat=len(cells)):
            nodes.add(tuple(degree * c + s for c, s in zip(corner, step, strict=True)))
    return len(nodes)


@pytest.mark.parametrize(("degree", "pressure_degree"), [(1, 1), (2, 1), (2, 2)])
def test_structured_plane_meshes(degree: int, pressure_degree: int) -> None:
    mesh = {"along": 7, "across": 3, "degree": degree, "pressure_degree": pressure_degree}
    count = estimate_unknowns(scene_from_dict(changed(ROLLING, mesh=mesh)))
    assert count["displacement"] == 2 * lattice((7, 3), degree)
    assert count["pore_pressure"] == lattice((7, 3), pressure_degree)
    assert count["volume_change"] == lattice((7, 3), pressure_degree)
    assert count["contact_pressure"] == lattice((7,), degree)
    assert count["approach"] == 1
    assert count["total"] == sum(v for k, v in count.items() if k != "total")


def test_structured_solid_meshes() -> None:
    count = estimate_unknowns(scene_from_dict(CUBE))
    assert count["displacement"] == 3 * lattice((4, 2, 3), 2)
    assert count["contact_pressure"] == lattice((4, 3), 2)
    assert set(count) == {"displacement", "contact_pressure", "approach", "total"}


def test_the_paper_s_mesh() -> None:
    assert estimate_unknowns(scene_from_dict(ROLLING)) == {
        "displacement": 2 * 601 * 61,
        "pore_pressure": 301 * 31,
        "volume_change": 301 * 31,
        "contact_pressure": 601,
        "approach": 1,
        "total": 73322 + 2 * 9331 + 601 + 1,
    }


def test_without_pores_the_film_pressure_sits_on_the_surface() -> None:
    count = estimate_unknowns(scene_from_dict(changed(ROLLING, pores=None)))
    assert count["film_pressure"] == 301
    rigid = changed(ROLLING, pores=None, solid=None, contact=None, load={"force": None})
    rigid["load"] = {"approach": "-1 um"}
    assert estimate_unknowns(scene_from_dict(rigid)) == {"film_pressure": 301, "total": 301}


def write_mesh(path: Path, dimension: int, cells: str) -> dict[int, tuple[int, int]]:
    """Mesh a rectangle or a box; return gmsh's node counts of layer and top by degree."""
    gmsh.initialize(interruptible=False, readConfigFiles=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.4)
        if dimension == 2:
            layer = gmsh.model.occ.addRectangle(0, 0, 0, 2, 1)
        else:
            layer = gmsh.model.occ.addBox(0, 0, 0, 2, 1, 1)
        gmsh.model.occ.synchronize()
        top = next(
            tag
            for _, tag in gmsh.model.getEntities(dimension - 1)
            if abs(gmsh.model.occ.getCenterOfMass(dimension - 1, tag)[1] - 1) < 1e-9
        )
        gmsh.model.addPhysicalGroup(dimension, [layer], name="layer")
        gmsh.model.addPhysicalGroup(dimension - 1, [top], name="lubricated")
        if cells == "quad":
            gmsh.model.mesh.setRecombine(2, layer)
            gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 2)
        if cells == "hex":
            gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 2)
        gmsh.model.mesh.generate(dimension)
        counts = {}
        for degree in (1, 2):
            gmsh.model.mesh.setOrder(degree)
            all_nodes, top_nodes = (
                len(gmsh.model.mesh.getNodes(d, t, includeBoundary=True)[0])
                for d, t in ((dimension, layer), (dimension - 1, top))
            )
            counts[degree] = (all_nodes, top_nodes)
        gmsh.model.mesh.setOrder(1)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return counts


@pytest.mark.parametrize(
    ("dimension", "cells"), [(2, "triangle"), (2, "quad"), (3, "tet"), (3, "hex")]
)
def test_a_mesh_file_has_the_nodes_gmsh_counts(tmp_path: Path, dimension: int, cells: str) -> None:
    counts = write_mesh(tmp_path / "layer.msh", dimension, cells)
    tables = changed(
        ROLLING,
        scene={"dimension": dimension},
        load={"force": "1 N" if dimension == 3 else "1 N/m"},
    ) | {"geometry": {"shape": "file", "path": "layer.msh"}, "mesh": {}}
    count = estimate_unknowns(scene_from_dict(tables, base_dir=tmp_path))
    assert count["displacement"] == dimension * counts[2][0]
    assert count["pore_pressure"] == counts[1][0]
    assert count["contact_pressure"] == counts[2][1]


def file_scene(**changes: Any) -> dict[str, Any]:
    tables = ROLLING | {"geometry": {"shape": "file", "path": "layer.msh"}, "mesh": {}}
    return changed(tables, **changes)


def test_a_file_that_is_no_mesh_is_refused(tmp_path: Path) -> None:
    (tmp_path / "layer.msh").write_text("no mesh")
    with pytest.raises(SceneError, match=r"geometry\.path.*cannot read"):
        estimate_unknowns(scene_from_dict(file_scene(), base_dir=tmp_path))


def test_a_mesh_of_the_wrong_dimension_is_refused(tmp_path: Path) -> None:
    write_mesh(tmp_path / "layer.msh", 2, "quad")
    tables = file_scene(scene={"dimension": 3}, load={"force": "1 N"})
    with pytest.raises(SceneError, match="no elements of dimension 3"):
        estimate_unknowns(scene_from_dict(tables, base_dir=tmp_path))


@pytest.mark.parametrize(
    ("changes", "part"),
    [
        ({"geometry": {"path": "other.msh"}}, 'geometry.path = "other.msh": there is no such'),
        ({"mesh": {"along": 3}}, "mesh.along is given"),
        ({"mesh": {"grading": "contact"}}, "needs a built shape"),
        ({"mesh": {"element": "triangle"}}, "mesh.element is given"),
        ({"geometry": {"plane_normal": [0, 1, 0]}}, "must have 2 components"),
        ({"geometry": {"plane_normal": [0, 0]}}, "a direction is needed"),
        ({"geometry": {"plane_normal": "up"}}, "a direction is needed"),
    ],
)
def test_what_a_mesh_file_cannot_take_is_refused(
    tmp_path: Path, changes: dict[str, Any], part: str
) -> None:
    (tmp_path / "layer.msh").write_text("a mesh")
    with pytest.raises(SceneError) as caught:
        scene_from_dict(file_scene(**changes), base_dir=tmp_path)
    assert part in str(caught.value)


def test_a_mesh_file_may_say_where_the_plane_is(tmp_path: Path) -> None:
    (tmp_path / "layer.msh").write_text("a mesh")
    tables = file_scene(geometry={"plane_normal": [0, 1]})
    geometry = scene_from_dict(tables, base_dir=tmp_path).geometry
    assert isinstance(geometry, MeshFile)
    assert geometry.plane_normal == (0.0, 1.0)
