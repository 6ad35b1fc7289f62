"""Motion about any axis and in any direction: velocities, and the terms that live on them."""

import numpy as np
import pytest

from porolub.fem.domains import Domain
from tests.fem import meshes
from tests.terms.cases import CASES, setting
from tests.terms.support import operation, smooth, system
from tests.terms.taylor import keep_off_kinks, pairs

AXIS = np.array([0.48, 0.6, 0.64])
CENTRE = (0.3, 1.7, -0.4)
MOVED = ("carry", "carry, fresh", "streamline", "film", "film on a porous layer",
         "contact, friction", "compressible pores, spatial", "compressible film")


def test_the_body_turns_as_omega_cross_r_says():
    at = operation("rotation", 0.7, axis=tuple(AXIS), centre=CENTRE)
    X = np.random.default_rng(1).normal(size=(5, 4, 3))
    v = at.body_velocity(X)
    np.testing.assert_allclose(v, 0.7 * np.cross(AXIS, X - CENTRE), atol=1e-14)
    # the axis itself is at rest
    np.testing.assert_allclose(at.body_velocity(np.array(CENTRE) + 3.0 * AXIS), 0.0, atol=1e-14)


def test_about_z_it_turns_as_in_the_plane():
    X = np.random.default_rng(2).normal(size=(6, 3))
    solid = operation("rotation", 0.7).body_velocity(X)
    plane = operation("rotation", 0.7).body_velocity(X[:, :2])
    np.testing.assert_allclose(solid[:, :2], plane, atol=1e-15)
    np.testing.assert_allclose(solid[:, 2], 0.0, atol=1e-15)


def test_turning_neither_swells_nor_shears():
    """What flows into a body through all its boundaries is nothing."""
    mesh = meshes.mesh("barrel")
    at = operation("rotation", 0.7, axis=tuple(AXIS), centre=CENTRE)
    through = 0.0
    for name in mesh.boundary_names:
        facets = Domain(f"facets:{name}", mesh, 4)
        v = at.body_velocity(facets.position)
        through += np.einsum("eq,eqd,eqd->", facets.weights, v, facets.normal)
    assert abs(through) < 1e-12


@pytest.mark.parametrize("kind", ["barrel", "cuboid"])
@pytest.mark.parametrize("name", MOVED)
def test_jacobian_about_an_axis_of_its_own(name, kind):
    case, mesh, boundary = CASES[name], meshes.mesh(kind, 3, 1, 2), meshes.surface(kind)
    at = setting(mesh, boundary, "rotation", axis=tuple(AXIS), centre=CENTRE)
    of = system(mesh, [case.build(at)], case.fields, True, boundary=boundary)
    state = smooth(of.dofs)
    of.backward_euler(smooth(of.dofs, 0.03, 0.05), 1 / 5.0)
    if case.surface:
        state = keep_off_kinks(of, at.plane, boundary, state)
    assert pairs(of, state) == case.pairs | case.also


@pytest.mark.parametrize("name", ["film", "film on a porous layer", "contact, friction"])
def test_jacobian_of_a_plane_that_slides_askew(name):
    case, mesh = CASES[name], meshes.mesh("barrel", 3, 1, 2)
    at = setting(mesh, "lubricated", "sliding", direction=(0.6, 0.0, -0.8))
    of = system(mesh, [case.build(at)], case.fields, True, boundary="lubricated")
    state = keep_off_kinks(of, at.plane, "lubricated", smooth(of.dofs))
    assert pairs(of, state) == case.pairs
