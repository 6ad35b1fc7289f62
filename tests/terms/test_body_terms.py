"""Terms of the body alone, where theory knows the residual: FE-space solutions, patches, totals."""

import numpy as np
import pytest

from porolub.fem.domains import Domain
from porolub.laws.kinematics import Deformation
from porolub.laws.solid import NeoHookean
from porolub.terms.carry import Carry
from porolub.terms.pores import Pores
from porolub.terms.skeleton import Skeleton
from porolub.terms.squeeze import Squeeze
from porolub.terms.storage import Storage
from porolub.terms.streamline import Streamline
from porolub.terms.traction import Traction
from tests.fem import meshes
from tests.terms.cases import BIOT, LINEAR, MOBILITY, NEO, setting
from tests.terms.support import affine, everywhere, field_values, inner_nodes, smooth, system

SLOPE = np.array([0.7, -0.4, 1.3])
TINY = 1e-12
KINDS = meshes.ALL
each = pytest.mark.parametrize("kind", KINDS)
laws = pytest.mark.parametrize("law", [LINEAR, NEO], ids=["linear", "neo-hookean"])


def linear_pressure(X):
    return 0.2 + X @ SLOPE[: X.shape[1]]


def rows(of, name, local):
    """Residual of a field (nodes, components), and which of its nodes are inner ones."""
    residual = of.local_residual(local)
    return (of.dofs.field(name, residual), inner_nodes(of.dofs.mesh)[of.dofs.nodes[name]])


def assert_balanced_inside(of, name, local):
    """Zero at inner nodes but for rounding, while the boundary is loaded."""
    found, inner = rows(of, name, local)
    assert inner.any()
    assert 0.0 < np.abs(found[inner]).max() < TINY < 1e-3 < np.abs(found[~inner]).max()


@each
@laws
def test_an_affine_displacement_is_in_equilibrium(kind, law):
    of = system(meshes.mesh(kind), [Skeleton(law, meshes.mesh(kind).dim, 2)], finite=law.finite)
    assert_balanced_inside(of, "u", affine(of)[0])


@each
@laws
def test_tractions_of_the_stress_hold_an_affine_displacement(kind, law):
    """Patch test: P N on all boundaries balances every node."""
    mesh = meshes.mesh(kind)
    of = system(mesh, [Skeleton(law, mesh.dim, 2)], finite=law.finite, points=4)
    local, A = affine(of)
    P = law.stress(Deformation(A, law.finite))
    total = of.local_residual(local)
    assert np.abs(total).max() > 1e-3
    for name in mesh.boundary_names:
        d = Domain(f"facets:{name}", mesh, 4)
        table = d.tables(2).value[d.variant]
        load = np.einsum("eq,eqi,cd,eqd->eic", d.weights, table, P, d.normal)
        where = of.dofs.entity_dofs("u", d)[:, :, None] + np.arange(mesh.dim)
        np.subtract.at(total, where, load)
    np.testing.assert_allclose(total, 0.0, atol=10 * TINY)


@pytest.mark.parametrize("kind", ["block", "cuboid"])
def test_a_normal_traction_holds_confined_compression(kind):
    """The closed form P(l) as pressure on the top balances the column, side walls aside."""
    mesh, stretch, shear, bulk = meshes.mesh(kind), 0.8, 0.5, 5.0
    closed = (2 * BIOT * shear / 3 * (stretch ** (1 / 3) - stretch ** (-5 / 3))
              + (1 - BIOT) * bulk * (stretch - 1))
    law = NeoHookean(BIOT * shear, (1 - BIOT) * bulk)
    of = system(mesh, [Skeleton(law, mesh.dim, 2), Traction("top", -closed, (0.0,) * mesh.dim)])
    local = np.zeros(of.dofs.size_local)
    field_values(of.dofs, "u", lambda X: (stretch - 1) * X * (np.arange(mesh.dim) == 1), local)
    found = of.dofs.field("u", of.local_residual(local))[:, 1]
    free = mesh.coordinates[:, 1] > 1e-9
    assert np.abs(found[free]).max() < TINY < 1e-2 < np.abs(found[~free]).max()


