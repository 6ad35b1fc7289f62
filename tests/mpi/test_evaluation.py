"""Residual and Jacobian of whole systems do not depend on the number of ranks."""

from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from tests.mpi.evaluate_ranks import SCENES, all_scenes

SCRIPT = Path(__file__).with_name("evaluate_ranks.py")
AGREES = 1e-12  # relative to the largest entry of the field: sums in another order


@pytest.fixture(scope="module")
def serial():
    return all_scenes(MPI.COMM_SELF)


@pytest.mark.mpi
@pytest.mark.parametrize("ranks", [1, 2, 4])
def test_same_residual_and_jacobian_on_any_number_of_ranks(run_mpi, tmp_path, serial, ranks):
    output = tmp_path / "found.npz"
    run_mpi(ranks, SCRIPT, output, timeout=60)
    found = dict(np.load(output))
    assert found.keys() == serial.keys()
    for name, expected in serial.items():
        size = np.abs(expected).max()
        np.testing.assert_allclose(found[name], expected, rtol=0, atol=AGREES * size, err_msg=name)


def test_the_compared_numbers_are_not_trivial(serial):
    assert {name.split(":")[0] for name in serial} == set(SCENES)
    for name, values in serial.items():
        assert np.isfinite(values).all(), name
        assert np.abs(values).max() > 1e-6, name
