"""Terms of the lubricated surface alone, where theory knows the residual."""

import numpy as np
import pytest

from porolub.fem.domains import Domain
from porolub.terms.contact import Contact
from porolub.terms.drainage import Drainage
from porolub.terms.film import Film
from porolub.terms.load import LoadBalance
from porolub.terms.plane import Plane
from porolub.terms.pores import Pores
from porolub.terms.squeeze import Squeeze
from porolub.terms.surface_pressure import SurfacePressure
from porolub.terms.traction import Traction
from tests.fem import meshes
from tests.terms.cases import BIOT, LUBRICANT, MOBILITY, setting
from tests.terms.support import affine, everywhere, field_values, smooth, system

TINY = 1e-12
each = pytest.mark.parametrize("kind", meshes.ALL)


@pytest.mark.parametrize("kind", ["block", "block of triangles", "cuboid", "box of tets"])
@pytest.mark.parametrize("spatial", [True, False])
def test_surface_pressure_follows_the_surface(kind, spatial):
    """All forces together are share * p * (cof F N or N) * area; what pushes is compression."""
    mesh, share = meshes.mesh(kind), 0.9
    of = system(mesh, [SurfacePressure(share, spatial, "top")], ["u", "p"])
    local, A = affine(of)
    F = np.eye(mesh.dim) + A
    N = np.eye(mesh.dim)[1]
    BN = np.linalg.det(F) * np.linalg.inv(F).T @ N if spatial else N
    area = of.domains["facets:top"].weights.sum()
    found = of.dofs.field("u", of.local_residual(local)).sum(axis=0)
    np.testing.assert_allclose(found, share * 0.2 * area * BN, atol=TINY)


@each
def test_total_traction_is_zero_where_pressure_acts_from_both_sides(kind):
    """Pores and surface pressure of share a, all round: uniform pressure loads no node."""
    mesh = meshes.mesh(kind)
    terms = [Pores(BIOT, MOBILITY, True, 1)]
    terms += [SurfacePressure(BIOT, True, name) for name in mesh.boundary_names]
    of = system(mesh, terms, ["u"], points=5)
    local, _ = affine(of)
    parts = of.local_residual(local, only={"pores"})
    assert np.abs(parts[of.dofs.range["u"]]).max() > 1e-3
    whole = of.dofs.field("u", of.local_residual(local))
    np.testing.assert_allclose(whole, 0.0, atol=TINY)


@pytest.mark.parametrize("kind", ["sector", "cuboid"])
def test_load_is_the_pressure_on_the_surface_less_the_force(kind):
    mesh, boundary = meshes.mesh(kind), meshes.surface(kind)
    at = setting(mesh, boundary, force=0.8)
    area = Domain(f"facets:{boundary}", mesh, 4).weights.sum()
    of = system(mesh, [LoadBalance(at.operation, boundary, area, True, True)], ["p", "l"],
                boundary=boundary, points=4)
    local = np.zeros(of.dofs.size_local)
    field_values(of.dofs, "p", lambda X: 0.3 + 0 * X[:, 0], local)
    field_values(of.dofs, "l", lambda X: 0.5 + 0 * X[:, 0], local)
    residual = of.local_residual(local)
    assert residual[of.dofs.range["v0"]] == pytest.approx(0.8 * area - 0.8, rel=1e-12)
    assert not residual[: of.dofs.range["v0"].start].any()


@pytest.mark.parametrize("friction", [0.0, 0.45])
@pytest.mark.parametrize("kind", ["sector", "cuboid"])
def test_contact_rows_and_tractions(kind, friction):
    mesh, boundary = meshes.mesh(kind), meshes.surface(kind)
    at = setting(mesh, boundary)
    of = system(mesh, [Contact(at.plane, at.operation, boundary, 1.0, friction, True, 2)],
                ["u", "v0"], boundary=boundary)
    local = smooth(of.dofs)
    nodes = everywhere(of, f"nodes:{boundary}", local)
    gap, weight = at.plane.gap(nodes)[:, 0], nodes.weights[:, 0]
    pressure = nodes.value("l")[:, 0]
    residual = of.local_residual(local)
    lower = np.minimum(pressure, gap)
    assert (lower == pressure).any()
    assert (lower == gap).any()
    np.testing.assert_allclose(of.dofs.field("l", residual)[:, 0], weight * lower, atol=1e-15)
    X, n = nodes.position[:, 0], nodes.normal[:, 0]
    sliding = np.zeros_like(X)  # of the body on the plane, along the surface
    sliding[:, 0], sliding[:, 1] = 0.7 * (meshes.RADIUS - X[:, 1]), 0.7 * X[:, 0]
    sliding -= np.einsum("nd,nd->n", sliding, n)[:, None] * n
    sliding /= np.linalg.norm(sliding, axis=1, keepdims=True)
    traction = -np.asarray(at.plane.toward) - friction * sliding  # per pressure, on the skeleton
    force = of.dofs.field("u", residual)[np.searchsorted(of.dofs.nodes["u"], nodes.domain.cells)]
    np.testing.assert_allclose(force, -(weight * pressure)[:, None] * traction, atol=1e-15)


