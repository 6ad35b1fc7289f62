"""Nonzero pattern of a rank's share of the matrix, and the way of values into PETSc."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.sparse import coo_array

from porolub.fem import coo, kernels
from porolub.fem.dofs import Dofs

Array = NDArray[np.float64]
Ints = NDArray[np.int32]


class Pattern:
    """Union of entity blocks as CSR (indptr, indices) over local dofs, columns sorted.

    Serially it is the matrix itself and values are summed in place; in parallel the rank's
    sums are handed to PETSc entry by entry (COO), which adds what belongs to other ranks.
    """

    def __init__(self, dofs: Dofs, blocks: list[tuple[Ints, Ints, int]],
                 fixed: NDArray[np.int64]) -> None:
        """Blocks are spanned by rows (ne, nr), columns (ne, nc) and a number of components.

        -1: a dof is absent.  A column is a node's first component, the others follow.  The rows
        of the ``fixed`` dofs are diagonal, and their columns are zero elsewhere.
        """
        self._dofs = dofs
        diagonal = fixed[dofs.owned[fixed]].astype(np.int32)
        rows, cols = [diagonal], [diagonal]
        for i, j, components in blocks:
            shape = (*i.shape, j.shape[1])
            row, col = np.broadcast_to(i[:, :, None], shape), np.broadcast_to(j[:, None], shape)
            present = (row >= 0) & (col >= 0)
            for k in range(components):
                rows.append(row[present])
                cols.append(col[present] + np.int32(k))
        row, col = np.concatenate(rows), np.concatenate(cols)
        size = dofs.size_local
        csr = coo_array((np.ones(len(row), np.int8), (row, col)), shape=(size, size)).tocsr()
        csr.sort_indices()
        self.indptr = csr.indptr.astype(np.int32)
        self.indices = csr.indices.astype(np.int32)
        is_fixed = np.zeros(size, bool)
        is_fixed[fixed] = True
        self._zero = np.flatnonzero(is_fixed[self.indices])
        self._one = self.slots(diagonal[:, None], diagonal[:, None]).ravel()

    def slots(self, rows: Ints, cols: Ints) -> Ints:
        """(ne, nr, nc) places of a block's entries in the values of the pattern, -1: none."""
        return kernels.slots(np.ascontiguousarray(rows, np.int32),
                             np.ascontiguousarray(cols, np.int32), self.indptr, self.indices)

    def _fix(self, values: Array) -> None:
        """Identity rows and zero columns for fixed dofs."""
        values[self._zero] = 0.0
        values[self._one] = 1.0

    @property
    def _serial(self) -> bool:
        return self._dofs.mesh.comm.size == 1

    def create(self) -> PETSc.Mat:
        """A matrix with this pattern."""
        d = self._dofs
        mat = PETSc.Mat().create(comm=d.mesh.comm)
        mat.setSizes(((d.count_owned, d.size), (d.count_owned, d.size)))
        mat.setType("aij")
        if self._serial:
            mat.setPreallocationCSR((self.indptr, self.indices, np.zeros(len(self.indices))))
        else:
            mat.setUp()
            rows = np.repeat(d.global_numbers, np.diff(self.indptr))
            coo.preallocate(mat, rows, d.global_numbers[self.indices])
        return mat

    @contextmanager
    def values(self, mat: PETSc.Mat) -> Iterator[Array]:
        """Zeroed values in the order of the pattern; what is added to them gets into ``mat``."""
        if self._serial:
            with coo.values_of(mat, len(self.indices)) as values:
                values[...] = 0.0
                yield values
                self._fix(values)
        else:
            values = np.zeros(len(self.indices))
            yield values
            self._fix(values)
            coo.insert(mat, values)
