"""kill -9 and SIGTERM at any moment: the same command finishes, and nothing is computed twice."""

import signal
from pathlib import Path

import pytest

from porolub.study.work.table import Table, read_table
from tests.run.transient import ITERATION, signalled
from tests.study.drills import (
    PLOTS,
    computed,
    computed_once,
    journal,
    no_remains,
    same_table,
    started,
    sweep,
    sweep_file,
)  # fmt: skip

DIES = Path(__file__).with_name("dies.py")
CASES = 6


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> Table:
    directory = tmp_path_factory.mktemp("expected")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(PLOTS, lambda directory: [])
        return computed(sweep_file(directory), directory / "sweep")


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PLOTS, lambda directory: [])


def goes_on(file: Path, out: Path, expected: Table) -> None:
    """Assert that the same command finishes to the same table, with no case done again."""
    result = sweep(file, out)
    assert (result.exit_code, result.output) == (0, "")
    same_table(read_table(out), expected)
    computed_once(out)
    assert len(journal(out)) == CASES
    no_remains(out)


@pytest.mark.parametrize(
    ("where", "count"),
    [
        ("in a case", 30),
        ("in a line", 4),
        ("in a state", 3),
        pytest.param("in the table", 2, marks=pytest.mark.slow),
    ],
)
def test_a_sweep_that_was_killed_goes_on(
    tmp_path: Path, expected: Table, where: str, count: int
) -> None:
    file = sweep_file(tmp_path)
    words = [where, count, "sweep", file, "--out", "here", "--quiet"]
    with started(DIES, *words, cwd=tmp_path) as process:
        said, _ = process.communicate(timeout=60)
    assert (process.returncode, said) == (-signal.SIGKILL, "")
    assert 0 < len(journal(tmp_path / "here")) < CASES
    goes_on(file, tmp_path / "here", expected)


@pytest.mark.mpi
@pytest.mark.parametrize(
    ("rank", "count"), [(1, 5), pytest.param(0, 20, marks=pytest.mark.slow)]
)
def test_a_rank_that_is_killed_takes_the_others_along(
    run_mpi, tmp_path: Path, expected: Table, rank: int, count: int
) -> None:
    file = sweep_file(tmp_path)
    words = ["in a case", count, rank, "sweep", file, "--out", "here", "--quiet"]
    said = run_mpi(2, DIES, *words, code=128 + signal.SIGKILL, timeout=60)
    assert "exited on signal 9" in said
    assert len(journal(tmp_path / "here")) < CASES
    goes_on(file, tmp_path / "here", expected)


def test_a_signal_ends_it_in_good_order(tmp_path: Path, expected: Table) -> None:
    file = sweep_file(tmp_path)
    with signalled(ITERATION, 30, signal.SIGTERM):
        result = sweep(file, tmp_path / "here")
    done = len(journal(tmp_path / "here"))
    assert 0 < done < CASES
    assert (result.exit_code, result.stdout) == (130, "")
    assert result.stderr == (
        f"porolub: Interrupted by SIGTERM. {done} of {CASES} cases are done; the same command goes "
        "on from there.\n"
    )  # fmt: skip
    assert len(read_table(tmp_path / "here")) == done
    goes_on(file, tmp_path / "here", expected)


def test_a_signal_before_the_first_case_is_done(tmp_path: Path, expected: Table) -> None:
    file = sweep_file(tmp_path)
    with signalled(ITERATION, 1, signal.SIGINT):
        result = sweep(file, tmp_path / "here")
    assert result.exit_code == 130
    assert f" 0 of {CASES} cases are done; the same command goes on" in result.stderr
    goes_on(file, tmp_path / "here", expected)


SIGNALLED = """
import signal, sys
from mpi4py import MPI
from porolub.cli import main
from porolub.study import sweep
from tests.run.transient import ITERATION, signalled

if MPI.COMM_WORLD.rank == int(sys.argv.pop(1)):
    with signalled(ITERATION, 5, signal.SIGTERM):
        main()
main()
"""


@pytest.mark.mpi
def test_a_signal_to_one_rank_ends_all(run_mpi, tmp_path: Path, expected: Table) -> None:
    file = sweep_file(tmp_path)
    said = run_mpi(2, SIGNALLED, 1, "sweep", file, "--out", "here", "--quiet", code=130,
                   timeout=60)  # fmt: skip
    done = len(journal(tmp_path / "here"))
    assert done < CASES
    (line,) = [line for line in said.splitlines() if line.startswith("porolub: ")]
    assert f" {done} of {CASES} cases are done; the same command goes on" in line
    assert "Traceback" not in said
    goes_on(file, tmp_path / "here", expected)
