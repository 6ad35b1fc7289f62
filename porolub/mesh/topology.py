"""Faces, edges and vertices of the cells of a DMPlex, in our order, without a loop over cells."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.mesh import plex
from porolub.mesh.cell import Cell

Index = NDArray[np.int64]
FACES = {
    "quad": (0, 1, 2, 3),
    "triangle": (0, 1, 2),
    "hex": (5, 4, 2, 3, 0, 1),
    "tet": (2, 3, 1, 0),
}
"""The place of each of our faces among those that PETSc lists of a cell (see plex.VERTICES)."""


@dataclass(frozen=True)
class Topology:
    """What the cells of a rank consist of, as points of its DMPlex.

    strata: (first, last + 1) point of each dimension from 0 on
    faces: (ncell, faces per cell) points in the order of `cell`; in 2D these are the edges
    rings: (nface, k) edges of each face, in 3D; ends: (nedge, 2) vertices of each edge
    """

    cell: Cell
    strata: tuple[tuple[int, int], ...]
    faces: Index
    rings: Index
    ends: Index

    @classmethod
    def of(cls, dm: PETSc.DMPlex, cell: Cell) -> "Topology":
        strata = tuple(dm.getDepthStratum(depth) for depth in range(cell.dim + 1))
        cones = plex.cones(dm, cell)
        return cls(cell, strata, cones[-1][:, FACES[cell.name]], cones[-2], cones[0])

    def points(self, dim: int) -> Index:
        """All points of the dimension."""
        return np.arange(*self.strata[dim], dtype=np.int64)

    def corners(self, dim: int) -> Index:
        """Sorted vertices (n, k) of each edge (dim = 1) or, in 3D, face (dim = 2)."""
        if dim == 1:
            return np.sort(self.ends, axis=1)
        twice = self.ends[self.rings - self.strata[1][0]].reshape(len(self.rings), -1)
        return np.sort(twice, axis=1)[:, ::2]  # each vertex is the end of two of the edges

    def nodes(self, degree: int) -> Index:
        """Points (ncell, nodes per cell) that carry the nodes of each cell: an edge is what two
        of its faces share, a vertex what two of its edges share."""
        cell, edges = self.cell, self.faces
        if cell.dim == 3:
            sides = [_meeting(cell.faces, edge) for edge in cell.edges]
            edges = _shared(self.rings, self.faces - self.strata[2][0], sides)
        meeting = [_meeting(cell.edges, (vertex,)) for vertex in range(cell.vertices)]
        columns = [_shared(self.ends, edges - self.strata[1][0], meeting)]
        if degree == 2:
            columns.append(edges)
            if cell.tensor:
                inner = [self.faces] if cell.dim == 3 else []
                columns += [*inner, self.points(cell.dim)[:, None]]
        return np.hstack(columns)

    def with_nodes(self, degree: int) -> list[int]:
        """Dimensions of the points that carry nodes."""
        if degree == 1:
            return [0]
        return list(range(self.cell.dim + 1)) if self.cell.tensor else [0, 1]


def _meeting(parts: tuple[tuple[int, ...], ...], vertices: tuple[int, ...]) -> tuple[int, int]:
    """Two parts of the reference cell that have exactly these vertices in common."""
    pairs = combinations(range(len(parts)), 2)
    return next(pair for pair in pairs if {*parts[pair[0]]} & {*parts[pair[1]]} == {*vertices})


def _shared(bounds: Index, parts: Index, pairs: list[tuple[int, int]]) -> Index:
    """For each pair (a, b), the bound (ncell,) that the parts a and b of a cell have in common.

    bounds: (n, k) of each part; parts: (ncell, m) rows of `bounds`
    """
    found = np.empty((len(parts), len(pairs)), dtype=np.int64)
    of_part = [[*bounds[rows].T] for rows in parts.T]
    for column, (a, b) in enumerate(pairs):
        for one in of_part[a]:
            same = np.logical_or.reduce([one == other for other in of_part[b]])
            found[same, column] = one[same]
    return found
