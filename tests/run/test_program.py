"""`porolub run` from the command line: what it prints, what it hands on to PETSc."""

from pathlib import Path

import pytest

from porolub.io.summary import read_summary
from tests.run.output import JOBS
from tests.run.program import porolub, small

CASE1 = JOBS / "case1.toml"


def test_quiet_prints_nothing(tmp_path: Path) -> None:
    result = porolub("run", CASE1, *small(), "--quiet", "--out", "here", cwd=tmp_path)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    assert read_summary(tmp_path / "here" / "summary.json")["status"] == "converged"


def test_it_shows_progress_results_and_the_printed_numbers(tmp_path: Path) -> None:
    result = porolub("run", CASE1, *small(), cwd=tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    summary = read_summary(tmp_path / "results" / "case1" / "summary.json")
    lines = result.stdout.splitlines()
    assert lines[0].startswith("24 x 3")
    iterations = [line.split()[0] for line in lines if line.rstrip().endswith(" s")]
    assert [str(n) for n in range(1, summary["newton_iterations"] + 1)] == iterations[
        : summary["newton_iterations"]]
    for word in ("displacement", "friction coefficient", "fluid mass balance error", "printed"):
        assert word in result.stdout


def test_overrides_reach_the_solver(tmp_path: Path) -> None:
    result = porolub("run", CASE1, *small(20, 4), "--set", "load.force=0.7 kN/m", "--set",
                     "pores.biot=0.8", "--out", "here", "--quiet", cwd=tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    summary = read_summary(tmp_path / "here" / "summary.json")
    assert summary["load_total"] == pytest.approx(700.0, rel=1e-8)
    assert summary["dofs"]["displacement"] == 2 * 41 * 9


def test_petsc_options_are_handed_on(tmp_path: Path) -> None:
    result = porolub("run", CASE1, *small(), "--out", "here", "--petsc",
                     "-snes_monitor -mat_mumps_icntl_14 120", cwd=tmp_path)
    assert result.returncode == 0
    assert "SNES Function norm" in result.stdout
    options = (tmp_path / "here" / "petsc.options").read_text().splitlines()
    assert "-mat_mumps_icntl_14 120" in options
    assert not any(line.startswith("-mat_mumps_icntl_14 80") for line in options)


@pytest.mark.parametrize(
    ("option", "said"),
    [("-snes_moniter", "did you mean -snes_monitor?"), ("-no_such_thing 3", "no solver")],
)
def test_an_option_nobody_reads_is_refused(tmp_path: Path, option: str, said: str) -> None:
    result = porolub("run", CASE1, *small(), "--quiet", "--out", "here", f"--petsc={option}",
                     cwd=tmp_path)
    assert result.returncode == 2
    (line,) = result.stderr.splitlines()
    assert line.startswith(f"porolub: --petsc {option.split()[0]}: ")
    assert said in line
