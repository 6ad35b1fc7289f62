"""Integration domains: entities seen through the closure of their cell, with points on them.

A domain is all cells, the facets of a boundary, or the nodes of a boundary (nodal quadrature).
Every term integrates over one of these, with the same pointwise interface.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from porolub.errors import SolveError
from porolub.fem import elements, quadrature
from porolub.mesh import Facets, Mesh

Array = NDArray[np.float64]
Ints = NDArray[np.int32]


@dataclass(frozen=True)
class Tables:
    """Basis values (variants, nq, nn) and reference gradients (variants, nq, dim, nn)."""

    value: Array
    gradient: Array


class Domain:
    """Entities with quadrature points.

    Attributes
    ----------
    name: what it is: ``cells``, ``facets:NAME`` or ``nodes:NAME`` (or ``nodes of cells``: the
        cells with their own nodes as points, to evaluate there)
    cells: (ne,) local cell number of each entity, or (ne,) node numbers on a nodal domain
    variant: (ne,) which rows of the tables an entity uses
    weights: (ne, nq) quadrature weight times measure
    inverse: (ne, nq, dim, dim) derivative of reference by physical coordinates
    position: (ne, nq, dim); normal: (ne, nq, dim), outward (zeros on ``cells``)
    """

    def __init__(self, name: str, mesh: Mesh, points_per_direction: int) -> None:
        self.name = name
        self.mesh = mesh
        self.dim: int = mesh.dim
        kind, _, boundary = name.partition(":")
        if kind == "cells":
            self._cells(*quadrature.rule(mesh.cell_type, points_per_direction))
        elif kind == "nodes of cells":
            places = elements.nodes(mesh.cell_type, mesh.degree)
            self._cells(places, np.ones(len(places)))
        elif kind == "facets":
            self._facets(mesh.facets(boundary), points_per_direction)
        else:
            raise ValueError(f"no such integration domain: {name!r}")

    # -- construction -------------------------------------------------------------------
    def _cells(self, points: Array, w: Array) -> None:
        mesh = self.mesh
        self.cells = np.arange(len(mesh.cells), dtype=np.int32)
        self.variant = np.zeros(len(mesh.cells), dtype=np.int32)
        self._points = points[None]
        jacobian = self._geometry()
        det = np.linalg.det(jacobian)
        if np.any(det <= 0):
            raise SolveError(self._bad_cell(det))
        self.weights = np.ascontiguousarray(det * w)
        self.inverse = np.ascontiguousarray(np.linalg.inv(jacobian))
        self.normal = np.zeros_like(self.position)

    def _facets(self, facets: Facets, n: int) -> None:
        mesh = self.mesh
        cell = mesh.cell_type
        points, w = quadrature.rule(elements.FACE_CELL[cell], n)
        mapped = [elements.face_points(cell, f, points) for f in range(len(elements.faces(cell)))]
        self.cells = np.asarray(facets.cells, dtype=np.int32)
        self.variant = np.asarray(facets.local_face, dtype=np.int32)
        self._points = np.stack([m[0] for m in mapped])
        jacobian = self._geometry()
        tangents = jacobian @ np.stack([m[1] for m in mapped])[self.variant][:, None]
        if self.dim == 2:
            normal = np.stack([tangents[..., 1, 0], -tangents[..., 0, 0]], axis=-1)
        else:
            normal = np.cross(tangents[..., 0], tangents[..., 1])
        measure = np.linalg.norm(normal, axis=-1)
        normal = normal / measure[..., None]
        centre = mesh.coordinates[mesh.vertices_of_cells[self.cells]].mean(axis=1)
        outward = np.einsum("eqd,eqd->eq", normal, self.position - centre[:, None]) > 0
        self.normal = np.where(outward[..., None], normal, -normal)
        self.weights = np.ascontiguousarray(measure * w)
        self.inverse = np.ascontiguousarray(np.linalg.inv(jacobian))

    def _geometry(self) -> Array:
        """Jacobian dX/dxi (ne, nq, dim, dim) of the isoparametric map; sets the positions."""
        mesh = self.mesh
        tables = self.tables(mesh.degree)
        X = mesh.coordinates[mesh.cells[self.cells]]
        nq, dim = tables.value.shape[1], mesh.dim
        self.position = np.empty((len(X), nq, dim))
        jacobian = np.empty((len(X), nq, dim, dim))
        for v in range(len(tables.value)):
            rows = np.flatnonzero(self.variant == v)
            self.position[rows] = tables.value[v] @ X[rows]
            slopes = tables.gradient[v].reshape(nq * dim, -1) @ X[rows]
            jacobian[rows] = slopes.reshape(-1, nq, dim, dim).swapaxes(2, 3)
        return jacobian

    def _bad_cell(self, det: Array) -> str:
        e = int(np.argmin(det.min(axis=1)))
        where = ", ".join(f"{x:.4g}" for x in self.position[e].mean(axis=0))
        return f"The mesh has an inverted or degenerate element near ({where}) (mesh units)."

    # -- use ----------------------------------------------------------------------------
    def __len__(self) -> int:
        return len(self.weights)

    def tables(self, degree: int) -> Tables:
        """Basis tables of the Lagrange element of this degree (0: a constant, one node)."""
        cache = self.__dict__.setdefault("_tables", {})
        if degree not in cache:
            if degree == 0:
                shape = self._points.shape[:2]
                cache[0] = Tables(np.ones((*shape, 1)), np.zeros((*shape, self.dim, 1)))
            else:
                rows = [elements.tabulate(self.mesh.cell_type, degree, p) for p in self._points]
                cache[degree] = Tables(np.stack([r[0] for r in rows]),
                                       np.stack([r[1] for r in rows]))
        return cache[degree]

    @cached_property
    def size(self) -> Array:
        """(ne, nq, dim) element length along each physical direction: |d xi/d x|^-1, doubled."""
        return 2.0 / np.maximum(np.abs(self.inverse).sum(axis=2), 1e-300)

    def length_along(self, direction: Array, rows: slice = slice(None)) -> Array:
        """(ne, nq) element length in a unit direction (ne, nq, dim); 0 without a direction.

        2 / |d xi/dx . direction| on tensor cells, half of it on simplices.
        """
        rate = np.einsum("eqrd,eqd->eqr", self.inverse[rows], direction)
        reach = 1.0 if self.mesh.cell_type in ("triangle", "tet") else 2.0
        size = np.linalg.norm(rate, axis=-1)
        return np.divide(reach, size, out=np.zeros_like(size), where=size > 0)


def nodal_shares(surface: Domain) -> Array:
    """(ne, nodes per cell) weights of nodal quadrature on each facet of a surface.

    The integral of each node's basis function; on quadratic triangles that of the functions 1 - 2
    lambda of the sides, 1 in their middles and linear: never negative, the area in sum, also
    where the triangles are curved.
    """
    mesh = surface.mesh
    if mesh.cell_type != "tet" or mesh.degree == 1:
        values = surface.tables(mesh.degree).value[surface.variant]
        return np.einsum("eq,eqi->ei", surface.weights, values)
    vertex = surface.tables(1).value[surface.variant]
    ends = vertex[:, :, np.array(mesh.cell.edges)]  # (ne, nq, edges, 2)
    of_faces = mesh.cell.face_nodes(2)
    on_facet = np.zeros((len(of_faces), mesh.cells.shape[1]), bool)
    np.put_along_axis(on_facet, of_faces, True, axis=1)
    edges = slice(mesh.cell.vertices, None)
    shares = np.zeros((len(surface), mesh.cells.shape[1]))
    shares[:, edges] = np.einsum("eq,eqi->ei", surface.weights, 2.0 * ends.sum(axis=3) - 1.0)
    return np.where(on_facet[surface.variant], shares, 0.0)


class NodalDomain(Domain):
    """Owned nodes of a boundary, each its own entity with one point: nodal quadrature."""

    def __init__(self, name: str, mesh: Mesh, nodes: NDArray[np.int64], weights: Array,
                 normal: Array) -> None:
        self.name, self.mesh, self.dim = name, mesh, mesh.dim
        ne = len(nodes)
        self.cells = np.asarray(nodes, dtype=np.int32)
        self.variant = np.zeros(ne, dtype=np.int32)
        self.weights = np.ascontiguousarray(weights.reshape(ne, 1))
        self.inverse = np.zeros((ne, 1, mesh.dim, mesh.dim))
        self.position = mesh.coordinates[nodes][:, None, :]
        self.normal = np.ascontiguousarray(normal.reshape(ne, 1, mesh.dim))
        self._points = np.zeros((1, 1, mesh.dim))

    def tables(self, degree: int) -> Tables:
        return Tables(np.ones((1, 1, 1)), np.zeros((1, 1, self.dim, 1)))
