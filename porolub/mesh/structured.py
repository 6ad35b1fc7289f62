"""Structured meshes of the shapes: each rank makes its own columns, and nothing else.

Numbers of nodes and cells follow from their place in the grid, so no rank ever holds the whole
mesh and the ranks need not talk.
"""

from collections.abc import Sequence

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.mesh import lattice
from porolub.mesh.cell import HEX, QUAD, TRIANGLE, Cell
from porolub.mesh.columns import Columns
from porolub.mesh.mesh import Boundary, Facets, Mesh, with_middles
from porolub.mesh.raw import signed_sizes
from porolub.mesh.shape import Shape

Array = NDArray[np.float64]
Index = NDArray[np.int64]

RING = ((0, 0), (1, 0), (1, 1), (0, 1))
CORNERS = {2: RING, 3: (*((*at, 0) for at in RING), *((*at, 1) for at in RING))}
"""Vertices of a quad and a hexahedron from its lowest one, in the order of VTK."""


def structured(
    shape: Shape,
    ticks: Sequence[Array],
    comm: MPI.Intracomm,
    degree: int,
    *,
    triangles: bool = False,
) -> Mesh:
    """The shape's mesh with vertices at the logical `ticks` of each axis.

    Cells are numbered with `along` slowest; triangles halve quads, two by two. The nodes are
    those of the tensor grid in the order of porolub.mesh.lattice.
    """
    counts = tuple(len(line) - 1 for line in ticks)
    columns = Columns(counts, comm.size)
    start, end = columns.box(comm.rank)
    empty = bool((start == end).any())
    low, high = (2 * start, 2 * start - 1) if empty else (2 * start, 2 * end)
    index = lattice.nodes(low.tolist(), high.tolist(), degree)
    fine = [with_middles(line, 2) for line in ticks]
    logical = np.stack([line[index[:, k]] for k, line in enumerate(fine)], axis=1)
    coordinates = shape.physical(logical)
    nvertices = int((index % 2 == 0).all(axis=1).sum())

    corners, natural_cell = _cells(start, end, counts, triangles)
    cell = TRIANGLE if triangles else (QUAD if shape.dim == 2 else HEX)
    vertices = lattice.numbers(corners, low, high)
    turned = signed_sizes(cell, coordinates, vertices) < 0
    corners[turned] = corners[turned][:, list(cell.mirror)]
    places = _with_middles(cell, corners, degree)
    cells = lattice.numbers(places, low, high)

    owner = columns.owners(index)
    box = columns.owned(owner)
    return Mesh(
        comm=comm,
        degree=degree,
        cell=cell,
        cells=cells,
        nvertices=nvertices,
        coordinates=coordinates,
        owned=owner == comm.rank,
        global_node=columns.starts(degree)[owner] + lattice.numbers(index, *box),
        natural_node=lattice.numbers(index, np.zeros_like(start), 2 * np.array(counts)),
        natural_cell=natural_cell,
        boundaries=_boundaries(shape, counts, cell, cells, index, degree),
        shape=shape,
        vertex_ticks=tuple(ticks),
        fine_index=index,
    )


def _cells(
    start: Index, end: Index, counts: tuple[int, ...], triangles: bool
) -> tuple[Index, Index]:
    """Fine indices (ncell, vertices, dim) of the vertices of a box of cells; natural numbers."""
    at = np.meshgrid(*(np.arange(a, b) for a, b in zip(start, end, strict=True)), indexing="ij")
    lowest = np.stack([axis.ravel() for axis in at], axis=1)
    corners = 2 * (lowest[:, None] + np.array(CORNERS[len(counts)]))
    natural = np.zeros(len(lowest), dtype=np.int64)
    for axis, many in zip(lowest.T, counts, strict=True):
        natural = natural * many + axis
    if not triangles:
        return corners, natural
    odd = (lowest.sum(axis=1) % 2).astype(bool)[:, None, None]  # diagonals like a chessboard
    halves = [
        np.where(odd, corners[:, list(turned)], corners[:, list(straight)])
        for turned, straight in (((0, 1, 3), (0, 1, 2)), ((1, 2, 3), (0, 2, 3)))
    ]
    natural = (2 * natural[:, None] + np.arange(2)).ravel()
    return np.stack(halves, axis=1).reshape(-1, 3, 2), natural


def _with_middles(cell: Cell, corners: Index, degree: int) -> Index:
    """Fine indices (ncell, nodes per cell, dim): vertices and, for degree 2, what is between."""
    if degree == 1:
        return corners
    between = [
        corners[:, parents].sum(axis=2) // parents.shape[1] for parents in cell.parents()
    ]
    return np.concatenate([corners, *between], axis=1)


def _boundaries(
    shape: Shape, counts: tuple[int, ...], cell: Cell, cells: Index, index: Index, degree: int
) -> dict[str, Boundary]:
    """The sides of the shape: along = 0, 1; across = 0, 1; deep = 0, 1."""
    ends = [(axis, side) for axis, many in enumerate(counts) for side in (0, 2 * many)]
    of_faces = cell.face_nodes(degree)
    found = {}
    for name, (axis, side) in zip(shape.boundaries, ends, strict=True):
        on_side = index[:, axis] == side
        near = np.flatnonzero(on_side[cells].any(axis=1))
        row, local = np.nonzero(on_side[cells[near][:, of_faces]].all(axis=2))
        facets = Facets(near[row], local, cells[near[row][:, None], of_faces[local]])
        found[name] = Boundary(facets, np.flatnonzero(on_side))
    return found
