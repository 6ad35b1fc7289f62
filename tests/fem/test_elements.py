"""Reference elements: nodal, complete, with the right gradients and the mesh's node order."""

import numpy as np
import pytest

from porolub.fem import elements
from porolub.mesh.cell import CELLS

POINTS = {
    cell: np.random.default_rng(1).dirichlet(np.ones(CELLS[cell].dim + 1), 6)[:, 1:]
    for cell in CELLS
}
CASES = [(cell, degree) for cell in CELLS for degree in (1, 2)]
each = pytest.mark.parametrize(("cell", "degree"), CASES)


def monomials(cell, degree):
    """Exponents of all monomials the element must hold, by the textbook."""
    dim = CELLS[cell].dim
    powers = np.array(list(np.ndindex(*[degree + 1] * dim)))
    return powers if CELLS[cell].tensor else powers[powers.sum(axis=1) <= degree]


@each
def test_one_at_its_own_node_and_zero_at_the_others(cell, degree):
    value, _ = elements.tabulate(cell, degree, elements.nodes(cell, degree))
    np.testing.assert_allclose(value, np.eye(CELLS[cell].nodes(degree)), atol=1e-14)


@each
def test_partition_of_unity(cell, degree):
    value, gradient = elements.tabulate(cell, degree, POINTS[cell])
    np.testing.assert_allclose(value.sum(axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(gradient.sum(axis=2), 0.0, atol=1e-13)


@each
def test_holds_its_polynomials(cell, degree):
    x, nodes = POINTS[cell], elements.nodes(cell, degree)
    value, gradient = elements.tabulate(cell, degree, x)
    powers = monomials(cell, degree)
    assert len(powers) == len(nodes)
    for power in powers:
        at_nodes = np.prod(nodes**power, axis=1)
        np.testing.assert_allclose(value @ at_nodes, np.prod(x**power, axis=1), atol=1e-14)
        for d in range(len(power)):
            lower = power.copy()
            lower[d] = max(power[d] - 1, 0)
            slope = power[d] * np.prod(x**lower, axis=1)
            np.testing.assert_allclose(gradient[:, d] @ at_nodes, slope, atol=1e-13)


@each
def test_nodes_are_ordered_as_in_the_mesh(cell, degree):
    nodes = elements.nodes(cell, degree)
    corners = np.array(elements.VERTICES[cell], dtype=float)
    expected = [corners]
    if degree == 2:
        expected += [corners[parents].mean(axis=1) for parents in CELLS[cell].parents()]
    np.testing.assert_allclose(nodes, np.vstack(expected), atol=1e-15)


@pytest.mark.parametrize("cell", CELLS)
def test_faces_are_numbered_as_in_the_mesh(cell):
    assert [set(f) for f in elements.faces(cell)] == [set(f) for f in CELLS[cell].faces]


@pytest.mark.parametrize("cell", CELLS)
def test_points_on_a_face_see_only_its_nodes(cell):
    inside = {"line": [[0.3]], "quad": [[0.3, -0.4]], "triangle": [[0.3, 0.15]]}
    for number in range(len(elements.faces(cell))):
        points = np.array(inside[elements.FACE_CELL[cell]])
        x, tangents = elements.face_points(cell, number, points)
        value, _ = elements.tabulate(cell, 2, x)
        on_face = CELLS[cell].face_nodes(2)[number]
        assert set(np.flatnonzero(value[0])) == set(on_face)
        step = 1e-3 * np.eye(points.shape[1])
        shifted = elements.face_points(cell, number, points + step)[0]
        np.testing.assert_allclose(shifted - x, 1e-3 * tangents.T, atol=1e-15)
