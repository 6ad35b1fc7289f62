"""Stopped on two ranks, resumed on one and on four: the partition leaves no trace."""

import json
import shutil
from pathlib import Path

import pytest

from porolub.run_transient import restart
from tests.run.program import PICTURELESS, RUN
from tests.run.transient import CASE2, KINKS, options, run, same_frames, same_history, small

ONE_RANK_IS_SIGNALLED = """
import signal
from mpi4py import MPI
from porolub.cli import main
from tests.run.transient import ITERATION, signalled

if MPI.COMM_WORLD.rank == 1:
    with signalled(ITERATION, 40, signal.SIGTERM):
        main()
main()
"""


@pytest.mark.mpi
def test_the_steps_do_not_depend_on_where_a_run_goes_on(
    run_mpi, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("porolub.io.plots.plot_directory", lambda directory: [])
    expected = run(tmp_path / "expected", small(KINKS))
    said = run_mpi(2, ONE_RANK_IS_SIGNALLED, "run", CASE2, *options(KINKS), "--out", "two",
                   "--quiet", code=130)
    assert said.count("porolub: ") == 1
    assert "porolub: Interrupted by SIGTERM at t = " in said
    assert "porolub restart two goes on from there." in said
    summary = json.loads((tmp_path / "two" / "summary.json").read_text())
    assert (summary["status"], summary["ranks"]) == ("interrupted", 2)
    assert 0.0 < summary["time"] < 0.06
    shutil.copytree(tmp_path / "two", tmp_path / "one")
    restart(tmp_path / "one", quiet=True)
    shutil.copytree(tmp_path / "two", tmp_path / "four")
    run_mpi(4, PICTURELESS, "restart", "four", "--quiet")
    for directory, ranks in (("one", 1), ("four", 4)):
        same_history(expected.directory, tmp_path / directory)
        same_frames(expected.directory, tmp_path / directory)
        summary = json.loads((tmp_path / directory / "summary.json").read_text())
        assert (summary["status"], summary["ranks"]) == ("converged", ranks)


@pytest.mark.mpi
def test_ranks_refuse_together(run_mpi, tmp_path: Path) -> None:
    """Rank 0 alone sees the files; the others must not wait for it."""
    said = run_mpi(2, RUN, "restart", "nowhere", code=2, timeout=30)
    assert said.count("there is no checkpoint here.") == 1


@pytest.mark.mpi
@pytest.mark.slow
def test_a_damaged_history_stops_all_ranks(run_mpi, tmp_path: Path) -> None:
    run(tmp_path / "here", small("time.end=1 ms"))
    (tmp_path / "here" / "history.csv").write_text("no,history\n1,2\n")
    said = run_mpi(2, RUN, "restart", "here", "--set", "time.end=2 ms", code=2, timeout=30)
    assert said.count("history.csv: this file is damaged or was not written by porolub.") == 1
