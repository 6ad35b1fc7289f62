"""Structured meshes of the shapes: quads, triangles or hexahedra between given ticks."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from porolub.mesh.cell import HEX, QUAD, TRIANGLE
from porolub.mesh.raw import RawMesh, oriented
from porolub.mesh.shape import Shape

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def _corners(block: Index) -> Index:
    """Vertices of each cell of a 2D or 3D array of vertex numbers, in VTK order."""
    if block.ndim == 2:
        parts = [block[:-1, :-1], block[1:, :-1], block[1:, 1:], block[:-1, 1:]]
    else:
        ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
        pick = (slice(0, -1), slice(1, None))
        parts = [block[pick[i], pick[j], pick[k]] for k in (0, 1) for i, j in ring]
    return np.stack([part.ravel() for part in parts], axis=1)


def _sides(block: Index) -> list[Index]:
    """Facets of the sides: first axis low, high, second axis low, high, ..."""
    sides: list[Index] = []
    for axis in range(block.ndim):
        for end in (0, -1):
            face: Index = np.asarray(block.take(end, axis=axis))
            if face.ndim == 1:
                sides.append(np.stack([face[:-1], face[1:]], axis=1))
            else:
                sides.append(_corners(face))
    return sides


def _halves(quads: Index, shape: tuple[int, int]) -> Index:
    """Two triangles for each quad of a (nx, ny) grid, diagonals alternating like a chessboard."""
    i, j = np.indices(shape)
    odd = ((i + j) % 2).ravel().astype(bool)
    first = np.where(odd[:, None], quads[:, [0, 1, 3]], quads[:, [0, 1, 2]])
    second = np.where(odd[:, None], quads[:, [1, 2, 3]], quads[:, [0, 2, 3]])
    return np.stack([first, second], axis=1).reshape(-1, 3)


def grid(shape: Shape, ticks: Sequence[Array], *, triangles: bool = False) -> RawMesh:
    """The shape's mesh with vertices at the logical `ticks` of each axis.

    Cells are numbered with `along` slowest, so consecutive cells form strips across the layer.
    """
    axes = np.meshgrid(*ticks, indexing="ij")
    points = shape.physical(np.stack([axis.ravel() for axis in axes], axis=1))
    block = np.arange(len(points), dtype=np.int64).reshape([len(axis) for axis in ticks])
    cells = _corners(block)
    cell = QUAD if shape.dim == 2 else HEX
    if triangles:
        cells = _halves(cells, (len(ticks[0]) - 1, len(ticks[1]) - 1))
        cell = TRIANGLE
    boundaries = dict(zip(shape.boundaries, _sides(block), strict=True))
    return oriented(RawMesh(cell, points, cells, boundaries))
