"""Nonzero pattern of a rank's share of the matrix, and the way of values into PETSc."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.sparse import csr_array

from porolub.errors import SolveError
from porolub.fem import coo, kernels
from porolub.fem.dofs import Dofs
from porolub.fem.shared import SharedRows

Array = NDArray[np.float64]
Ints = NDArray[np.int32]


ROWS_AT_A_TIME = 4096


def _incidence(dofs: list[Ints], size: int) -> csr_array:
    """(entities, size) True where a dof belongs to an entity; dofs (ne, n) each, -1: none."""
    counts = np.concatenate([(d >= 0).sum(axis=1) for d in dofs])
    indptr = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    indices = np.concatenate([d[d >= 0] for d in dofs])
    return csr_array((np.ones(len(indices), bool), indices, indptr), shape=(len(counts), size))


def _union(blocks: list[tuple[Ints, Ints]], size: int) -> csr_array:
    """All pairs of a row and a column that an entity joins, once each, columns sorted.

    One product of incidences: no list of all entities' entries is ever made.
    """
    rows = _incidence([i for i, _ in blocks], size)
    pairs = (rows.T.tocsr() @ _incidence([j for _, j in blocks], size)).tocsr()
    pairs.sort_indices()
    return pairs


def _with_components(nodes: csr_array, width: Ints, single: NDArray[np.bool_]
                     ) -> tuple[Ints, Ints]:
    """indptr and indices with the first columns of nodes widened to all their components.

    The rows ``single`` stay as they are.
    """
    parts: list[Ints] = []
    ends = [np.zeros(1, np.int64)]
    for start in range(0, nodes.shape[0], ROWS_AT_A_TIME):  # few enough for the cache
        rows = nodes.indptr[start:start + ROWS_AT_A_TIME + 1]
        first = nodes.indices[rows[0]:rows[-1]]
        many = width[first]
        many[np.repeat(single[start:start + len(rows) - 1], np.diff(rows))] = 1
        end = np.concatenate([[0], np.cumsum(many)]).astype(np.int32)
        widened = np.repeat(first - end[:-1], many) + np.arange(end[-1])
        parts.append(widened.astype(np.int32))
        ends.append(ends[-1][-1] + end[rows[1:] - rows[0]].astype(np.int64))
    if ends[-1][-1] > np.iinfo(np.int32).max:
        raise SolveError("The matrix of one rank has more than 2^31 entries: use more ranks.")
    indices = np.concatenate(parts) if parts else np.zeros(0, np.int32)
    return np.concatenate(ends).astype(np.int32), indices


class Pattern:
    """Union of entity blocks as CSR (indptr, indices) over local dofs, columns sorted.

    Serially it is the matrix itself and values are summed in place; in parallel the rank's
    sums go to their rows, here and on other ranks (see porolub.fem.shared).
    """

    def __init__(self, dofs: Dofs, blocks: list[tuple[Ints, Ints, int]],
                 fixed: NDArray[np.int64]) -> None:
        """Blocks are spanned by rows (ne, nr), columns (ne, nc) and a number of components.

        -1: a dof is absent.  A column is a node's first component, the others follow.  The rows
        of the ``fixed`` dofs are diagonal, and their columns are zero elsewhere.
        """
        self._dofs = dofs
        diagonal = fixed[dofs.owned[fixed]].astype(np.int32)
        nodes = _union([*((i, j) for i, j, _ in blocks), (diagonal[:, None], diagonal[:, None])],
                       dofs.size_local)
        width = np.ones(dofs.size_local, np.int32)  # columns that follow from a node's first one
        for _, j, components in blocks:
            width[j[j >= 0]] = components
        is_fixed = np.zeros(dofs.size_local, bool)
        is_fixed[fixed] = True
        self.indptr, self.indices = _with_components(nodes, width, is_fixed)
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
        sizes = ((d.count_owned, d.size), (d.count_owned, d.size))
        if self._serial:  # the matrix uses the pattern's own arrays
            csr = self.indptr, self.indices, np.zeros(len(self.indices))
            return PETSc.Mat().createAIJWithArrays(sizes, csr, comm=d.mesh.comm)
        return self._shared.create()

    @cached_property
    def _shared(self) -> SharedRows:
        return SharedRows(self._dofs, self.indptr, self.indices)

    @cached_property
    def _share(self) -> Array:
        """This rank's values in a parallel matrix, and a zero behind them."""
        return np.zeros(len(self.indices) + 1)

    @contextmanager
    def values(self, mat: PETSc.Mat) -> Iterator[Array]:
        """Zeroed values in the order of the pattern; what is added to them gets into ``mat``."""
        if self._serial:
            with coo.values_of(mat, len(self.indices)) as values:
                values[...] = 0.0
                yield values
                self._fix(values)
        else:
            values = self._share  # kept: fresh memory costs more than what is computed into it
            values[...] = 0.0
            yield values[:-1]
            self._fix(values)
            self._shared.insert(mat, values)