@each
@pytest.mark.parametrize("spatial", [True, False])
def test_uniform_pressure_pushes_at_the_boundary_only(kind, spatial):
    of = system(meshes.mesh(kind), [Pores(BIOT, MOBILITY, spatial, 1)], ["u"])
    assert_balanced_inside(of, "u", affine(of)[0])


@each
@pytest.mark.parametrize("spatial", [True, False])
def test_a_linear_pressure_is_a_steady_flow(kind, spatial):
    of = system(meshes.mesh(kind), [Pores(BIOT, MOBILITY, spatial, 2)], ["u"], pressure_degree=2)
    assert_balanced_inside(of, "p", affine(of, linear_pressure)[0])


@each
@pytest.mark.parametrize("spatial", [True, False])
def test_a_linear_pressure_is_a_body_force_inside(kind, spatial):
    """- int a p B : grad w = int a (B grad p) . w at inner nodes: the sign of the coupling."""
    mesh = meshes.mesh(kind)
    of = system(mesh, [Pores(BIOT, MOBILITY, spatial, 2)], ["u"], pressure_degree=2)
    local, A = affine(of, linear_pressure)
    F = np.eye(mesh.dim) + A
    B = np.linalg.det(F) * np.linalg.inv(F).T if spatial else np.eye(mesh.dim)
    domain = of.domains["cells"]
    share = np.zeros(len(mesh.coordinates))
    np.add.at(share, mesh.cells, np.einsum("eq,qi->ei", domain.weights, domain.tables(2).value[0]))
    found, inner = rows(of, "u", local)
    expected = BIOT * share[:, None] * (B @ SLOPE[: mesh.dim])
    np.testing.assert_allclose(found[inner], expected[inner], atol=TINY)
    assert np.abs(expected[inner]).max() > 1e-3


@pytest.mark.parametrize("kind", ["sector", "sector of triangles"])
def test_the_carry_of_a_uniform_volume_change_takes_and_leaves_nothing(kind):
    """Constant J: what enters leaves, v is divergence free.  Arcs are tangential but for O(h^4)."""
    mesh = meshes.mesh(kind, 8, 2)
    at = setting(mesh, "lubricated")
    of = system(mesh, [Carry(BIOT, at.operation, at.ends, False)], ["u", "p"])
    local, A = affine(of)
    found, inner = rows(of, "p", local)
    through = BIOT * (np.linalg.det(np.eye(mesh.dim) + A) - 1.0) * 0.7 * meshes.RADIUS
    assert abs(through) > 0.05
    assert 0.0 < np.abs(found[inner]).max() < TINY
    np.testing.assert_allclose(found, 0.0, atol=1e-4 * abs(through))


@each
@pytest.mark.parametrize("fresh", [True, False])
def test_carry_conserves_the_fluid(kind, fresh):
    """All rows together are what passes the ends; fresh material brings no volume change in."""
    mesh = meshes.mesh(kind)
    at = setting(mesh, meshes.surface(kind))
    of = system(mesh, [Carry(BIOT, at.operation, at.ends, fresh)], ["u", "p"])
    local = smooth(of.dofs)
    passed = 0.0
    for end in at.ends:
        side = everywhere(of, f"facets:{end}", local)
        vn = np.einsum("eqd,eqd->eq", at.operation.body_velocity(side.position), side.normal)
        if fresh:
            vn = np.where(vn < 0, 0.0, vn)
        passed += BIOT * (side.weights * (side.deformation.J - 1.0) * vn).sum()
    total = of.dofs.field("p", of.local_residual(local)).sum()
    assert total == pytest.approx(passed, rel=1e-10)
    assert abs(passed) > 1e-5


@each
def test_storage_is_the_change_of_the_fluid_content(kind):
    mesh = meshes.mesh(kind)
    of = system(mesh, [Storage(BIOT, 0.2)], ["u", "p"])
    local, A = affine(of)
    of.backward_euler(np.zeros_like(local), 1 / 5.0)
    volume = of.domains["cells"].weights.sum()
    content = BIOT * (np.linalg.det(np.eye(mesh.dim) + A) - 1.0) + 0.2 * 0.2
    total = of.local_residual(local).sum()
    assert total == pytest.approx(5.0 * content * volume, rel=1e-12)
    of.backward_euler(local, 1 / 5.0)
    np.testing.assert_allclose(of.local_residual(local), 0.0, atol=1e-15)


