"""Run by mpirun: matrices put together from random shares equal the sum of their entries."""

from types import SimpleNamespace

import numpy as np
from mpi4py import MPI
from scipy.sparse import coo_array

from porolub.fem.shared import SharedRows


def share(
    comm: MPI.Intracomm, rng: np.random.Generator, owned: int, ghosts: int
) -> SimpleNamespace:
    """Dofs of which a rank owns `owned` and sees up to `ghosts` of others, in random places."""
    size = comm.allreduce(owned)
    first = comm.exscan(owned) or 0
    others = np.setdiff1d(np.arange(size), np.arange(first, first + owned))
    others = rng.permutation(others)[:ghosts]
    is_owned = rng.permutation(np.arange(owned + len(others)) < owned)
    numbers = np.empty(len(is_owned), np.int32)
    numbers[is_owned] = np.arange(first, first + owned)
    numbers[~is_owned] = others
    return SimpleNamespace(mesh=SimpleNamespace(comm=comm), owned=is_owned, count_owned=owned,
                           size=size, size_local=len(is_owned), global_numbers=numbers)


def main() -> None:
    comm = MPI.COMM_WORLD
    for case in range(12):
        rng = np.random.default_rng([case, comm.rank])
        owned = int(rng.integers(0 if case else 3, 9))
        dofs = share(comm, rng, owned, int(rng.integers(0, 7)))
        if dofs.size == 0:
            continue
        n = dofs.size_local
        pattern = coo_array(rng.random((n, n)) < rng.random()).tocsr()
        pattern.sort_indices()
        shared = SharedRows(dofs, pattern.indptr.astype(np.int32), pattern.indices.astype(np.int32))
        matrix = shared.create()
        rows = dofs.global_numbers[pattern.tocoo().row]
        columns = dofs.global_numbers[pattern.indices]
        for _ in range(2):  # the second set replaces the first
            values = rng.standard_normal(pattern.nnz)
            state = matrix.stateGet()
            shared.insert(matrix, np.append(values, 0.0))
            assert matrix.stateGet() > state, "solvers would not notice"
            full = np.zeros((dofs.size, dofs.size))
            np.add.at(full, (rows, columns), values)
            full = comm.allreduce(full)
            start, end = matrix.getOwnershipRange()
            if end > start:
                found = matrix.getValues(range(start, end), range(dofs.size))
                np.testing.assert_allclose(found, full[start:end], atol=1e-14)
        there = np.zeros(full.shape, bool)
        there[rows, columns] = True
        nonzeros = matrix.getInfo(matrix.InfoType.GLOBAL_SUM)["nz_used"]
        assert nonzeros == (comm.allreduce(there.astype(int)) > 0).sum(), "larger than its entries"
        matrix.destroy()
    if comm.rank == 0:
        print("all shares fit", flush=True)


main()
