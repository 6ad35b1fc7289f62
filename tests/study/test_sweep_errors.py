"""What goes wrong with a case stays in its row; with the sweep, it ends that, in words."""

import math
import re
import time
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from porolub.solve.steady import SteadySolver
from porolub.study.work.table import read_table
from tests.study.drills import CLI, PLOTS, forces, journal, sweep, sweep_file
from tests.study.sweeps import Tables

CRUSHED = "10 MN/m"  # thousands of moduli over the whole surface
AT_MOST = 30.0  # s, for what must not hang


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PLOTS, lambda directory: [])


def values(*given: str, key: str = "load.force") -> Tables:
    return {"key": key, "values": list(given)}


def test_a_case_that_is_no_scene_is_a_row(tmp_path: Path) -> None:
    file = sweep_file(tmp_path, values("1 kN/m", "-1 kN/m", "3 parsec", "2 kN/m"))
    result = sweep(file, tmp_path / "here", quiet=False)
    assert (result.exit_code, result.stderr) == (0, "")
    assert "converged          2 of 4 cases\nrefused            2 of 4 cases\n" in result.stdout
    columns = read_table(tmp_path / "here").columns
    assert columns["status"].tolist() == ["converged", "refused", "refused", "converged"]
    assert "load.force" in columns["message"][1]
    assert columns["message"][2].startswith('load.force = "3 parsec": ')
    assert columns["load_total"][[0, 3]] == pytest.approx([1000.0, 2000.0], rel=1e-6)
    assert {row["case"] for row in journal(tmp_path / "here")} == {0, 3}


def test_a_case_only_the_mesh_can_refuse_is_a_row(tmp_path: Path) -> None:
    """Conditions that contradict each other at a corner, as the model finds when it is built."""
    base = {
        "geometry": {"shape": "block", "width": "4 mm", "thickness": "1 mm"},
        "mesh": {"along": 4, "across": 2},
        "solid": {"law": "linear", "shear_modulus": "1 MPa", "bulk_modulus": "2 MPa"},
        "boundary": {"left": {"displacement": {"y": "0 mm"}}},
    }
    (tmp_path / "block.toml").write_text(tomli_w.dumps(base))
    file = sweep_file(tmp_path, values("0 mm", "0.1 mm", key="boundary.top.displacement.y"),
                      scene="block.toml", set=[])  # fmt: skip
    assert sweep(file, tmp_path / "here").exit_code == 0
    good, bad = journal(tmp_path / "here")
    assert (good["status"], bad["status"]) == ("converged", "refused")
    assert bad["message"].startswith("Boundary conditions contradict each other at ")


def test_failed_cases_are_rows_and_computed_again_on_request(tmp_path: Path) -> None:
    file = sweep_file(tmp_path, values("1 kN/m", CRUSHED), job="dry_contact")
    here = tmp_path / "here"
    result = sweep(file, here, quiet=False)
    assert (result.exit_code, result.stderr) == (0, "")
    assert "failed             1 of 2 cases" in result.stdout
    columns = read_table(here).columns
    assert columns["status"].tolist() == ["converged", "failed"]
    assert re.search("no convergence in|volume ratio J fell to", columns["message"][1])
    assert math.isnan(columns["load_total"][1])

    result = sweep(file, here, quiet=False)
    assert (result.exit_code, "2 of 2 cases need no work" in result.stdout) == (0, True)
    assert [row["case"] for row in journal(here)] == [0, 1]
    result = sweep(file, here, "--retry-failed", quiet=False)
    assert (result.exit_code, "1 of 2 cases need no work" in result.stdout) == (0, True)
    assert [row["case"] for row in journal(here)] == [0, 1, 1]
    assert len(read_table(here)) == 2


def test_where_all_cases_fail_so_has_the_sweep(tmp_path: Path) -> None:
    file = sweep_file(tmp_path, values(CRUSHED, "3 parsec"), job="dry_contact")
    for _ in range(2):  # also when there is nothing left to do
        result = sweep(file, tmp_path / "here")
        assert (result.exit_code, result.stdout) == (3, "")
        said = "here: no case converged; table.csv says what each one met with."
        assert result.stderr == f"porolub: {tmp_path}/{said}\n"
    assert read_table(tmp_path / "here").columns["status"].tolist() == ["failed", "refused"]


