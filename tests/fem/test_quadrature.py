"""Quadrature rules: exact to the degree they claim, and no further."""

from itertools import product
from math import factorial

import numpy as np
import pytest

from porolub.fem.quadrature import rule

DIMENSION = {"line": 1, "quad": 2, "hex": 3, "triangle": 2, "tet": 3}
SIMPLEX = ("triangle", "tet")
NUMBERS = range(1, 5)


def exact(cell, powers):
    """Integral of a monomial over the reference cell."""
    if cell in SIMPLEX:
        top = np.prod([float(factorial(k)) for k in powers])
        return top / factorial(sum(powers) + len(powers))
    return np.prod([(1 - (-1) ** (k + 1)) / (k + 1) for k in powers])


def defect(cell, n, powers):
    points, weights = rule(cell, n)
    return abs(weights @ np.prod(points ** np.array(powers), axis=1) - exact(cell, powers))


@pytest.mark.parametrize("n", NUMBERS)
@pytest.mark.parametrize("cell", DIMENSION)
def test_exact_to_its_degree(cell, n):
    for powers in product(range(2 * n), repeat=DIMENSION[cell]):
        if cell not in SIMPLEX or sum(powers) < 2 * n:
            assert defect(cell, n, powers) < 1e-13


@pytest.mark.parametrize("n", NUMBERS)
@pytest.mark.parametrize("cell", DIMENSION)
def test_not_exact_beyond(cell, n):
    beyond = [(2 * n, *(0,) * (DIMENSION[cell] - 1))]
    assert max(defect(cell, n, powers) for powers in beyond) > 1e-8


@pytest.mark.parametrize("n", NUMBERS)
@pytest.mark.parametrize("cell", DIMENSION)
def test_points_lie_inside_and_weigh_positively(cell, n):
    points, weights = rule(cell, n)
    assert points.shape == (n ** DIMENSION[cell], DIMENSION[cell])
    assert weights.min() > 0
    if cell in SIMPLEX:
        assert points.min() > 0
        assert points.sum(axis=1).max() < 1
    else:
        assert np.abs(points).max() < 1


def test_unknown_cells_are_refused():
    with pytest.raises(ValueError, match="no quadrature on 'pyramid'"):
        rule("pyramid", 2)
