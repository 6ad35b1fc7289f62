"""Told to stop, by a user or a batch system: exit code 130, one sentence, files to go on from."""

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import meshio
import pytest
from mpi4py import MPI
from typer.testing import CliRunner

from porolub.cli import app
from porolub.errors import Interrupted
from porolub.interrupt import Interrupt
from porolub.io.summary import read_summary
from porolub.run_transient import restart
from tests.run.output import JOBS, Output
from tests.run.test_transient import FROM_REST
from tests.run.transient import CASE2, ITERATION, ROW, options, run, same_history, signalled, small

LONG_ENOUGH = "time.end=0.3 s"  # a second, so that a signal from outside comes in between
MPIRUN = ["mpirun", "-n", "2", "--bind-to", "none"]


@contextmanager
def started(*words: object, before: list[str], cwd: Path) -> Iterator["subprocess.Popen[str]"]:
    """The program as a process that goes on by itself."""
    process = subprocess.Popen(
        [*before, sys.executable, "-m", "porolub", *map(str, words)], cwd=cwd, text=True,
        env={**os.environ, "PYTHONPATH": str(JOBS.parent)}, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def wait_for(there: Callable[[], bool], process: "subprocess.Popen[str]") -> None:
    """Wait until the run has come so far."""
    deadline = time.monotonic() + 60.0
    while not there():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.005)


def has_steps(directory: Path) -> Callable[[], bool]:
    history = directory / "history.csv"
    return lambda: history.exists() and history.read_text().count("\n") > 5


def children_of(process: "subprocess.Popen[str]") -> list[int]:
    """The ranks of an mpirun on this machine."""
    stats = [entry / "stat" for entry in Path("/proc").iterdir() if entry.name.isdigit()]
    found = []
    for stat in stats:
        try:
            number, rest = stat.read_text().split(" ", 1)
        except OSError:  # a process that has ended meanwhile
            continue
        if int(rest.rsplit(")", 1)[1].split()[1]) == process.pid:
            found.append(int(number))
    return found


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """In this process, where nobody looks at them."""
    monkeypatch.setattr("porolub.io.plots.plot_directory", lambda directory: [])


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> Output:
    return run(tmp_path_factory.mktemp("expected"), small(LONG_ENOUGH))


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_a_run_in_good_order(
    expected: Output, tmp_path: Path, number: signal.Signals
) -> None:
    words = ["run", CASE2, *options(LONG_ENOUGH), "--out", "here"]
    with started(*words, before=[], cwd=tmp_path) as process:
        wait_for(has_steps(tmp_path / "here"), process)
        process.send_signal(number)
        printed, said = process.communicate(timeout=30)
    assert process.returncode == 130
    assert re.fullmatch(rf"porolub: Interrupted by {number.name} at t = [\d.e-]+ s; porolub "
                        r"restart here goes on from there\.\n", said)
    assert "Traceback" not in printed
    summary = read_summary(tmp_path / "here" / "summary.json")
    assert summary["status"] == "interrupted"
    assert meshio.read(tmp_path / "here" / "fields.xdmf").point_data["p"].any()
    restart(tmp_path / "here", quiet=True)
    same_history(expected.directory, tmp_path / "here")


@pytest.mark.mpi
@pytest.mark.slow
@pytest.mark.parametrize("whom", ["ranks", "mpirun"])
def test_a_batch_system_signals_all_ranks_or_mpirun(tmp_path: Path, whom: str) -> None:
    """mpirun passes the signal on, gives its ranks a second, and has an exit code of its own."""
    words = ["run", CASE2, *options("time.end=10 s"), "--out", "here", "--quiet"]
    with started(*words, before=MPIRUN, cwd=tmp_path) as process:
        wait_for(has_steps(tmp_path / "here"), process)
        for each in children_of(process) if whom == "ranks" else [process.pid]:
            os.kill(each, signal.SIGTERM)
        _, said = process.communicate(timeout=30)
    if whom == "ranks":
        assert process.returncode == 130
        assert said.count("porolub: Interrupted by SIGTERM at t = ") == 1
    assert process.returncode != 0
    reached = read_summary(tmp_path / "here" / "summary.json")["time"]
    end = f"time.end={reached + 0.01} s"
    restart(tmp_path / "here", [end], quiet=True)
    assert read_summary(tmp_path / "here" / "summary.json")["status"] == "converged"


