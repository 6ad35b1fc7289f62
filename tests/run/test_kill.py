"""kill -9 at any moment leaves a checkpoint to go on from, to the same numbers."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from porolub.io.checkpoint import read_checkpoint
from porolub.run_transient import restart
from tests.run.output import JOBS, Output
from tests.run.transient import CASE2, no_remains, options, run, same_frames, same_history, small

KILLS_ITSELF = Path(__file__).with_name("kills_itself.py")


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> Output:
    return run(tmp_path_factory.mktemp("expected"), small())


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("porolub.io.plots.plot_directory", lambda directory: [])


def goes_on(directory: Path, expected: Output) -> None:
    reached = read_checkpoint(directory / "checkpoint.h5")[0].states[0].time
    assert 0.0 < reached < 0.06
    restart(directory, quiet=True)
    same_history(expected.directory, directory)
    same_frames(expected.directory, directory)
    no_remains(directory)


@pytest.mark.parametrize(
    ("where", "count"),
    [
        ("in a step", 30),
        ("in a row", 7),
        ("half written", 6),
        pytest.param("before it is there", 6, marks=pytest.mark.slow),
        pytest.param("once it is there", 6, marks=pytest.mark.slow),
    ],
)
def test_a_run_that_was_killed_goes_on(
    expected: Output, tmp_path: Path, where: str, count: int
) -> None:
    words = [where, str(count), "run", str(CASE2), *options(), "--out", "here", "--quiet"]
    done = subprocess.run(
        [sys.executable, str(KILLS_ITSELF), *words], cwd=tmp_path, timeout=60, check=False,
        env={**os.environ, "PYTHONPATH": str(JOBS.parent)})
    assert done.returncode == -signal.SIGKILL
    assert not (tmp_path / "here" / "summary.json").exists()
    goes_on(tmp_path / "here", expected)


@pytest.mark.mpi
def test_a_rank_that_is_killed_takes_the_others_along(
    run_mpi, expected: Output, tmp_path: Path
) -> None:
    words = ["in a step", 30, "run", CASE2, *options(), "--out", "here", "--quiet"]
    said = run_mpi(2, KILLS_ITSELF, *words, code=128 + signal.SIGKILL, timeout=60)
    assert "exited on signal 9" in said
    goes_on(tmp_path / "here", expected)
