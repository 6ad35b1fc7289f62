"""The table of a sweep is the same on any number of ranks."""

from pathlib import Path

import numpy as np
import pytest

from porolub.study.work.table import Table, read_table
from tests.study.drills import (
    PLOTS,
    computed,
    computed_once,
    no_remains,
    same_table,
    sweep,
    sweep_file,
)  # fmt: skip

RUN = """
import sys
from pathlib import Path
import porolub.study.sweep as module
from porolub.study.plan.sweep_file import load_sweep

module.plot_sweep = lambda directory: []
for out, ranks in zip(sys.argv[2::2], sys.argv[3::2]):
    sweep = load_sweep(sys.argv[1], [f"sweep.ranks_per_case={ranks}"])
    assert module.run_sweep(sweep, Path(out)) == 0
"""
"""Sweeps into directories, each with so many ranks a case."""
COUNTED = ("newton_iterations", "linear_iterations", "start")
ROUNDING = ("mass_balance_error", "load_balance_error")


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PLOTS, lambda directory: [])


def close(found: Table, expected: Table) -> None:
    """Assert that two tables agree but for what a factorisation on other ranks leaves."""
    assert found.names == expected.names
    assert set(found.columns["status"]) == {"converged"}
    flows = max(np.abs(expected.columns[n]).max() for n in expected.names if "flow_" in n)
    for name in expected.names:
        one, other = expected.columns[name], found.columns[name]
        if name.split(".")[0] in ("wall", "wall_time", "peak_memory", "ranks", *COUNTED):
            continue
        if name in ROUNDING:
            assert other.max() < 1e-8
        elif one.dtype == float:
            like = expected.columns[name.removeprefix("error_estimate.")]
            size = flows if "flow_" in name else np.nanmax(np.abs(like), initial=0.0)
            np.testing.assert_allclose(other, one, rtol=0, atol=1e-7 * size, err_msg=name)
        else:
            np.testing.assert_array_equal(other, one, err_msg=name)


@pytest.mark.mpi
def test_groups_of_any_number_and_size_compute_the_same(run_mpi, tmp_path: Path) -> None:
    file = sweep_file(tmp_path)
    expected = computed(file, tmp_path / "alone")
    run_mpi(2, RUN, file, "on 2", 1, timeout=100)
    said = run_mpi(3, RUN, file, "on 3", 1, "pair", 2, timeout=100)
    run_mpi(4, RUN, file, "pairs", 2, timeout=100)
    for out in ("on 2", "on 3"):
        same_table(read_table(tmp_path / out), expected)
    for out in ("pair", "pairs"):
        close(read_table(tmp_path / out), expected)
        assert set(read_table(tmp_path / out).columns["ranks"]) == {2}
    idle = "1 of 3 ranks have nothing to do: sweep.ranks_per_case = 2"
    assert said.splitlines().count(idle) == 1
    for out in ("on 2", "on 3", "pair", "pairs"):
        computed_once(tmp_path / out)
        no_remains(tmp_path / out)


def test_a_case_needs_its_ranks(tmp_path: Path) -> None:
    result = sweep(sweep_file(tmp_path, ranks_per_case=2), tmp_path / "here")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == (
        "porolub: sweep.ranks_per_case = 2: there are only 1 ranks; run the sweep under mpirun "
        "-n 2 or more.\n"
    )  # fmt: skip
    assert not (tmp_path / "here").exists()
