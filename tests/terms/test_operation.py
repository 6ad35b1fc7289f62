"""The direction of sliding: a unit vector, or with creep a smooth function of the speed."""

import numpy as np
import pytest

from porolub.terms.contact import Contact
from tests.fem import meshes
from tests.terms.cases import setting
from tests.terms.support import everywhere, field_values, operation, system

CREEP = 0.05
MOTIONS = pytest.mark.parametrize("kind", ["rotation", "sliding"])


def contact(mesh, boundary, kind="rest", **others):
    at = setting(mesh, boundary, kind, **others)
    return Contact(at.plane, at.operation, boundary, 1.0, 0.45, True, 2)


def direction(kind, speed, creep=0.0):
    """At the points of an arc (rotation) or of a flat top (sliding plane), and their normals."""
    mesh = meshes.mesh("sector" if kind == "rotation" else "block")
    boundary = "lubricated" if kind == "rotation" else "top"
    of = system(mesh, [contact(mesh, boundary)], ["u", "v0"], boundary=boundary)
    at = everywhere(of, f"nodes:{boundary}", np.zeros(of.dofs.size_local))
    moving = operation(kind, speed, creep=creep)
    return moving.sliding_direction(at.position, at.normal), at.normal


@MOTIONS
@pytest.mark.parametrize("speed", [1e-12, -0.7])
def test_without_creep_it_is_a_unit_vector_along_the_surface_at_any_speed(kind, speed):
    found, normal = direction(kind, speed)
    np.testing.assert_allclose(np.linalg.norm(found, axis=-1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(np.einsum("...d,...d->...", found, normal), 0.0, atol=1e-14)
    forward = np.sign(speed) * (1.0 if kind == "rotation" else -1.0)  # of the body on the plane
    assert np.all(forward * found[..., 0] > 0.5)


@MOTIONS
@pytest.mark.parametrize("creep", [0.0, CREEP])
def test_it_is_zero_at_rest_and_odd_in_the_speed(kind, creep):
    assert not direction(kind, 0.0, creep)[0].any()
    for speed in (0.1 * CREEP, 1.0):
        there, back = direction(kind, speed, creep)[0], direction(kind, -speed, creep)[0]
        assert there.any()
        np.testing.assert_array_equal(there, -back)


@MOTIONS
def test_with_creep_it_passes_through_a_reversal_without_a_jump(kind):
    """Each small change of speed changes it in proportion; without creep it jumps by two."""
    speeds = np.linspace(-1.0, 1.0, 801)
    for creep, jumps in ((CREEP, False), (0.0, True)):
        along = np.array([direction(kind, s, creep)[0][..., 0].mean() for s in speeds])
        steepest = (meshes.RADIUS if kind == "rotation" else 1.0) * 2.0 / 800 / CREEP
        assert (np.abs(np.diff(along)).max() > steepest) == jumps
        assert np.abs(along).max() > 0.9


@MOTIONS
def test_creep_is_forgotten_far_above_it_and_halves_the_square_at_its_own_speed(kind):
    arm = meshes.RADIUS if kind == "rotation" else 1.0
    for times, share in ((1.0, np.sqrt(0.5)), (7.1, 0.99), (1e6, 1.0)):
        found, _ = direction(kind, times * CREEP / arm, CREEP)
        size = np.linalg.norm(found, axis=-1)
        # a node's normal is averaged over its facets: not quite the radius
        np.testing.assert_allclose(size, share, rtol=2e-3)
        assert size.max() <= 1.0


def test_friction_on_the_skeleton_fades_with_the_speed():
    """A sliding plane drags a layer at rest along with mu l, less below the speed of creep."""
    mesh, drag = meshes.mesh("block"), {}
    for times in (0.1, 1.0, 1e4):
        term = contact(mesh, "top", "sliding", creep=0.7 / times)
        of = system(mesh, [term], ["u", "v0"], boundary="top")
        local = np.zeros(of.dofs.size_local)
        field_values(of.dofs, "l", lambda X: np.full(len(X), 0.2), local)
        forces = -of.dofs.field("u", of.local_residual(local)).sum(axis=0)
        drag[times] = (forces + 0.2 * 3.0 * np.asarray(term.plane.toward))[0]
    full = 0.45 * 0.2 * 3.0
    expected = {0.1: full * 0.1 / np.sqrt(1.01), 1.0: full / np.sqrt(2.0), 1e4: full}
    assert drag == pytest.approx(expected, rel=1e-7)
