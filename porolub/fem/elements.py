"""Lagrange elements of degree 1 and 2 on quad, triangle, hex and tet, in the mesh's node order.

Node orders are those of ``porolub.mesh.Mesh.cells`` (VTK's): vertices, edges, faces, centre.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Vertices of the reference cells, then the vertex pairs (edges) and vertex sets (faces)
# whose barycentres are the degree-2 nodes.
VERTICES: dict[str, list[tuple[float, ...]]] = {
    "quad": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
    "triangle": [(0, 0), (1, 0), (0, 1)],
    "hex": [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1),
            (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
    "tet": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
}
EDGES: dict[str, list[tuple[int, int]]] = {
    "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "triangle": [(0, 1), (1, 2), (2, 0)],
    "hex": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
            (0, 4), (1, 5), (2, 6), (3, 7)],
    "tet": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
}
HEX_FACES: list[tuple[int, ...]] = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (2, 3, 7, 6),
                                    (0, 1, 2, 3), (4, 5, 6, 7)]


def dimension(cell: str) -> int:
    return len(VERTICES[cell][0])


@cache
def _nodes(cell: str, degree: int) -> Array:
    v = np.array(VERTICES[cell], dtype=float)
    if degree == 1:
        return v
    sets: list[tuple[int, ...]] = [*EDGES[cell]]
    if cell == "quad":
        sets.append((0, 1, 2, 3))
    if cell == "hex":
        sets += [*HEX_FACES, tuple(range(8))]
    return np.vstack([v] + [v[list(s)].mean(axis=0) for s in sets])


def nodes(cell: str, degree: int) -> Array:
    """Reference coordinates (nn, dim) of the Lagrange nodes."""
    return _nodes(cell, degree).copy()


def _exponents(cell: str, degree: int) -> NDArray[np.int64]:
    dim = dimension(cell)
    grid = np.stack(np.meshgrid(*[range(degree + 1)] * dim, indexing="ij"), -1).reshape(-1, dim)
    if cell in ("triangle", "tet"):
        grid = grid[grid.sum(axis=1) <= degree]
    return grid


@cache
def _coefficients(cell: str, degree: int) -> Array:
    """Monomial coefficients (monomial, node) of the nodal basis."""
    x, powers = nodes(cell, degree), _exponents(cell, degree)
    vandermonde = np.prod(x[:, None, :] ** powers[None], axis=2)
    coefficients = np.linalg.inv(vandermonde)
    coefficients[np.abs(coefficients) < 1e-14] = 0.0
    return coefficients


def tabulate(cell: str, degree: int, points: Array) -> tuple[Array, Array]:
    """Basis values (nq, nn) and reference gradients (nq, dim, nn) at points (nq, dim)."""
    powers, coefficients = _exponents(cell, degree), _coefficients(cell, degree)
    dim = powers.shape[1]
    value = np.prod(points[:, None, :] ** powers[None], axis=2)
    gradient = np.empty((len(points), dim, len(powers)))
    for d in range(dim):
        lowered = powers.copy()
        lowered[:, d] = np.maximum(powers[:, d] - 1, 0)
        gradient[:, d] = powers[:, d] * np.prod(points[:, None, :] ** lowered[None], axis=2)
    N, dN = value @ coefficients, gradient @ coefficients
    # nodes off a face are exactly absent from it, so no spurious matrix entries arise
    N[np.abs(N) < 1e-14] = 0.0
    return np.ascontiguousarray(N), np.ascontiguousarray(dN)


FACE_CELL = {"quad": "line", "triangle": "line", "hex": "quad", "tet": "triangle"}


def faces(cell: str) -> list[tuple[int, ...]]:
    """Vertex numbers of each face, in the mesh's face order."""
    if cell in ("quad", "triangle"):
        return [tuple(e) for e in EDGES[cell]]
    if cell == "hex":
        return HEX_FACES
    return [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]


def face_points(cell: str, face: int, points: Array) -> tuple[Array, Array]:
    """Map face points (nq, dim - 1) into the cell; also the (dim, dim - 1) face tangents."""
    corners = np.array([VERTICES[cell][i] for i in faces(cell)[face]], dtype=float)
    kind = FACE_CELL[cell]
    if kind == "triangle":
        tangents = np.stack([corners[1] - corners[0], corners[2] - corners[0]], axis=1)
        return corners[0] + points @ tangents.T, tangents
    if kind == "line":
        tangents = ((corners[1] - corners[0]) / 2)[:, None]
    else:
        tangents = np.stack([(corners[1] - corners[0]) / 2, (corners[3] - corners[0]) / 2], axis=1)
    return corners.mean(axis=0) + points @ tangents.T, tangents