def test_nothing_is_stored_in_a_steady_solve():
    mesh = meshes.mesh("sector")
    at = setting(mesh, "lubricated")
    terms = [Storage(BIOT, 0.2), Squeeze(at.plane, "lubricated", True, True)]
    of = system(mesh, terms, ["u", "p", "v0"])
    assert not of.local_residual(smooth(of.dofs)).any()


def streamline(kind, along, mobility, change):
    """A system of the stabilisation and its state with a volume change j of the positions."""
    mesh = meshes.mesh(kind, along, 2)
    at = setting(mesh, "lubricated")
    term = Streamline(BIOT, 0.8, mobility, at.operation, 2)
    of = system(mesh, [term], ["u", "p"], pressure_degree=2)
    local = np.zeros(of.dofs.size_local)
    field_values(of.dofs, "j", change, local)
    return of, of.dofs.field("j", local), of.dofs.field("p", of.local_residual(local))


@pytest.mark.parametrize("kind", ["sector", "barrel"])
def test_streamline_diffusion_acts_along_the_stream_only(kind):
    """r^2 varies across the stream: its streamline flux is zero; that of the angle is not."""
    sizes = [np.abs(streamline(kind, 8, 0.05, change)[2]).max() for change in (
        lambda X: X[:, 0] ** 2 + (X[:, 1] - meshes.RADIUS) ** 2,
        lambda X: np.arctan2(X[:, 0], meshes.RADIUS - X[:, 1]))]
    assert sizes[0] < 1e-3 * sizes[1]
    assert sizes[1] > 1e-3


def test_streamline_diffusion_fades_with_refinement():
    sizes = []
    for along in (8, 16, 32):
        _, change, found = streamline("sector", along, 1.0, lambda X: X[:, 0] ** 2)
        sizes.append((change * found).sum())  # int a c_s (s . grad j)^2
    assert min(sizes) > 0.0
    np.testing.assert_allclose(np.log2(np.divide(sizes[:-1], sizes[1:])), 2.0, atol=0.1)


@each
def test_the_stabilised_quantity_is_the_volume_change(kind):
    """J - 1 of an affine displacement satisfies all rows of j; twice as much does not."""
    mesh = meshes.mesh(kind)
    at = setting(mesh, meshes.surface(kind))
    of = system(mesh, [Streamline(BIOT, 0.8, 0.05, at.operation, 1)], ["u", "p"])
    local, A = affine(of)
    change = np.linalg.det(np.eye(mesh.dim) + A) - 1.0
    field_values(of.dofs, "j", lambda X: np.full(len(X), change), local)
    assert 0.0 < np.abs(of.local_residual(local)).max() < TINY
    field_values(of.dofs, "j", lambda X: np.full(len(X), 2 * change), local)
    total = of.dofs.field("j", of.local_residual(local)).sum()
    assert total == pytest.approx(change * of.domains["cells"].weights.sum(), rel=1e-12)


@pytest.mark.parametrize("kind", ["sector", "barrel"])
def test_a_change_of_the_motion_is_noticed(kind):
    """What depends on the motion only is kept; not longer than the motion lasts."""
    mesh = meshes.mesh(kind)
    found = []
    for start in (0.7, -0.2):
        at = setting(mesh, "lubricated")
        at.operation.speed = start
        terms = [Carry(BIOT, at.operation, at.ends, True),
                 Streamline(BIOT, 0.8, 0.05, at.operation, 1)]
        of = system(mesh, terms, ["u", "p"])
        state = smooth(of.dofs)
        first = of.local_residual(state)
        at.operation.speed = -0.2
        found.append(of.local_residual(state))
        assert np.array_equal(first, found[-1]) == (start == -0.2)
    np.testing.assert_array_equal(*found)