def interrupted_at_the_start(directory: Path, *words: str) -> None:
    with signalled(ITERATION, 2, signal.SIGTERM):
        result = CliRunner().invoke(app, ["run", *words, "--out", str(directory), "--quiet"])
    assert (result.exit_code, result.stdout) == (130, "")
    assert result.stderr == "porolub: Interrupted by SIGTERM before there was a state to keep.\n"
    assert {path.name for path in directory.iterdir()} == {
        "log.txt", "petsc.options", "scene.resolved.toml"}


def test_before_the_first_state_there_is_nothing_to_keep(tmp_path: Path) -> None:
    interrupted_at_the_start(tmp_path / "steady", str(CASE2), *options())
    (tmp_path / "scene.toml").write_text(FROM_REST)
    interrupted_at_the_start(tmp_path / "rest", str(tmp_path / "scene.toml"))


def test_a_steady_run_is_ended_by_a_signal_too(tmp_path: Path) -> None:
    words = ["--set", "mesh.along=20", "--set", "mesh.across=2", "--out", str(tmp_path / "here")]
    with signalled(ITERATION, 3, signal.SIGINT):
        result = CliRunner().invoke(app, ["run", str(JOBS / "case1.toml"), *words])
    assert result.exit_code == 130
    assert result.stderr == "porolub: Interrupted by SIGINT before there was a state to keep.\n"


RANK = """
import signal, sys
from mpi4py import MPI
from porolub.cli import main
from tests.run.transient import ITERATION, signalled

if MPI.COMM_WORLD.rank == int(sys.argv.pop(1)):
    with signalled(ITERATION, 2, signal.SIGTERM):
        main()
main()
"""


@pytest.mark.mpi
@pytest.mark.parametrize("rank", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_a_signal_to_one_rank_in_the_start_ends_all(run_mpi, tmp_path: Path, rank: int) -> None:
    said = run_mpi(2, RANK, rank, "run", CASE2, *options(), "--out", "here", "--quiet", code=130)
    assert said.count("porolub: Interrupted by SIGTERM before there was a state to keep.") == 1
    assert "Traceback" not in said


class Killed(Exception):
    """What the usual handler of these tests does."""


@pytest.fixture
def _usual_handler() -> Iterator[None]:
    def kill(number: int, frame: object) -> None:
        raise Killed

    before = signal.signal(signal.SIGTERM, kill)
    yield
    signal.signal(signal.SIGTERM, before)


@pytest.mark.usefixtures("_usual_handler")
def test_signals_at_once_are_one_request_and_a_later_one_kills(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """`timeout` signals its child and then the group; mpirun its ranks once more."""
    now = 100.0
    monkeypatch.setattr("porolub.interrupt.time.monotonic", lambda: now)
    comm = MPI.COMM_SELF
    with Interrupt() as interrupt:
        assert interrupt.asked(comm) == ""
        os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGINT)
        assert interrupt.asked(comm) == "Interrupted by SIGTERM"
        with pytest.raises(Interrupted, match="before there was a state to keep"):
            interrupt.raise_if_asked(comm)
        now += 3.0
        with pytest.raises(Killed):
            os.kill(os.getpid(), signal.SIGTERM)
    with pytest.raises(Killed):  # all is as before
        os.kill(os.getpid(), signal.SIGTERM)


def test_a_run_leaves_the_signals_as_they_were(tmp_path: Path) -> None:
    before = [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)]
    run(tmp_path, small("time.end=1 ms"))
    with signalled(ROW, 2, signal.SIGTERM), pytest.raises(Interrupted):
        run(tmp_path, small())
    assert [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)] == before