def test_a_sliding_plane_drags_the_skeleton_along():
    """Friction on a body at rest points where the plane goes; there is none without motion."""
    mesh, total = meshes.mesh("block"), []
    for kind in ("sliding", "rest"):
        at = setting(mesh, "top", kind)
        of = system(mesh, [Contact(at.plane, at.operation, "top", 1.0, 0.45, True, 2)],
                    ["u", "v0"], boundary="top")
        local = np.zeros(of.dofs.size_local)
        field_values(of.dofs, "l", lambda X: np.full(len(X), 0.2), local)
        total.append(-of.dofs.field("u", of.local_residual(local)).sum(axis=0))
    pressed = -0.2 * 3.0 * np.asarray(at.plane.toward)
    np.testing.assert_allclose(total[1], pressed, atol=TINY)
    np.testing.assert_allclose(total[0] - pressed, [0.45 * 0.2 * 3.0, 0.0], atol=TINY)


@pytest.mark.parametrize("kind", ["sector", "cuboid"])
def test_flux_of_the_film_is_what_its_rows_balance(kind):
    """- int flux . grad q, the flux that is reported: Poiseuille against grad p, half the speed."""
    mesh, boundary = meshes.mesh(kind), meshes.surface(kind)
    at = setting(mesh, boundary, "rotation" if boundary == "lubricated" else "sliding")
    film = Film(LUBRICANT, at.plane, at.operation, boundary, True, True, 1, False)
    of = system(mesh, [film], ["u", "p", "v0"], boundary=boundary)
    state = smooth(of.dofs)
    seen = everywhere(of, f"facets:{boundary}", state)
    flux, h = film.flux(seen), np.maximum(at.plane.gap(seen), 0.0)
    np.testing.assert_allclose(np.einsum("eqd,eqd->eq", flux, seen.normal), 0.0, atol=1e-12)
    change = np.random.default_rng(0).standard_normal(of.dofs.size_local)
    slope = everywhere(of, f"facets:{boundary}", change).grad("p")
    expected = -np.einsum("eq,eqd,eqd->", seen.weights, flux, slope)
    found = of.dofs.field("p", change * of.local_residual(state)).sum()
    assert found == pytest.approx(expected, rel=1e-10)
    state[of.dofs.range["p"]] = 0.3  # no slope: Couette flow
    couette = film.flux(everywhere(of, f"facets:{boundary}", state))
    speed = 0.7 * (meshes.RADIUS if boundary == "lubricated" else 1.0)
    np.testing.assert_allclose(np.linalg.norm(couette[..., [0, 1]], axis=-1), h * speed / 2,
                               rtol=1e-3 if boundary == "lubricated" else 1e-12, atol=1e-12)


def test_an_open_surface_leaks_and_a_closed_one_does_not():
    """In proportion to gap and pressure; tested with q = 1, the leak is their integral."""
    mesh = meshes.mesh("sector")
    at = setting(mesh, "lubricated")
    of = system(mesh, [Drainage(1e3, at.plane, "lubricated", True)], ["u", "p", "v0"],
                boundary="lubricated")
    local = smooth(of.dofs)
    for lifted, closed in ((0.0, None), (-10.0, False), (10.0, True)):
        local[of.dofs.range["v0"]] += lifted
        seen = everywhere(of, "facets:lubricated", local)
        gap = at.plane.gap(seen)
        if closed is None:
            assert (gap < 0).any()
            assert (gap > 0).any()
        leak = of.dofs.field("p", of.local_residual(local)).sum()
        expected = 1e3 * (seen.weights * np.maximum(gap, 0.0) * seen.value("p")).sum()
        assert leak == pytest.approx(expected, rel=1e-12)
        local[of.dofs.range["v0"]] -= lifted
        assert (leak == 0.0) == bool(closed)


