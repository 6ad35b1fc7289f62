"""A parallel matrix from each rank's share of it: what goes where is found out once.

A rank's share has rows of its own and rows that other ranks own.  Its own go straight into the two
sequential matrices PETSc keeps of a rank's rows (columns of its own, columns of others); the rest,
those of the interface, are told to their owners, which add them.
"""

from __future__ import annotations

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.sparse import coo_array, csr_array

from porolub.fem import coo, kernels
from porolub.fem.dofs import Dofs

Array = NDArray[np.float64]
Ints = NDArray[np.int32]
Index = NDArray[np.int64]
MINE, TOLD = 1, 2  # who knows of an entry: this rank, others
AT_ONCE = 2**16  # entries: NumPy widens their numbers, in memory that should stay in the cache


class SharedRows:
    """How values in the order of a share's CSR pattern (local dofs) get into a matrix."""

    def __init__(self, dofs: Dofs, indptr: Ints, indices: Ints) -> None:
        """Collective."""
        self._dofs, self._comm = dofs, dofs.mesh.comm
        self.count = len(indices)
        lengths = np.diff(indptr)
        columns = dofs.global_numbers[indices]
        own = np.repeat(dofs.owned, lengths)
        other = np.flatnonzero(~own)
        rows = np.repeat(dofs.global_numbers[~dofs.owned], lengths[~dofs.owned])
        self._talk(rows, columns[other], other)
        ends = np.concatenate([[0], np.cumsum(lengths[dofs.owned])])
        entries = np.arange(self.count, dtype=np.int32)[own]
        union, source = self._union(ends, columns[own], entries)
        del own, columns, entries
        self.indptr, self.indices = union.indptr.astype(np.int32), union.indices.astype(np.int32)
        here = (self.indices >= self._first) & (self.indices < self._first + dofs.count_owned)
        self._sources = source[here], source[~here]
        place = kernels.slots(np.ascontiguousarray(self._rows[:, None]),
                              np.ascontiguousarray(self._columns[:, None]),
                              self.indptr, self.indices).ravel()
        before = np.cumsum(here, dtype=np.int32) - here  # entries in columns of our own before
        self._told_here = here[place]
        self._told_place = np.where(self._told_here, before[place], place - before[place])
        del self._rows, self._columns

    @property
    def _first(self) -> int:
        """Number of the first row this rank owns."""
        return int(self._starts[self._comm.rank])

    def _talk(self, rows: Ints, columns: Ints, entries: Index) -> None:
        """Tell the owners which entries of their rows are in this share."""
        counts = np.array(self._comm.allgather(self._dofs.count_owned))
        self._starts = np.concatenate([[0], np.cumsum(counts)])
        owner = np.searchsorted(self._starts, rows, side="right") - 1
        order = np.argsort(owner, kind="stable")
        self._sent = np.bincount(owner, minlength=self._comm.size)
        self._told = np.empty_like(self._sent)
        self._comm.Alltoall(self._sent, self._told)
        self._to_tell = entries[order]
        self._rows = self._exchange(rows[order], MPI.INT32_T) - np.int32(self._first)
        self._columns = self._exchange(columns[order], MPI.INT32_T)

    def _exchange(self, values: NDArray, kind: MPI.Datatype) -> NDArray:
        """Values in the order of the ranks they go to, for those that come."""
        out = np.empty(int(self._told.sum()), values.dtype)
        self._comm.Alltoallv([np.ascontiguousarray(values), self._sent, kind],
                             [out, self._told, kind])
        return out

    def _union(self, ends: Index, columns: Ints, entries: Ints) -> tuple[csr_array, Ints]:
        """Pattern of this rank's rows with global columns, and the entry of the share that goes
        to each place (``count``: none)."""
        shape = (self._dofs.count_owned, self._dofs.size)
        mine = csr_array((entries, columns, ends), shape=shape)
        mine.sort_indices()  # the entries with their columns
        entries, mine.data = mine.data, np.full(len(entries), MINE, np.int8)
        told = coo_array((np.ones(len(self._rows), bool), (self._rows, self._columns)),
                         shape=shape).tocsr()  # once each
        told.sort_indices()
        union = (mine + csr_array((np.full(told.nnz, TOLD, np.int8), told.indices, told.indptr),
                                  shape=shape)).tocsr()
        source = np.full(union.nnz, self.count, np.int32)
        source[union.data != TOLD] = entries
        return union, source

    def create(self) -> PETSc.Mat:
        """A matrix with the pattern of all shares together. Collective."""
        d = self._dofs
        sizes = ((d.count_owned, d.size), (d.count_owned, d.size))
        return PETSc.Mat().createAIJ(sizes, csr=(self.indptr, self.indices), comm=self._comm)

    def insert(self, mat: PETSc.Mat, values: Array) -> None:
        """Set all values (count + 1,), of which the last is zero. Collective."""
        given = self._exchange(values[self._to_tell], MPI.DOUBLE)
        ends = np.cumsum(self._told)
        with coo.values_of_rank(mat, *map(len, self._sources)) as parts:
            for source, part in zip(self._sources, parts, strict=True):
                for start in range(0, len(source), AT_ONCE):
                    some = slice(start, start + AT_ONCE)
                    np.take(values, source[some], out=part[some], mode="clip")
            for first, last in zip(ends - self._told, ends, strict=True):  # no place twice
                place, here = self._told_place[first:last], self._told_here[first:last]
                for part, chosen in zip(parts, (here, ~here), strict=True):
                    part[place[chosen]] += given[first:last][chosen]
