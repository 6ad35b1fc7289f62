"""Positions of the nodes: on the true curves of a shape, or as the mesh file has them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.mesh.cell import Cell
from porolub.mesh.mesh import connectivity
from porolub.mesh.raw import RawMesh, face_keys, match_rows
from porolub.mesh.shape import Shape

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def add_middles(places: Array, cells: Index, cell: Cell) -> None:
    """Fill the rows of `places` beyond the vertices with the means of the vertices they join."""
    column = cell.vertices
    for parents in cell.parents():
        nodes = cells[:, column : column + len(parents)]
        places[nodes] = places[cells[:, parents]].mean(axis=2)
        column += len(parents)


def shape_positions(
    shape: Shape, ticks: Sequence[Array], vertices: Array, nnode: int, cells: Index, cell: Cell
) -> Array:
    """Node positions (nnode, dim) on a shape: vertices at the ticks, others in logical middles."""
    logical = np.empty((nnode, cell.dim))
    rounded = shape.logical(vertices)
    for axis, line in enumerate(ticks):
        # exact ticks in place of the inverse map's rounding
        between = (line[1:] + line[:-1]) / 2
        logical[: len(vertices), axis] = line[np.searchsorted(between, rounded[:, axis])]
    if nnode > len(vertices):
        add_middles(logical, cells, cell)
    return shape.physical(logical)


def straight_positions(vertices: Array, nnode: int, cells: Index, cell: Cell) -> Array:
    """Node positions (nnode, dim) on cells with straight edges."""
    places = np.empty((nnode, cell.dim))
    places[: len(vertices)] = vertices
    if nnode > len(vertices):
        add_middles(places, cells, cell)
    return places


def curved_points(dm: PETSc.DMPlex, raw: RawMesh) -> Array:
    """Positions (npoints, dim) of the second-order nodes of an undistributed mesh, else NaN."""
    cell = raw.cell
    if not np.array_equal(dm.getCoordinatesLocal().array.reshape(-1, cell.dim), raw.points):
        raise RuntimeError("DMPlex numbers vertices in another order than the file")
    places = np.full((dm.getChart()[1], cell.dim), np.nan)
    points, _ = connectivity(dm, cell, 2)
    first_vertex = dm.getDepthStratum(0)[0]
    column = cell.vertices
    for parents, (table, values) in zip(cell.parents(), raw.middle, strict=True):
        keys = face_keys(points[:, parents].reshape(-1, parents.shape[1]) - first_vertex)
        nodes = points[:, column : column + len(parents)].ravel()
        places[nodes] = values[match_rows(table, keys)]
        column += len(parents)
    return places
