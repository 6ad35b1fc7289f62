"""DMPlex: the topology of a mesh from a file, spread over the ranks, and data that goes with it.

Points are PETSc's numbers of cells, faces, edges and vertices on a rank.
"""

import ctypes
from collections.abc import Sequence

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.mesh.cell import Cell
from porolub.mesh.library import check, petsc_library
from porolub.mesh.raw import RawMesh

Index = NDArray[np.int64]
LABEL = "Face Sets"
VERTICES = {
    "quad": (0, 1, 2, 3),
    "triangle": (0, 1, 2),
    "hex": (0, 3, 2, 1, 4, 5, 6, 7),
    "tet": (1, 0, 2, 3),
}
"""Our vertices in PETSc's order: its hexahedra and tetrahedra have a bottom that runs clockwise."""


def from_cells(raw: RawMesh | None, cell: Cell, comm: MPI.Intracomm) -> PETSc.DMPlex:
    """The DMPlex of the mesh `raw` with its edges and faces, all of it on rank 0. Collective.

    Cells and vertices keep their order. The cells must have passed raw.check_boundaries: an
    error of PETSc on rank 0 alone would leave the others waiting.
    """
    cells = np.zeros((0, cell.vertices)) if raw is None else raw.cells[:, VERTICES[cell.name]]
    points = np.zeros((0, cell.dim)) if raw is None else raw.points
    return PETSc.DMPlex().createFromCellList(
        cell.dim, cells.astype(PETSc.IntType), points, interpolate=True, comm=comm
    )


def cones(dm: PETSc.DMPlex, cell: Cell) -> list[Index]:
    """Points (n, k) that bound each point of dimension 1, 2, ...: of edges, (faces,) cells."""
    strata = [dm.getDepthStratum(depth) for depth in range(1, cell.dim + 1)]
    sizes = [2, *([len(cell.faces[0])] if cell.dim == 3 else []), len(cell.faces)]
    total = sum((last - first) * k for (first, last), k in zip(strata, sizes, strict=True))
    start = ctypes.POINTER(np.ctypeslib.as_ctypes_type(PETSc.IntType))()
    check(petsc_library().DMPlexGetCones(ctypes.c_void_p(dm.handle), ctypes.byref(start)))
    flat = np.ctypeslib.as_array(start, (total,)) if total else np.zeros(0, PETSc.IntType)
    found, at = [np.zeros((0, k), dtype=np.int64) for k in sizes], 0
    for depth in sorted(range(cell.dim), key=lambda depth: strata[depth][0]):  # as points follow
        (first, last), k = strata[depth], sizes[depth]
        found[depth] = flat[at : at + (last - first) * k].reshape(-1, k).astype(np.int64)
        at += (last - first) * k
    return found


def mark(dm: PETSc.DMPlex, sets: Sequence[Index]) -> None:
    """Label the faces of each of `sets` with its number, from 1 on; the label is distributed."""
    dm.createLabel(LABEL)
    label = dm.getLabel(LABEL)
    for value, points in enumerate(sets, start=1):
        where = PETSc.IS().createGeneral(np.sort(points).astype(PETSc.IntType), PETSc.COMM_SELF)
        label.setStratumIS(value, where)
        where.destroy()
    label.destroy()


def marks(dm: PETSc.DMPlex, sets: int) -> Index:
    """Number (npoints,) of the set each local point belongs to, 0 if to none."""
    values = np.zeros(dm.getChart()[1], dtype=np.int64)
    for value in range(1, sets + 1):
        where = dm.getStratumIS(LABEL, value)
        if where:
            values[where.getIndices()] = value
            where.destroy()
    return values


def distribute(dm: PETSc.DMPlex, part: Index) -> PETSc.SF | None:
    """Give each cell to the rank that `part` (ncell,) of rank 0 says; no overlap. Collective.

    Returns the star forest from the points of rank 0 before to each rank's points after; None
    on one rank.
    """
    comm = dm.comm.tompi4py()
    if comm.size == 1:
        return None
    sizes = np.bincount(part, minlength=comm.size).astype(PETSc.IntType)
    tool = dm.getPartitioner()
    tool.setType(PETSc.Partitioner.Type.SHELL)
    tool.setShellPartition(comm.size, sizes, np.argsort(part, kind="stable").astype(sizes.dtype))
    tool.destroy()
    return dm.distribute(overlap=0)


def from_original(sf: PETSc.SF | None, original: NDArray, npoints: int) -> NDArray:
    """Values (npoints, ...) at each rank's points from those at the points of rank 0 before.

    original: (points before, ...) on rank 0, no rows elsewhere, of float64 or int64
    """
    if sf is None:
        return original
    width = int(np.prod(original.shape[1:], dtype=int))
    scalar = MPI.DOUBLE if original.dtype == np.float64 else MPI.INT64_T
    unit = scalar.Create_contiguous(width).Commit()
    local = np.zeros((npoints, *original.shape[1:]), dtype=original.dtype)
    sf.bcastBegin(unit, original, local, MPI.REPLACE)
    sf.bcastEnd(unit, original, local, MPI.REPLACE)
    unit.Free()
    return local


def owned(dm: PETSc.DMPlex) -> NDArray[np.bool_]:
    """True (npoints,) for the points that no other rank owns."""
    own = np.ones(dm.getChart()[1], dtype=bool)
    if dm.comm.size > 1:
        _, leaves, remote = dm.getPointSF().getGraph()
        own[np.arange(len(remote)) if leaves is None else leaves] = False  # None: 0, 1, 2, ...
    return own


def from_owners(dm: PETSc.DMPlex, values: Index) -> Index:
    """Values per local point, with those of points of other ranks taken from there."""
    if dm.comm.size == 1:
        return values
    sf, result = dm.getPointSF(), values.copy()
    sf.bcastBegin(MPI.INT64_T, values, result, MPI.REPLACE)
    sf.bcastEnd(MPI.INT64_T, values, result, MPI.REPLACE)
    return result


def largest_of_all(dm: PETSc.DMPlex, values: Index) -> Index:
    """Values per local point, each the maximum over the ranks that hold the point."""
    if dm.comm.size == 1:
        return values
    sf, largest = dm.getPointSF(), values.copy()
    sf.reduceBegin(MPI.INT64_T, values, largest, MPI.MAX)
    sf.reduceEnd(MPI.INT64_T, values, largest, MPI.MAX)
    return from_owners(dm, largest)
