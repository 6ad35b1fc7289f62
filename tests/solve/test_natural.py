"""Rows in natural order: blocks, wishes, and rows that not every number has."""

from pathlib import Path

import numpy as np
import pytest

from porolub.solve.natural import bounds

SCRIPT = Path(__file__).with_name("natural_ranks.py")


@pytest.mark.parametrize(("count", "size"), [(10, 4), (3, 5), (0, 2), (7, 1), (10**12, 3)])
def test_blocks_cover_all_numbers_and_differ_by_one_at_most(count, size):
    first = bounds(count, size)
    assert first[0] == 0
    assert first[-1] == count
    assert np.ptp(np.diff(first)) <= 1


@pytest.mark.mpi
@pytest.mark.parametrize("ranks", [1, 2, 4])
def test_every_row_gets_where_it_belongs(run_mpi, ranks):
    counts = (0, 2, 1000)
    said = run_mpi(ranks, SCRIPT, *counts)
    assert said.splitlines() == [f"{ranks} ranks agree on {count} rows" for count in counts]
