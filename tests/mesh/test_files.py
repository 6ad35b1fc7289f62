"""Meshes from files: cell kinds, orders, curved sides, names."""

import meshio
import numpy as np
import pytest
from mpi4py import MPI

from porolub.errors import SceneError
from porolub.mesh import build_mesh
from tests.mesh import geometry
from tests.mesh.scenes import ANGLE, ARC, RADIUS, THICKNESS, box_file, scene, sector_file

MM = 1e-3
R0 = RADIUS / MM
AREA = ANGLE * (RADIUS**2 - (RADIUS - THICKNESS) ** 2) / MM**2


def build(path, dimension=2, **options):
    what = scene("file", dimension, path=path)
    for key in ("boundary",):
        if key in options:
            setattr(what, key, options.pop(key))
    return build_mesh(what, MPI.COMM_SELF, length_scale=MM, **options)


@pytest.mark.parametrize("version", [2.2, 4.1])
@pytest.mark.parametrize("quads", [False, True])
def test_first_order_file_has_straight_sides(tmp_path, quads, version):
    mesh = build(sector_file(tmp_path / "a.msh", quads=quads, version=version))
    assert mesh.cell_type == ("quad" if quads else "triangle")
    assert set(mesh.boundary_names) == set(ARC.values())
    assert (geometry.polygon_areas(mesh) > 0).all()
    assert geometry.polygon_areas(mesh).sum() == pytest.approx(AREA, rel=2e-3)
    assert geometry.straight_defect(mesh) < 1e-14
    total = sum(geometry.outward(mesh, name) for name in mesh.boundary_names)
    np.testing.assert_allclose(total, 0.0, atol=1e-12)
    vertices = mesh.boundary_nodes("lubricated")
    vertices = vertices[vertices < mesh.nvertices]
    x = mesh.coordinates[vertices]
    np.testing.assert_allclose(np.hypot(x[:, 0], R0 - x[:, 1]), R0, rtol=1e-12)


@pytest.mark.parametrize("incomplete", [False, True])
@pytest.mark.parametrize("quads", [False, True])
def test_second_order_file_keeps_its_curved_sides(tmp_path, quads, incomplete):
    path = sector_file(tmp_path / "a.msh", order=2, quads=quads, incomplete=incomplete)
    mesh = build(path)
    assert geometry.curved_area(mesh) == pytest.approx(AREA, rel=1e-6)
    x = mesh.coordinates[mesh.boundary_nodes("lubricated")]
    np.testing.assert_allclose(np.hypot(x[:, 0], R0 - x[:, 1]), R0, rtol=1e-7)
    # nodes inside stay near the middles: nothing has been swapped
    assert geometry.straight_defect(mesh) < 0.02
    assert build(path, degree=1).cells.shape[1] == mesh.cell.vertices


@pytest.mark.parametrize("hexahedra", [False, True])
@pytest.mark.parametrize("order", [1, 2])
def test_three_dimensional_file(tmp_path, order, hexahedra):
    path = box_file(tmp_path / "a.msh", order=order, hexahedra=hexahedra)
    mesh = build(path, 3, boundary={"top": None})
    assert mesh.cell_type == ("hex" if hexahedra else "tet")
    assert (geometry.volumes(mesh) > 0).all()
    assert geometry.volumes(mesh).sum() == pytest.approx(6.0)
    assert geometry.straight_defect(mesh) < 1e-9
    np.testing.assert_allclose(geometry.outward(mesh, "top"), [0, 6, 0], atol=1e-9)
    np.testing.assert_allclose(geometry.outward(mesh, "left"), [-3, 0, 0], atol=1e-9)
    x = mesh.coordinates
    nodes = np.flatnonzero(np.abs(x[:, 1] - 1.0) < 1e-9)
    np.testing.assert_array_equal(mesh.boundary_nodes("top"), nodes)


