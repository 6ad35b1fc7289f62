"""A parallel matrix is the sum of the ranks' shares, no larger than what they declare."""

from pathlib import Path

import numpy as np
import pytest
from petsc4py import PETSc

from porolub.fem import coo

SCRIPT = Path(__file__).with_name("shared_ranks.py")


@pytest.mark.mpi
@pytest.mark.parametrize("ranks", [2, 3])
def test_a_matrix_is_the_sum_of_its_shares(run_mpi, ranks):
    assert "all shares fit" in run_mpi(ranks, SCRIPT)


def test_values_are_written_where_a_sequential_matrix_keeps_them():
    indptr, indices = np.array([0, 2, 3], np.int32), np.array([0, 1, 1], np.int32)
    mat = PETSc.Mat().createAIJ((2, 2), csr=(indptr, indices, np.zeros(3)), comm=PETSc.COMM_SELF)
    state = mat.stateGet()
    with coo.values_of(mat, 3) as values:
        values[:] = [1.0, 2.0, 3.0]
    assert mat.stateGet() > state
    np.testing.assert_array_equal(mat[:, :], [[1.0, 2.0], [0.0, 3.0]])
    mat.destroy()
