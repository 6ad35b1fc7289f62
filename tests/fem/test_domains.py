"""Integration domains: sizes, normals and Gauss's theorem on flat and curved meshes."""

import numpy as np
import pytest

from porolub.errors import SolveError
from porolub.fem.domains import Domain, NodalDomain
from tests.fem import meshes

N = 3  # exact for quadratic geometry
each = pytest.mark.parametrize("kind", meshes.ALL)


def facets(mesh, name, n=N):
    return Domain(f"facets:{name}", mesh, n)


def test_measures_of_the_sector():
    R, d, angle = meshes.RADIUS, meshes.THICKNESS, meshes.ANGLE
    exact = {"cells": angle * (R**2 - (R - d) ** 2), "lubricated": 2 * angle * R,
             "bone": 2 * angle * (R - d), "inlet": d, "outlet": d}
    for kind in ("sector", "sector of triangles"):
        errors = []
        for along in (4, 8):
            mesh = meshes.mesh(kind, along)
            found = {name: facets(mesh, name).weights.sum() for name in mesh.boundary_names}
            found["cells"] = Domain("cells", mesh, N).weights.sum()
            assert set(found) == set(exact)
            errors.append([abs(found[k] / exact[k] - 1) for k in ("cells", "lubricated", "bone")])
            assert found["inlet"] == pytest.approx(d, rel=1e-13)
            assert found["outlet"] == pytest.approx(d, rel=1e-13)
        assert np.max(errors[1]) < 1e-5
        # parabolas through three points of an arc
        np.testing.assert_allclose(np.log2(np.divide(*errors)), 4.0, atol=0.1)


@pytest.mark.parametrize(
    ("kind", "volume", "top"),
    [("block", 3.0, 3.0), ("block of triangles", 3.0, 3.0), ("cuboid", 6.0, 6.0),
     ("box of tets", 6.0, 6.0)],
)
def test_measures_of_flat_shapes(kind, volume, top):
    mesh = meshes.mesh(kind)
    assert Domain("cells", mesh, N).weights.sum() == pytest.approx(volume, rel=1e-13)
    assert facets(mesh, "top").weights.sum() == pytest.approx(top, rel=1e-13)


@each
def test_gauss(kind):
    """int div f = int f . n to rounding, for f = x and for constants: the surface is closed."""
    mesh = meshes.mesh(kind)
    volume = Domain("cells", mesh, N).weights.sum()
    flux, area = 0.0, np.zeros(mesh.dim)
    for name in mesh.boundary_names:
        d = facets(mesh, name)
        flux += np.einsum("eq,eqd,eqd->", d.weights, d.position, d.normal)
        area += np.einsum("eq,eqd->d", d.weights, d.normal)
    assert flux == pytest.approx(mesh.dim * volume, rel=1e-12)
    np.testing.assert_allclose(area, 0.0, atol=1e-12)


@each
def test_normals_are_unit_vectors(kind):
    mesh = meshes.mesh(kind)
    for name in mesh.boundary_names:
        size = np.linalg.norm(facets(mesh, name).normal, axis=-1)
        np.testing.assert_allclose(size, 1.0, rtol=1e-13)
    assert not Domain("cells", mesh, 1).normal.any()


@pytest.mark.parametrize("kind", ["sector", "sector of triangles"])
def test_normals_of_the_arcs_are_radial(kind):
    mesh = meshes.mesh(kind, 16)
    for name, side in (("lubricated", 1.0), ("bone", -1.0)):
        d = facets(mesh, name)
        radial = d.position - [0.0, meshes.RADIUS]
        radial *= side / np.linalg.norm(radial, axis=-1, keepdims=True)
        np.testing.assert_allclose(d.normal, radial, atol=1e-4)


