"""One job at a time has the directory of a sweep; a dead one has it no more."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from porolub.errors import SceneError, SolveError
from porolub.study.work import lock as module
from porolub.study.work.lock import Lock

HOLDS = """
import sys
from pathlib import Path
from porolub.study.work.lock import Lock

with Lock(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""


@contextmanager
def holder(directory: Path) -> Iterator["subprocess.Popen[str]"]:
    """Another process that has the directory until its input ends."""
    with subprocess.Popen(
        [sys.executable, "-c", HOLDS, str(directory)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        yield process
        process.communicate()


def test_the_directory_is_made_and_free_again_afterwards(tmp_path: Path) -> None:
    directory = tmp_path / "results" / "x"
    for _ in range(2):
        with Lock(directory):
            assert (directory / ".lock.owner").exists()
        assert not (directory / ".lock.owner").exists()


def test_another_process_is_told_who_has_it(tmp_path: Path) -> None:
    with holder(tmp_path) as process:
        with pytest.raises(SceneError) as caught, Lock(tmp_path):
            pass
        assert re.fullmatch(
            re.escape(str(tmp_path))
            + r": another sweep has been writing here since \d{4}-\d\d-\d\d \d\d:\d\d "
            + rf"\(process {process.pid} on {re.escape(os.uname().nodename)}\); "
            + "wait for it or choose another --out.",
            str(caught.value),
        )
        with pytest.raises(SceneError), Lock(tmp_path):  # being refused changes nothing
            pass
    with Lock(tmp_path):
        pass


def test_a_killed_process_has_it_no_more(tmp_path: Path) -> None:
    with holder(tmp_path) as process:
        process.kill()
    assert (tmp_path / ".lock.owner").exists()
    with Lock(tmp_path):
        assert f"process {os.getpid()} " in (tmp_path / ".lock.owner").read_text()


def test_nobody_has_it_twice(tmp_path: Path) -> None:
    with Lock(tmp_path):
        with pytest.raises(SceneError, match=f"process {os.getpid()} on"), Lock(tmp_path):
            pass
        (tmp_path / ".lock.owner").unlink()
        with pytest.raises(SceneError, match="another sweep is writing here; wait"), Lock(tmp_path):
            pass


def test_a_left_over_file_means_nothing(tmp_path: Path) -> None:
    (tmp_path / ".lock").write_text("of an earlier job")
    (tmp_path / ".lock.owner").write_text("since long ago")
    with Lock(tmp_path):
        pass


def test_an_error_inside_lets_go_of_it(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), Lock(tmp_path):
        raise KeyboardInterrupt
    with Lock(tmp_path):
        pass


def test_a_full_disk_is_a_sentence_and_leaves_it_free(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, text: str) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(module, "write_text", full)
        with pytest.raises(SolveError, match=r"cannot be written \(No space left"), Lock(tmp_path):
            pass
    with Lock(tmp_path):
        pass


def test_a_file_in_the_way_is_refused(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("")
    with pytest.raises(SceneError, match="this is a file"), Lock(tmp_path / "x"):
        pass


RANKS = """
import sys
from pathlib import Path
from mpi4py import MPI
from porolub.errors import SceneError
from porolub.study.work.lock import Lock

comm = MPI.COMM_WORLD
for name in ("free", "held"):
    try:
        with Lock(Path(name), comm):
            comm.Barrier()
            print(f"rank {comm.rank}: {name} got\\n", end="", flush=True)
            comm.Barrier()
    except SceneError:
        print(f"rank {comm.rank}: {name} refused\\n", end="", flush=True)
"""


@pytest.mark.mpi
def test_all_ranks_get_it_or_none(run_mpi, tmp_path: Path) -> None:
    with holder(tmp_path / "held"):
        said = run_mpi(2, RANKS, timeout=60)
    assert sorted(said.split("\n"))[-4:] == [
        "rank 0: free got", "rank 0: held refused", "rank 1: free got", "rank 1: held refused",
    ]  # fmt: skip
