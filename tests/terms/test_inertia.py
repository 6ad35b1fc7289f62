"""Inertia of the skeleton: momentum, velocities where displacements are given, vibration."""

import numpy as np
import pytest
from scipy.linalg import eig
from scipy.optimize import brentq
from scipy.special import j1, jvp, y1, yvp

from porolub.fem.constraints import ConstraintBuilder
from porolub.terms.inertia import Inertia
from porolub.terms.skeleton import Skeleton
from tests.fem import meshes
from tests.terms.cases import LINEAR, NEO
from tests.terms.manufactured import solve
from tests.terms.support import dense_jacobian, field_values, smooth, system

DENSITY, RATE = 0.3, 5.0
each = pytest.mark.parametrize("kind", meshes.ALL)


def moved_linearly(of, name, slope, shift):
    """The state with a field of `shift + slope x_1` in each component, the others zero."""
    local, dim = np.zeros(of.dofs.size_local), of.dofs.mesh.dim
    field_values(of.dofs, name, lambda X: shift[:dim] + slope * X[:, :1], local)
    return local


@each
def test_rows_of_momentum_add_up_to_its_change(kind):
    mesh = meshes.mesh(kind)
    of = system(mesh, [Inertia(DENSITY, mesh.dim, 2)], ["u"])
    shift = np.array([0.4, -0.2, 0.7])
    before, now = moved_linearly(of, "w", -0.2, 0.5 * shift), moved_linearly(of, "w", 0.3, shift)
    of.backward_euler(before, 1.0 / RATE)
    found = of.dofs.field("u", of.local_residual(now)).sum(axis=0)
    domain = of.domains["cells"]
    volume = domain.weights.sum()
    centre = (domain.weights * domain.position[..., 0]).sum() / volume
    change = DENSITY * volume * (0.5 * shift[: mesh.dim] + 0.5 * centre)
    np.testing.assert_allclose(found, RATE * change, rtol=1e-12, atol=1e-13)
    of.backward_euler(now, 1.0 / RATE)
    np.testing.assert_allclose(of.local_residual(now)[of.dofs.range["u"]], 0.0, atol=1e-13)


@each
def test_the_velocity_is_the_rate_of_the_displacement(kind):
    """Row by row, for any displacement; half of it satisfies no row."""
    mesh = meshes.mesh(kind)
    of = system(mesh, [Inertia(DENSITY, mesh.dim, 2)], ["u"])
    before, now = smooth(of.dofs, 0.03), smooth(of.dofs, 0.05)
    of.backward_euler(before, 1.0 / RATE)
    u, w = of.dofs.range["u"], of.dofs.range["w"]
    now[w] = RATE * (now[u] - before[u])
    assert np.abs(of.local_residual(now)[w]).max() < 1e-15
    now[w] *= 0.5
    assert np.abs(of.local_residual(now)[w]).max() > 1e-4


def test_nothing_is_left_of_it_in_a_steady_state():
    """The rows of u are those of the skeleton alone; the others ask for w = 0."""
    mesh = meshes.mesh("sector")
    skeleton = Skeleton(NEO, mesh.dim, 2)
    alone, of = system(mesh, [skeleton]), system(mesh, [skeleton, Inertia(DENSITY, mesh.dim, 2)])
    state = smooth(of.dofs)
    found = of.local_residual(state)
    u, w = of.dofs.range["u"], of.dofs.range["w"]
    np.testing.assert_array_equal(found[u], alone.local_residual(state[u]))
    assert np.abs(found[w]).max() > 1e-3
    state[w] = 0.0
    assert not of.local_residual(state)[w].any()


def on_rollers(mesh, terms, rise=0.0):
    """A system whose walls let nothing through and whose bone rises by `rise` along its normal.

    On the slanted walls and the arc the displacement is stored in the frame of its node.
    """
    dofs = system(mesh, terms).dofs
    build = ConstraintBuilder(dofs)
    radius = mesh.coordinates - np.array([0.0, meshes.RADIUS])
    radius /= np.linalg.norm(radius, axis=1, keepdims=True)
    across = np.column_stack([-radius[:, 1], radius[:, 0]])
    for name, normal, value in (("inlet", across, 0.0), ("outlet", across, 0.0),
                                ("bone", radius, rise)):
        nodes = mesh.boundary_nodes(name)
        build.direction(nodes, normal[nodes], value)
    return system(mesh, terms, constraints=build.build())


def test_a_given_displacement_gives_its_velocity_also_in_rotated_frames():
    """A step in which the base rises: w = du/dt at every node, no condition on w needed."""
    mesh = meshes.mesh("sector")
    of = on_rollers(mesh, [Skeleton(NEO, 2, 2), Inertia(DENSITY, 2, 2)], rise=0.02)
    assert len(of.constraints.rotated) > 10
    of.backward_euler(np.zeros(of.dofs.size_local), 1.0 / RATE)
    state, norms = solve(of, np.zeros(of.dofs.size_local))
    assert norms[-1] < 1e-11 < norms[0]
    u, w = of.dofs.field("u", state), of.dofs.field("w", state)
    np.testing.assert_allclose(w, RATE * u, atol=1e-12)
    X = mesh.coordinates[mesh.boundary_nodes("bone")] - np.array([0.0, meshes.RADIUS])
    rising = np.einsum("nd,nd->n", w[mesh.boundary_nodes("bone")], X) / np.linalg.norm(X, axis=1)
    np.testing.assert_allclose(rising, RATE * 0.02, rtol=1e-10)


def vibration(modulus, side):
    """Lowest radial frequency of an annulus: fixed inside, free outside, plane strain.

    u'' + u'/r - u/r^2 + k^2 u = 0 with k = omega sqrt(rho / M): Bessel functions of order 1.
    """
    inner, outer = meshes.RADIUS - meshes.THICKNESS, meshes.RADIUS

    def free(k):
        def stress(f, slope):
            return modulus * k * slope(1, k * outer) + side / outer * f(k * outer)

        return stress(j1, jvp) * y1(k * inner) - stress(y1, yvp) * j1(k * inner)

    return brentq(free, 0.5, 3.0) * np.sqrt(modulus / DENSITY)


def frequencies(kind, counts):
    """Of the discrete layer: - G x = lambda C x, with lambda = i omega."""
    mesh = meshes.mesh(kind, *counts)
    of = on_rollers(mesh, [Skeleton(LINEAR, 2, 2), Inertia(DENSITY, 2, 2)])
    zero = np.zeros(of.dofs.size_local)
    steady = dense_jacobian(of, zero)
    of.rate = 1.0
    stored = dense_jacobian(of, zero) - steady
    with np.errstate(divide="ignore", invalid="ignore"):  # constrained rows store nothing
        found = eig(-steady, stored, right=False)
    found = found[np.isfinite(found)]
    found = found[np.abs(found) < 100.0]
    assert np.abs(found.real).max() < 1e-6, "nothing damps"
    return found.imag


@pytest.mark.parametrize("kind", ["sector", "sector of triangles"])
def test_a_curved_layer_on_rollers_rings_at_its_radial_frequency(kind):
    omega = vibration(LINEAR.constrained_modulus, LINEAR.bulk - 2.0 * LINEAR.shear / 3.0)
    errors = [np.abs(frequencies(kind, counts) - omega).min() / omega for counts in
              ((2, 1), (4, 2), (8, 4))]
    assert errors[-1] < 2e-5
    assert np.log2(errors[-2] / errors[-1]) > 3.4
