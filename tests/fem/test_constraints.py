"""Essential conditions: frames that turn any set of constraints into fixed components."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from porolub.errors import SceneError
from porolub.fem.constraints import ConstraintBuilder, node_frames
from porolub.fem.dofs import Dofs, Field
from tests.fem import meshes

NUMBERS = st.floats(-2.0, 2.0)


@st.composite
def conditions(draw):
    """A displacement and up to `dim` independent unit directions it is prescribed along."""
    dim = draw(st.sampled_from([2, 3]))
    count = draw(st.integers(1, dim))
    d = draw(arrays(float, (count, dim), elements=st.floats(-1, 1)))
    size = np.linalg.norm(d, axis=1, keepdims=True)
    assume(size.min() > 0.1)
    assume(np.linalg.svd(d / size, compute_uv=False).min() > 0.05)
    return d / size, draw(arrays(float, dim, elements=NUMBERS))


def one_node(directions, values):
    """Frame and fixed components of a single node, and whether it is contradicted."""
    frames, components, wrong = node_frames(np.array([directions]), np.array([values]))
    held = ~np.isnan(components[0])
    assert (np.diff(held.astype(int)) <= 0).all(), "fixed components come first"
    return frames[0], components[0][held], bool(wrong[0])


def stored(frame, components, rng):
    """Any displacement the frame allows: free components at random."""
    free = rng.standard_normal(len(frame) - len(components))
    return frame @ np.concatenate([components, free])


@given(conditions())
def test_a_frame_meets_its_conditions_whatever_the_free_components(case):
    directions, u = case
    frame, components, wrong = one_node(directions, directions @ u)
    assert not wrong
    np.testing.assert_allclose(frame.T @ frame, np.eye(len(u)), atol=1e-12)
    assert len(components) == len(directions)
    moved = stored(frame, components, np.random.default_rng(0))
    np.testing.assert_allclose(directions @ moved, directions @ u, atol=1e-10)


@given(conditions(), st.lists(NUMBERS, min_size=1, max_size=3))
def test_a_repeated_condition_changes_nothing(case, mixture):
    directions, u = case
    mixed = np.resize(mixture, len(directions)) @ directions
    assume(np.linalg.norm(mixed) > 0.1)
    more = [*directions, mixed / np.linalg.norm(mixed)]
    frame, components, wrong = one_node(more, [float(d @ u) for d in more])
    assert not wrong
    assert len(components) == len(directions)
    moved = stored(frame, components, np.random.default_rng(0))
    np.testing.assert_allclose(directions @ moved, directions @ u, atol=1e-9)


@given(conditions(), st.floats(1e-6, 1.0))
def test_a_contradiction_is_seen(case, defect):
    directions, u = case
    values = [*(directions @ u), float(directions[0] @ u) + defect]
    assert one_node([*directions, directions[0]], values)[2]


def test_many_nodes_at_once_are_each_as_if_alone():
    rng = np.random.default_rng(5)
    directions = rng.standard_normal((40, 3, 3))
    directions[::3, 1] = directions[::3, 0]  # some say the same twice
    directions[::4] = directions[::4, :1]  # or three times
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    values = np.einsum("nki,ni->nk", directions, rng.standard_normal((40, 3)))
    frames, components, wrong = node_frames(directions, values)
    assert not wrong.any()
    for k in range(40):
        alone = node_frames(directions[k : k + 1], values[k : k + 1])
        np.testing.assert_allclose(frames[k], alone[0][0], atol=1e-14)
        np.testing.assert_allclose(components[k], alone[1][0], atol=1e-14)
    assert set((~np.isnan(components)).sum(axis=1)) == {1, 2, 3}


def builder(kind="sector"):
    mesh = meshes.mesh(kind)
    fields = [Field("u", mesh.dim, 2), Field("p", 1, 1)]
    return ConstraintBuilder(Dofs(mesh, fields))


def test_a_corner_of_two_sliding_walls_is_fixed():
    build = builder()
    mesh = build.dofs.mesh
    for name in ("bone", "inlet"):
        nodes = mesh.boundary_nodes(name)
        outward = mesh.coordinates[nodes] - [0.0, meshes.RADIUS]
        outward /= np.linalg.norm(outward, axis=1, keepdims=True)
        if name == "inlet":
            outward = outward[:, ::-1] * [1, -1]
        build.direction(nodes, outward, 0.0)
    found = build.build()
    bone, inlet = mesh.boundary_nodes("bone"), mesh.boundary_nodes("inlet")
    corner = np.intersect1d(bone, inlet)
    assert len(corner) == 1
    assert len(found.fixed) == len(bone) + len(inlet) == len(set(found.fixed))
    base = build.dofs.base["u"]
    assert {base[corner[0]], base[corner[0]] + 1} <= set(found.fixed)
    for node in np.setdiff1d(bone, corner):
        assert {base[node], base[node] + 1} & set(found.fixed) == {base[node]}
    np.testing.assert_array_equal(found.values, 0.0)


def test_frames_along_the_axes_are_not_rotated():
    build = builder("block")
    nodes = build.dofs.mesh.boundary_nodes("left")
    build.direction(nodes, np.broadcast_to([1.0, 0.0], (len(nodes), 2)), 0.25)
    found = build.build()
    assert len(found.rotated) == 0
    np.testing.assert_array_equal(np.sort(found.fixed), build.dofs.base["u"][nodes])
    np.testing.assert_array_equal(found.values, 0.25)


def test_a_scalar_is_fixed_where_its_field_lives():
    build = builder("block")
    mesh, base = build.dofs.mesh, build.dofs.base["p"]
    nodes = mesh.boundary_nodes("top")
    build.scalar("p", nodes, 0.5)
    found = build.build()
    assert len(found.fixed) == 5 < len(nodes)  # vertices only: the pressure is of degree 1
    np.testing.assert_array_equal(np.sort(found.fixed), np.sort(base[nodes][base[nodes] >= 0]))
    np.testing.assert_array_equal(found.values, 0.5)


def test_contradicting_boundaries_are_refused_by_the_place_of_the_node():
    build = builder("block")
    for name, value in (("left", 0.1), ("bottom", 0.2)):
        nodes = build.dofs.mesh.boundary_nodes(name)
        build.direction(nodes, np.broadcast_to([1.0, 0.0], (len(nodes), 2)), value)
    with pytest.raises(SceneError, match=r"contradict each other at the node \(-1.5, 0\)"):
        build.build()
