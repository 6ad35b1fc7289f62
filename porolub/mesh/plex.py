"""DMPlex: reading, distributing, and passing point data between ranks."""

from collections.abc import Sequence

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

Index = NDArray[np.int64]


def read(path: str, comm: MPI.Intracomm) -> PETSc.DMPlex:
    """The mesh of a .msh file, all of it on rank 0 (only rank 0 needs to see the file)."""
    dm = PETSc.DMPlex().createFromFile(path, comm=comm)
    dm.setBasicAdjacency(useCone=True, useClosure=True)
    return dm


def distribute(dm: PETSc.DMPlex, strips: bool) -> PETSc.SF | None:
    """Spread the cells over the ranks without overlap; None on one rank.

    With `strips` the cells go out in their order, in equal parts (structured meshes number
    them along the layer); otherwise PETSc's graph partitioner decides. Returns the star
    forest from the points of the undistributed mesh on rank 0 to each rank's points.
    """
    comm = dm.comm.tompi4py()
    if comm.size == 1:
        return None
    if strips:
        first, last = dm.getHeightStratum(0)
        parts = np.array_split(np.arange(first, last, dtype=PETSc.IntType), comm.size)
        sizes = np.array([len(part) for part in parts], dtype=PETSc.IntType)
        part = dm.getPartitioner()
        part.setType(PETSc.Partitioner.Type.SHELL)
        part.setShellPartition(comm.size, sizes, np.concatenate(parts))
    return dm.distribute(overlap=0)


def from_original(sf: PETSc.SF | None, original: NDArray, npoints: int) -> NDArray:
    """Values per point of the undistributed mesh, brought to each rank's points.

    original: (points of the undistributed mesh, ...) on rank 0, no rows elsewhere, of float64
    or int64; returns (npoints, ...).
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


def ghosts(dm: PETSc.DMPlex) -> Index:
    """Points of this rank that another rank owns."""
    if dm.comm.size == 1:
        return np.empty(0, dtype=np.int64)
    _, leaves, remote = dm.getPointSF().getGraph()
    if leaves is None:  # PETSc's shorthand for 0, 1, 2, ...
        leaves = np.arange(len(remote))
    return np.asarray(leaves, dtype=np.int64)


def from_owners(dm: PETSc.DMPlex, values: Index) -> Index:
    """Values per local point, with those of ghost points taken from their owners."""
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
    sf, owned = dm.getPointSF(), values.copy()
    sf.reduceBegin(MPI.INT64_T, values, owned, MPI.MAX)
    sf.reduceEnd(MPI.INT64_T, values, owned, MPI.MAX)
    return from_owners(dm, owned)


def closures(dm: PETSc.DMPlex, points: Sequence[int] | Index) -> Index:
    """Transitive closures (n, k) of points that all have the same shape."""
    rows = [dm.getTransitiveClosure(int(point))[0] for point in points]
    return np.array(rows, dtype=np.int64)


def label_points(dm: PETSc.DMPlex, label: str, value: int) -> Index:
    """Local points that carry `value` in `label`."""
    if not dm.hasLabel(label):
        return np.empty(0, dtype=np.int64)
    stratum = dm.getStratumIS(label, value)
    points = np.array(stratum.getIndices(), dtype=np.int64) if stratum else np.empty(0, np.int64)
    if stratum:
        stratum.destroy()
    return points
