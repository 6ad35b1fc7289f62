"""Rows in natural order, shared out in contiguous blocks: what files hold, whatever the partition.

Rank k holds the rows of the natural numbers ``bounds(count, size)[k]`` up to the next bound.  Each
function is one exchange (two with wishes to tell) of O(N/P) rows a rank; all are collective.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Rows = NDArray[Any]
Index = NDArray[np.int64]


def bounds(count: int, size: int) -> Index:
    """First number of each of ``size`` blocks of 0 ... count - 1, and count: (size + 1,)."""
    return np.arange(size + 1, dtype=np.int64) * count // size


def to_blocks(comm: Any, numbers: Index, rows: Rows, count: int) -> Rows:
    """This rank's block of rows, from the rows (k, ...) with these numbers that each rank has.

    Numbers lie in 0 ... count - 1; those no rank gives leave zeros, those given more than once
    must come with the same row.
    """
    first = bounds(count, comm.size)
    found, given = _to_their_blocks(comm, numbers, rows, first)
    block = np.zeros((first[comm.rank + 1] - first[comm.rank], *rows.shape[1:]), rows.dtype)
    block[found - first[comm.rank]] = given
    return block


def sorted_rows(comm: Any, numbers: Index, rows: Rows, count: int) -> tuple[Index, Rows]:
    """As ``to_blocks`` where not every number has a row: the numbers in this rank's block that
    have one, ascending, and their rows.  Each number is given by one rank only."""
    found, given = _to_their_blocks(comm, numbers, rows, bounds(count, comm.size))
    order = np.argsort(found)
    return found[order], given[order]


def from_blocks(comm: Any, block: Rows, count: int, wanted: Index) -> Rows:
    """The rows (k, ...) of the wanted numbers (k,), repeated ones too, from all ranks' blocks."""
    first = bounds(count, comm.size)
    wanted = np.asarray(wanted, dtype=np.int64)
    owner = np.searchsorted(first, wanted, side="right") - 1
    order = np.argsort(owner, kind="stable")
    asked = np.bincount(owner, minlength=comm.size)
    told = _alltoall(comm, asked)
    questions = _exchange(comm, wanted[order], asked, told)
    answers = _exchange(comm, block[questions - first[comm.rank]], told, asked)
    rows = np.empty((len(wanted), *block.shape[1:]), block.dtype)
    rows[order] = answers
    return rows


def _to_their_blocks(comm: Any, numbers: Index, rows: Rows, first: Index) -> tuple[Index, Rows]:
    """Numbers and rows on the ranks whose blocks they belong to."""
    numbers = np.asarray(numbers, dtype=np.int64)
    owner = np.searchsorted(first, numbers, side="right") - 1
    order = np.argsort(owner, kind="stable")
    sent = np.bincount(owner, minlength=comm.size)
    received = _alltoall(comm, sent)
    return (_exchange(comm, numbers[order], sent, received),
            _exchange(comm, rows[order], sent, received))


def _alltoall(comm: Any, counts: Index) -> Index:
    out = np.empty_like(counts)
    comm.Alltoall(counts, out)
    return out


def _exchange(comm: Any, rows: Rows, sent: Index, received: Index) -> Rows:
    """Rows in the order of the ranks they go to, for those that come, in the order of theirs."""
    from mpi4py import MPI  # who only asks for bounds starts no MPI

    rows = np.ascontiguousarray(rows)
    out = np.empty((int(received.sum()), *rows.shape[1:]), rows.dtype)
    width = int(np.prod(rows.shape[1:], dtype=np.int64)) * rows.dtype.itemsize
    row = MPI.BYTE.Create_contiguous(width).Commit()  # counts in rows stay far below 2^31
    comm.Alltoallv([rows, (sent, _starts(sent)), row],
                   [out, (received, _starts(received)), row])
    row.Free()
    return out


def _starts(counts: Index) -> Index:
    starts: Index = np.concatenate([[0], np.cumsum(counts)[:-1]])
    return starts
