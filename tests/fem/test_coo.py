"""Matrix insertion by coordinates equals adding the entries one by one."""

import numpy as np
import pytest
from petsc4py import PETSc

from porolub.fem import coo

SIZE, COUNT = 7, 60


@pytest.fixture
def entries():
    rng = np.random.default_rng(0)
    rows, cols = rng.integers(-1, SIZE, (2, COUNT)).astype(np.int32)  # repeated, and -1: ignored
    rows[:SIZE] = cols[:SIZE] = np.arange(SIZE)
    return rows, cols, rng.standard_normal((2, COUNT))


@pytest.fixture
def matrix():
    mat = PETSc.Mat().create(comm=PETSc.COMM_SELF)
    mat.setSizes((SIZE, SIZE))
    mat.setType("aij")
    mat.setUp()
    yield mat
    mat.destroy()


def dense(rows, cols, values):
    full = np.zeros((SIZE, SIZE))
    kept = (rows >= 0) & (cols >= 0)
    np.add.at(full, (rows[kept], cols[kept]), values[kept])
    return full


def test_insertion_is_the_sum_of_its_entries(entries, matrix):
    rows, cols, (first, second) = entries
    assert (np.minimum(rows, cols) < 0).any()
    coo.preallocate(matrix, rows.copy(), cols.copy())  # PETSc sorts them in place
    for values in (first, second):  # the second set replaces the first
        coo.insert(matrix, values)
        np.testing.assert_allclose(matrix[:, :], dense(rows, cols, values), atol=1e-14)


def test_the_pattern_is_not_larger_than_its_entries(entries, matrix):
    rows, cols, (values, _) = entries
    coo.preallocate(matrix, rows.copy(), cols.copy())
    coo.insert(matrix, values)
    kept = (rows >= 0) & (cols >= 0)
    distinct = set(zip(rows[kept].tolist(), cols[kept].tolist(), strict=True))
    assert matrix.getInfo()["nz_used"] == len(distinct)