def test_a_mesh_bent_in_3d_keeps_its_faces_and_centres(tmp_path):
    path = box_file(tmp_path / "a.msh", order=2, hexahedra=True)
    file = meshio.read(path)
    file.points += 0.1 * file.points[:, [2, 0, 1]] ** 2 / 1e-3  # a quadratic map
    bent = tmp_path / "bent.msh"
    file.write(bent, file_format="gmsh")
    mesh = build(bent, 3, boundary={"top": None})
    straight = build(path, 3, boundary={"top": None})
    expected = straight.coordinates + 0.1 * straight.coordinates[:, [2, 0, 1]] ** 2
    np.testing.assert_allclose(mesh.coordinates, expected, atol=1e-9)


def test_named_sets_of_another_format(tmp_path):
    file = meshio.read(sector_file(tmp_path / "a.msh"))
    sets = {
        name: [np.flatnonzero(t == tag) for t in file.cell_data["gmsh:physical"]]
        for name, (tag, dim) in file.field_data.items()
        if dim == 1
    }
    path = tmp_path / "a.inp"
    meshio.Mesh(file.points, file.cells, cell_sets=sets).write(path)
    other, mesh = build(path), build(tmp_path / "a.msh")
    for name in ARC.values():
        assert len(other.facets(name).cells) == len(mesh.facets(name).cells)


def test_missing_boundary_is_named_with_those_found(tmp_path):
    path = sector_file(tmp_path / "a.msh", names={**ARC, 4: "inlt"})
    with pytest.raises(SceneError) as caught:
        build(path)
    message = str(caught.value)
    assert "no boundary named 'inlet'" in message
    assert "named in the file: bone, inlt, lubricated, outlet" in message
    with pytest.raises(SceneError, match="no boundary named 'wall'"):
        build(path, boundary={"wall": None})
    assert build(path, boundary={"inlt": None}).boundary_names


def test_no_names_at_all(tmp_path):
    file = meshio.read(sector_file(tmp_path / "a.msh"))
    path = tmp_path / "a.vtk"
    meshio.Mesh(file.points, file.cells).write(path)
    with pytest.raises(SceneError, match="named in the file: none"):
        build(path)


def test_unreadable_and_unfit_files_are_refused(tmp_path, capfd):
    broken = tmp_path / "a.msh"
    broken.write_text("no mesh\n")
    with pytest.raises(SceneError, match="cannot be read as a mesh: no reader"):
        build(broken)
    with pytest.raises(SceneError, match="cannot be read as a mesh: Could not deduce"):
        build(broken.rename(tmp_path / "a.xyz"))
    assert capfd.readouterr() == ("", "")
    with pytest.raises(SceneError, match="must hold one kind of 3D cells"):
        build(sector_file(tmp_path / "b.msh"), 3)
    with pytest.raises(SceneError, match="must hold one kind of 2D cells"):
        build(box_file(tmp_path / "c.msh", order=1, hexahedra=False), 2)


def test_boundaries_must_lie_outside_and_not_share_facets(tmp_path):
    points = np.array([[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]) * MM
    cells = [("quad", [[0, 1, 4, 3], [1, 2, 5, 4]]), ("line", [[1, 4], [0, 1], [1, 2]])]

    def write(name, sets):
        rows = {key: [np.array([], int), np.array(lines)] for key, lines in sets.items()}
        path = tmp_path / name
        meshio.Mesh(points, cells, cell_sets=rows).write(path)
        return path

    wall = {"wall": None}
    with pytest.raises(SceneError, match=r"'wall' of the mesh has 1 of 2 facets that are not"):
        build(write("a.inp", {"wall": [0, 1]}), boundary=wall)
    with pytest.raises(SceneError, match=r"'wall' and 'floor' of the mesh share facets"):
        build(write("b.inp", {"wall": [1], "floor": [1, 2]}), boundary=wall)
    assert len(build(write("c.inp", {"wall": [1, 2]}), boundary=wall).facets("wall").cells) == 2