def flat(kind, tilt=0.0, lifted=0.05):
    """A film under a plane that slides over a flat top, at a gap of `lifted` or more."""
    mesh = meshes.mesh(kind)
    at = setting(mesh, "top", "sliding", approach=-lifted)
    m = np.array([tilt, 1.0, 0.0])[: mesh.dim]
    reach = (mesh.coordinates[mesh.boundary_nodes("top")] @ m).max()
    plane = Plane(tuple(m), float(reach), at.operation)
    return mesh, at.operation, Film(LUBRICANT, plane, at.operation, "top", False, False, 1, True)


@pytest.mark.parametrize("kind", ["block", "block of triangles", "cuboid", "box of tets"])
def test_a_parallel_film_flows_uniformly_under_a_linear_pressure(kind):
    """Couette and Poiseuille flow: all rows zero but those of the rim."""
    mesh, _, film = flat(kind)
    of = system(mesh, [film], boundary="top")
    local = np.zeros(of.dofs.size_local)
    field_values(of.dofs, "p", lambda X: 0.2 + 0.7 * X[:, 0], local)
    found, nodes = of.dofs.field("p", of.local_residual(local))[:, 0], of.dofs.nodes["p"]
    rim = np.zeros(len(nodes), bool)
    for name in mesh.boundary_names:
        if name != "top":
            rim |= np.isin(nodes, mesh.boundary_nodes(name))
    assert (~rim).any()
    assert np.abs(found[~rim]).max() < TINY < 1e-3 < np.abs(found[rim]).max()


def test_a_wedge_pumps_by_half_the_speed_times_the_slope():
    """Uniform pressure: the row of an inner node is int U/2 h' q = U/2 h' * (element length)."""
    mesh, _, film = flat("block", tilt=0.1)
    of = system(mesh, [film], boundary="top")
    local = np.zeros(of.dofs.size_local)
    field_values(of.dofs, "p", lambda X: np.full(len(X), 0.2), local)
    found, nodes = of.dofs.field("p", of.local_residual(local))[:, 0], of.dofs.nodes["p"]
    inner = np.abs(mesh.coordinates[nodes, 0]) < 1.5 - 1e-9
    np.testing.assert_allclose(found[inner], 0.7 / 2 * -0.1 * 0.75, rtol=1e-12)
    assert found.sum() == pytest.approx(0.0, abs=TINY)  # what is pumped comes from the ends


def test_a_closed_film_neither_conducts_nor_pumps():
    mesh, operation, film = flat("block", lifted=-0.01)
    of = system(mesh, [film], boundary="top")
    assert not of.local_residual(smooth(of.dofs)).any()
    operation.approach = -0.05
    assert of.local_residual(smooth(of.dofs)).any()


def test_squeeze_takes_what_the_plane_displaces():
    """The plane comes down by 0.01 in a time of 1/5: less fluid under it, at that rate."""
    mesh = meshes.mesh("cuboid")
    at = setting(mesh, "top")
    plane = Plane((0.0, 1.0, 0.0), 1.0, at.operation)
    of = system(mesh, [Squeeze(plane, "top", True, True)], ["u", "p", "v0"])
    before, now = np.zeros((2, of.dofs.size_local))
    before[-1], now[-1] = -0.05, -0.04  # v0
    of.backward_euler(before, 1 / 5.0)
    total = of.local_residual(now).sum()
    assert total == pytest.approx(-5.0 * 0.01 * 6.0, rel=1e-12)
    before[-1], now[-1] = 0.01, 0.02  # closed before and after
    of.backward_euler(before, 1 / 5.0)
    assert not of.local_residual(now).any()


@pytest.mark.parametrize("kind", ["block", "block of triangles", "cuboid"])
def test_a_given_traction_is_a_dead_load(kind):
    """In total its area times - normal N + vector, compression positive, however the body moves."""
    mesh = meshes.mesh(kind)
    pushed = np.array([0.2, -0.1, 0.4])[: mesh.dim]
    of = system(mesh, [Traction("right", 0.3, tuple(pushed))], ["u"])
    area = of.domains["facets:right"].weights.sum()
    residual = of.local_residual(smooth(of.dofs))
    expected = -area * (pushed - 0.3 * np.eye(mesh.dim)[0])
    np.testing.assert_allclose(of.dofs.field("u", residual).sum(axis=0), expected, atol=TINY)
    np.testing.assert_array_equal(of.local_residual(0 * residual), residual)