@pytest.mark.parametrize(
    ("kind", "expected"),
    [("block", {"top": (0, 1), "left": (-1, 0)}),
     ("block of triangles", {"top": (0, 1), "bottom": (0, -1)}),
     ("cuboid", {"top": (0, 1, 0), "right": (1, 0, 0), "front": (0, 0, -1), "back": (0, 0, 1)}),
     ("box of tets", {"top": (0, 1, 0), "left": (-1, 0, 0)})],
)
def test_normals_of_flat_shapes(kind, expected):
    for name, normal in expected.items():
        found = facets(meshes.mesh(kind), name).normal
        np.testing.assert_allclose(found, np.broadcast_to(normal, found.shape), atol=1e-13)


@each
def test_inverse_is_the_derivative_of_the_reference_position(kind):
    """A linear function has its gradient, whatever the cell."""
    mesh = meshes.mesh(kind)
    slope = np.array([0.7, -0.4, 1.3])[: mesh.dim]
    for name in ("cells", f"facets:{mesh.boundary_names[0]}"):
        d = Domain(name, mesh, N)
        at_nodes = (mesh.coordinates @ slope)[mesh.cells[d.cells]]
        table = d.tables(2).gradient[d.variant]
        found = np.einsum("eqrd,eqri,ei->eqd", d.inverse, table, at_nodes)
        np.testing.assert_allclose(found, np.broadcast_to(slope, found.shape), atol=1e-12)


@pytest.mark.parametrize(("kind", "counts"), [("block", (4, 3)), ("cuboid", (4, 3, 2))])
def test_length_of_an_element_along_a_direction(kind, counts):
    d = Domain("cells", meshes.mesh(kind), 2)
    sides = [3.0, 1.0, 2.0][: len(counts)]
    for axis, (side, count) in enumerate(zip(sides, counts, strict=True)):
        along = np.broadcast_to(np.eye(d.dim)[axis], d.position.shape)
        np.testing.assert_allclose(d.length_along(along), side / count, rtol=1e-13)
        np.testing.assert_allclose(d.length_along(-along[1:3], slice(1, 3)), side / count)
    np.testing.assert_array_equal(d.length_along(np.zeros_like(d.position)), 0.0)


def test_length_of_a_triangle_is_of_the_size_of_its_sides():
    d = Domain("cells", meshes.mesh("block of triangles"), 2)
    along = np.broadcast_to([1.0, 0.0], d.position.shape)
    length = d.length_along(along)
    assert 0.5 * 0.75 <= length.min() <= length.max() <= 1.0 * 0.75 + 1e-12


@pytest.mark.parametrize("kind", ["block", "block of triangles"])
def test_a_cell_turned_inside_out_is_refused_with_its_place(kind):
    mesh = meshes.mesh(kind)
    vertices = mesh.coordinates[: mesh.nvertices].copy()
    inner = np.flatnonzero(np.all(np.isclose(vertices, [0.0, 1 / 3], atol=1e-9), axis=1))
    assert len(inner) == 1
    vertices[inner] += [2.0, 0.0]
    with pytest.raises(SolveError, match=r"inverted or degenerate element near \(.*, 0\.\d+\)"):
        Domain("cells", meshes.moved(mesh, vertices), N)


def test_unknown_domains_are_refused():
    with pytest.raises(ValueError, match="no such integration domain: 'edges:top'"):
        Domain("edges:top", meshes.mesh("block"), 2)
    with pytest.raises(KeyError):
        Domain("facets:ceiling", meshes.mesh("block"), 2)


def test_nodes_as_a_domain():
    mesh = meshes.mesh("cuboid")
    nodes = mesh.boundary_nodes("top")
    weights = np.linspace(1.0, 2.0, len(nodes))
    normal = np.broadcast_to([0.0, 1.0, 0.0], (len(nodes), 3))
    d = NodalDomain("nodes:top", mesh, nodes, weights, normal)
    assert len(d) == len(nodes) == 9 * 5
    np.testing.assert_array_equal(d.position[:, 0], mesh.coordinates[nodes])
    np.testing.assert_array_equal(d.weights[:, 0], weights)
    np.testing.assert_array_equal(d.normal[:, 0], normal)
    np.testing.assert_array_equal(d.tables(2).value, 1.0)