def test_a_defect_met_by_one_case_is_its_row(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solve = SteadySolver.solve

    def at_times(self: SteadySolver) -> Any:
        if self.scene.load.force == 900.0:
            raise ZeroDivisionError("division by zero")
        return solve(self)

    monkeypatch.setattr(SteadySolver, "solve", at_times)
    assert sweep(sweep_file(tmp_path, forces(3)), tmp_path / "here").exit_code == 0
    columns = read_table(tmp_path / "here").columns
    assert columns["status"].tolist() == ["converged", "failed", "converged"]
    assert columns["message"][1] == "ZeroDivisionError: division by zero; log.txt says where."
    assert "Traceback" in (tmp_path / "here" / "log.txt").read_text()
    monkeypatch.undo()
    assert sweep(sweep_file(tmp_path, forces(3)), tmp_path / "here", "--retry-failed"
                 ).exit_code == 0  # fmt: skip
    columns = read_table(tmp_path / "here").columns
    assert set(columns["status"]) == {"converged"}
    assert columns["start"][1] == "cases 0, 2"  # whose states were kept for it


@pytest.mark.parametrize(
    ("key", "named"), [("load.farce", "load.farce = "), ("loaf.force", "[loaf]: ")]
)
def test_an_unknown_key_is_refused_before_anything_is_done(
    tmp_path: Path, key: str, named: str
) -> None:
    result = sweep(sweep_file(tmp_path, values("1 kN/m", "2 kN/m", key=key)), tmp_path / "here")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"porolub: {named}")
    assert not (tmp_path / "here").exists()


UNREAD = "-ksp_tpye preonly"
NOT_READ = "porolub: --petsc -ksp_tpye: no solver of this scene reads that option; did you mean"


def test_an_option_that_nobody_reads_ends_the_sweep(tmp_path: Path) -> None:
    file = sweep_file(tmp_path)
    result = sweep(file, tmp_path / "here", f"--petsc={UNREAD}")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(NOT_READ)
    assert journal(tmp_path / "here") == []
    assert sweep(file, tmp_path / "here").exit_code == 0


@pytest.mark.mpi
def test_on_ranks_too(run_mpi, tmp_path: Path) -> None:
    file = sweep_file(tmp_path)
    said = run_mpi(2, CLI, "sweep", file, "--out", "here", "--quiet", f"--petsc={UNREAD}",
                   code=2, timeout=AT_MOST)  # fmt: skip
    assert said.count(NOT_READ) == said.count("porolub: ") == 1
    assert journal(tmp_path / "here") == []


ONE_FAILS = """
import sys
from mpi4py import MPI
import porolub.solve.accurate
import porolub.study.work.run_case
from porolub.cli import main
from porolub.solve.steady import SteadySolver

class OneFails(SteadySolver):
    def solve(self):
        if MPI.COMM_WORLD.rank == 3:
            raise ZeroDivisionError("on one rank alone")
        return super().solve()

porolub.solve.accurate.SteadySolver = OneFails
porolub.study.work.run_case.PATIENCE = 1.0
main()
"""


@pytest.mark.mpi
def test_a_rank_alone_in_error_ends_the_job(run_mpi, tmp_path: Path) -> None:
    """The second of the second group; what the first has computed by then is kept."""
    file = sweep_file(tmp_path, ranks_per_case=2)
    said = run_mpi(4, ONE_FAILS, "sweep", file, "--out", "here", "--quiet", code=1,
                   timeout=AT_MOST)  # fmt: skip
    assert said.count("ZeroDivisionError: on one rank alone") == 1
    assert all(row["status"] == "converged" for row in journal(tmp_path / "here"))
    alone, end = sweep_file(tmp_path), time.monotonic() + AT_MOST
    while (result := sweep(alone, tmp_path / "here")).exit_code and time.monotonic() < end:
        assert "another sweep" in result.stderr  # mpirun may end before its ranks are gone
        time.sleep(0.2)
    assert result.exit_code == 0



DEFECT = """
import sys
from mpi4py import MPI
from porolub.cli import main
from porolub.study import sweep

class Broken(sweep.SweepProgress):
    def finished(self, row, group=None):
        if group == mine:
            raise BrokenPipeError(32, "Broken pipe")
        super().finished(row, group)

mine = int(sys.argv.pop(1))
sweep.SweepProgress = Broken
main()
"""


@pytest.mark.mpi
@pytest.mark.parametrize("group", [1, pytest.param(0, marks=pytest.mark.slow)])
def test_a_defect_in_what_is_shown_leaves_nobody_waiting(
    run_mpi, tmp_path: Path, group: int
) -> None:
    """As when the output goes to `head`; on rank 0, in its main thread and in that of the queue."""
    file = sweep_file(tmp_path)
    said = run_mpi(2, DEFECT, group, "sweep", file, "--out", "here", "--quiet", code=1,
                   timeout=AT_MOST)  # fmt: skip
    assert "BrokenPipeError" in said
    assert journal(tmp_path / "here") != []
    assert sweep(file, tmp_path / "here").exit_code == 0
