"""Meshes of the shapes: sizes, boundaries, true arcs, node order."""

from types import SimpleNamespace

import numpy as np
import pytest
from mpi4py import MPI

from porolub.errors import SceneError
from porolub.mesh import build_mesh
from tests.mesh import geometry
from tests.mesh.scenes import ANGLE, RADIUS, THICKNESS, scene

MM = 1e-3
R0, R1 = RADIUS / MM, (RADIUS - THICKNESS) / MM
AREA = ANGLE * (R0**2 - R1**2)
ELEMENTS = ["quad", "triangle"]


def build(what, **options):
    return build_mesh(what, MPI.COMM_SELF, length_scale=MM, **options)


@pytest.mark.parametrize("element", ELEMENTS)
def test_sector_has_the_area_and_arcs_of_the_annulus(element):
    mesh = build(scene("sector", element=element))
    # parabolas through points of an arc: relative error of order (angle per element)^4
    assert geometry.curved_area(mesh) == pytest.approx(AREA, rel=1e-6)
    lengths = {name: geometry.facet_lengths(mesh, name).sum() for name in mesh.boundary_names}
    assert lengths["lubricated"] == pytest.approx(2 * ANGLE * R0, rel=1e-8)
    assert lengths["bone"] == pytest.approx(2 * ANGLE * R1, rel=1e-8)
    assert lengths["inlet"] == pytest.approx(R0 - R1)
    assert lengths["outlet"] == pytest.approx(R0 - R1)


@pytest.mark.parametrize("element", ELEMENTS)
def test_arc_nodes_lie_on_the_arcs(element):
    mesh = build(scene("sector", element=element))
    x = mesh.coordinates
    for name, radius in (("lubricated", R0), ("bone", R1)):
        nodes = mesh.boundary_nodes(name)
        assert len(nodes) == 25
        np.testing.assert_allclose(np.hypot(x[nodes, 0], R0 - x[nodes, 1]), radius, rtol=1e-15)
    lowest = x[x[:, 1].argmin()]
    np.testing.assert_allclose(lowest, 0.0, atol=1e-15)
    assert (x[mesh.boundary_nodes("inlet"), 0] < 0).all()
    assert (x[mesh.boundary_nodes("outlet"), 0] > 0).all()


@pytest.mark.parametrize("element", ELEMENTS)
def test_block_sides(element):
    mesh = build(scene("block", element=element))
    x = mesh.coordinates
    assert geometry.polygon_areas(mesh).sum() == pytest.approx(20.0)
    for name, axis, value in (
        *(("left", 0, -10.0), ("right", 0, 10.0), ("bottom", 1, 0.0), ("top", 1, 1.0)),
    ):
        nodes = mesh.boundary_nodes(name)
        np.testing.assert_array_equal(nodes, np.flatnonzero(np.abs(x[:, axis] - value) < 1e-12))
    np.testing.assert_allclose(geometry.outward(mesh, "top"), [0, 20], atol=1e-12)
    np.testing.assert_allclose(geometry.outward(mesh, "left"), [-1, 0], atol=1e-12)


CASES = [
    scene("sector"),
    scene("sector", element="triangle"),
    scene("block"),
    scene("block", element="triangle"),
    scene("block", 3),
    scene("barrel", 3),
    scene("barrel", 3, crown_radius=0.2),
]


@pytest.mark.parametrize("what", CASES)
def test_cells_are_positive_and_middles_lie_between_their_vertices(what):
    mesh = build(what)
    sizes = geometry.polygon_areas(mesh) if mesh.dim == 2 else geometry.volumes(mesh)
    assert (sizes > 0).all()
    logical = mesh.logical(mesh.coordinates)
    in_logical = SimpleNamespace(cell=mesh.cell, cells=mesh.cells, coordinates=logical)
    assert geometry.straight_defect(in_logical) < 1e-12
    assert logical.min() > -1e-12
    assert logical.max() < 1 + 1e-12


