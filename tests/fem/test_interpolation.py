"""What a field of nodal values is between the nodes, on distorted and curved cells."""

import numpy as np
import pytest

from porolub.fem.dofs import Dofs, Field
from porolub.fem.domains import Domain
from porolub.fem.points import Points
from tests.fem import meshes

SLOPE = np.array([0.7, -0.4, 1.3])
BEND = np.array([[0.5, 0.2, -0.3], [0.2, -0.8, 0.4], [-0.3, 0.4, 0.6]])


def quadratic(x):
    """A polynomial of total degree 2 and its gradient."""
    slope, bend = SLOPE[: x.shape[-1]], BEND[: x.shape[-1], : x.shape[-1]]
    value = 1.1 + x @ slope + np.einsum("...i,ij,...j->...", x, bend, x)
    return value, slope + 2 * x @ bend


def linear(x):
    slope = SLOPE[: x.shape[-1]]
    return 1.1 + x @ slope, np.broadcast_to(slope, x.shape)


def points(mesh, degree, function, name="cells"):
    """A scalar f and a vector (f, 2 f, ...) interpolated at the nodes, seen at the points."""
    dofs = Dofs(mesh, [Field("p", 1, degree), Field("u", mesh.dim, degree)])
    local = np.zeros(dofs.size_local)
    values = function(mesh.coordinates[dofs.nodes["p"]])[0]
    factors = np.arange(1, mesh.dim + 1)
    dofs.field("p", local)[:, 0] = values
    dofs.field("u", local)[...] = values[:, None] * factors
    domain = Domain(name, mesh, 3)
    at = Points(domain, dofs, local, slice(0, len(domain)), True)
    value, gradient = function(domain.position)
    np.testing.assert_allclose(at.value("p"), value, atol=1e-12)
    np.testing.assert_allclose(at.grad("p"), gradient, atol=1e-11)
    np.testing.assert_allclose(at.value("u"), value[..., None] * factors, atol=1e-12)
    np.testing.assert_allclose(at.grad("u"), factors[:, None] * gradient[..., None, :], atol=1e-11)


@pytest.mark.parametrize("kind", ["block of triangles", "box of tets"])
def test_quadratics_on_distorted_simplices(kind):
    mesh = meshes.distorted(meshes.mesh(kind), 0.02)
    for name in ("cells", "facets:top", "facets:left"):
        points(mesh, 2, quadratic, name)


@pytest.mark.parametrize("kind", meshes.FLAT)
def test_quadratics_on_parallel_cells(kind):
    for name in ("cells", "facets:top", "facets:left"):
        points(meshes.mesh(kind), 2, quadratic, name)


def test_quadratics_on_distorted_quads():
    """The map is bilinear, so biquadratics of the reference hold all quadratics of x."""
    points(meshes.distorted(meshes.mesh("block")), 2, quadratic)


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize("kind", [*meshes.FLAT, "box of tets"])
def test_linears_on_distorted_cells(kind, degree):
    for name in ("cells", "facets:bottom"):
        points(meshes.distorted(meshes.mesh(kind), 0.05), degree, linear, name)


@pytest.mark.parametrize("kind", meshes.CURVED)
def test_linears_on_curved_cells(kind):
    for name in ("cells", "facets:lubricated", "facets:outlet"):
        points(meshes.mesh(kind), 2, linear, name)


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize("kind", meshes.CURVED)
def test_order_of_interpolation_on_curved_cells(kind, degree):
    """|f - I f| of order degree + 1 in L2, its gradient of order degree."""
    errors = []
    for refined in (1, 2):
        mesh = meshes.mesh(kind, 6 * refined, 3 * refined, 3 * refined)
        dofs = Dofs(mesh, [Field("p", 1, degree)])
        domain = Domain("cells", mesh, 3)
        x, at_nodes = domain.position, mesh.coordinates[dofs.nodes["p"]]
        at = Points(domain, dofs, np.sin(at_nodes @ SLOPE[: mesh.dim]), slice(0, len(domain)), True)
        angle = x @ SLOPE[: mesh.dim]
        value = at.value("p") - np.sin(angle)
        gradient = at.grad("p") - np.cos(angle)[..., None] * SLOPE[: mesh.dim]
        errors.append([np.sqrt((domain.weights * value**2).sum()),
                       np.sqrt((domain.weights[..., None] * gradient**2).sum())])
    orders = np.log2(np.divide(*errors))
    np.testing.assert_allclose(orders, [degree + 1, degree], atol=0.25)
