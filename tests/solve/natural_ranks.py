"""Run under mpirun: exchange rows, print on rank 0 what all ranks could check.

Arguments: counts of rows.
"""

import sys

import numpy as np
from mpi4py import MPI

from porolub.solve.natural import bounds, from_blocks, sorted_rows, to_blocks


def row(numbers, shape, kind):
    """A row for each number that tells it from all others."""
    width = int(np.prod(shape))
    flat = 1000 * np.asarray(numbers)[:, None] + np.arange(width)
    return flat.reshape(-1, *shape).astype(kind)


def main(count: int) -> None:
    comm = MPI.COMM_WORLD
    share = np.random.default_rng(1).integers(comm.size, size=count)  # the same on all ranks
    order = np.random.default_rng(2).permutation(count)
    mine = order[share[order] == comm.rank]
    first, last = bounds(count, comm.size)[comm.rank : comm.rank + 2]
    for shape, kind in (((), "f8"), ((3,), "f8"), ((2, 4), "f4"), ((5,), "i8")):
        block = to_blocks(comm, mine, row(mine, shape, kind), count)
        assert block.dtype == kind
        np.testing.assert_array_equal(block, row(np.arange(first, last), shape, kind))
        wanted = np.random.default_rng(comm.rank).integers(max(count, 1), size=min(count, 7) * 3)
        found = from_blocks(comm, block, count, wanted)
        np.testing.assert_array_equal(found, row(wanted, shape, kind))
    few = mine[mine % 3 == 0]
    numbers, rows = sorted_rows(comm, few, row(few, (2,), "f8"), count)
    np.testing.assert_array_equal(np.concatenate(comm.allgather(numbers)), np.arange(0, count, 3))
    np.testing.assert_array_equal(rows, row(numbers, (2,), "f8"))
    assert ((numbers >= first) & (numbers < last)).all()
    block = to_blocks(comm, few, row(few, (2,), "f8") + 1.0, count)
    here = np.arange(first, last)
    expected = np.where(here[:, None] % 3 == 0, row(here, (2,), "f8") + 1.0, 0.0)
    np.testing.assert_array_equal(block, expected)
    if comm.allreduce(1) == comm.size and comm.rank == 0:
        print(f"{comm.size} ranks agree on {count} rows")


if __name__ == "__main__":
    for argument in sys.argv[1:]:
        main(int(argument))