@pytest.mark.parametrize("what", CASES)
def test_boundaries_close_the_mesh(what):
    mesh = build(what)
    total = sum(geometry.outward(mesh, name) for name in mesh.boundary_names)
    np.testing.assert_allclose(total, 0.0, atol=1e-10)
    of_faces = mesh.cell.face_nodes(2)
    for name in mesh.boundary_names:
        facets = mesh.facets(name)
        listed = mesh.cells[facets.cells[:, None], of_faces[facets.local_face]]
        np.testing.assert_array_equal(listed, facets.nodes)


@pytest.mark.parametrize("what", CASES)
def test_node_counts_and_degree_one(what):
    fine, coarse = build(what), build(what, degree=1)
    per_axis = [25, 9, 7][: fine.dim]
    assert len(fine.coordinates) == np.prod(per_axis)
    assert len(coarse.coordinates) == np.prod([13, 5, 4][: fine.dim]) == fine.nvertices
    assert [len(ticks) for ticks in fine.ticks()] == per_axis
    assert np.unique(fine.cells).size == len(fine.coordinates)
    np.testing.assert_array_equal(coarse.cells, fine.vertices_of_cells)
    np.testing.assert_array_equal(coarse.coordinates, fine.coordinates[: fine.nvertices])
    np.testing.assert_array_equal(coarse.natural_node, fine.natural_node[: fine.nvertices])


def test_ticks_are_the_logical_positions_of_the_nodes():
    mesh = build(scene("sector"), edges=(-3.0, 4.0), edge_size=0.2, surface_ratio=0.5)
    logical = mesh.logical(mesh.coordinates)
    for axis, ticks in enumerate(mesh.ticks()):
        assert np.abs(logical[:, axis, None] - ticks).min(axis=1).max() < 1e-12
    steps = np.diff(mesh.vertex_ticks[1])
    assert steps[-1] == pytest.approx(steps[0] / 2)
    along = np.diff(mesh.vertex_ticks[0]) * mesh.shape.length
    middle = (mesh.vertex_ticks[0][1:] + mesh.vertex_ticks[0][:-1]) / 2 * mesh.shape.length
    finest = middle[along.argmin()] - mesh.shape.length / 2
    assert min(abs(finest + 3.0), abs(finest - 4.0)) < 1.0


def test_barrel_crown_lowers_the_radius_at_constant_thickness():
    mesh = build(scene("barrel", 3, crown_radius=0.2))
    for name, inward in (("lubricated", 0.0), ("bone", 1.0)):
        x = mesh.coordinates[mesh.boundary_nodes(name)]
        radius = np.hypot(x[:, 0], R0 - x[:, 1])
        np.testing.assert_allclose(radius, R0 - inward - x[:, 2] ** 2 / 400.0, rtol=1e-14)
    assert np.ptp(mesh.coordinates[:, 2]) == pytest.approx(10.0)
    front = mesh.coordinates[mesh.boundary_nodes("front")]
    np.testing.assert_allclose(front[:, 2], -5.0)


def test_block_volume_and_faces_in_3d():
    mesh = build(scene("block", 3))
    assert geometry.volumes(mesh).sum() == pytest.approx(60.0)
    for name, normal in (
        *(("left", (-3, 0, 0)), ("right", (3, 0, 0)), ("bottom", (0, -60, 0))),
        *(("top", (0, 60, 0)), ("front", (0, 0, -20)), ("back", (0, 0, 20))),
    ):
        np.testing.assert_allclose(geometry.outward(mesh, name), normal, atol=1e-11)


def test_arguments_replace_the_scene():
    mesh = build(scene("block"), along=5, across=2, degree=1)
    assert mesh.cells.shape == (10, 4)


def test_shape_that_does_not_fit_the_dimension_is_refused():
    with pytest.raises(SceneError, match="geometry.shape = 'sector' does not exist in 3D"):
        build(scene("sector", 3))
    with pytest.raises(SceneError, match="geometry.depth is needed for shape = 'block' in 3D"):
        build(scene("block", 3, depth=None))
    with pytest.raises(SceneError, match='mesh.element = "triangle" does not fit'):
        build(scene("block", 3, element="triangle"))
