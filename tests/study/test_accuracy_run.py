"""`porolub accuracy` as a user runs it: what it writes, says, goes on with and refuses."""

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from porolub.cli import app
from porolub.io.history import read_history
from porolub.io.summary import read_summary
from porolub.run import run_scene
from porolub.scene import load_scene
from porolub.study.accuracy.files import COLUMNS
from tests.mpirun import mpirun
from tests.run.output import JOBS
from tests.study.drills import journal

SMALL = ["--set", "mesh.along=40", "--set", "mesh.across=4"]
QUICK = [*SMALL, "--set", "time.end=20 ms"]
CLI = "from porolub.cli import main; main()"


def accuracy(job: str, out: Path, *words: str) -> Result:
    """`porolub accuracy` in this process."""
    path = job if job.endswith(".toml") else str(JOBS / f"{job}.toml")
    return CliRunner().invoke(app, ["accuracy", path, "--out", str(out), *words])


def read(out: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((out / "accuracy.json").read_text())
    return found


@pytest.fixture(scope="module")
def steady(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    """Case 1 on three small meshes, twice: the second time nothing is left to compute."""
    out = tmp_path_factory.mktemp("accuracy") / "out"
    first = accuracy("case1", out, *SMALL, "--levels", "3")
    assert (first.exit_code, first.stderr) == (0, "")
    return out, accuracy("case1", out, *SMALL, "--levels", "3")


def test_a_study_is_a_sweep_of_settings(steady: tuple[Path, Result]) -> None:
    out, again = steady
    assert again.exit_code == 0
    assert "6 of 6 cases need no work" in again.stdout
    rows = journal(out)
    assert len(rows) == 6
    assert {row["start"] for row in rows} == {"zero"}
    files = {path.name for path in out.iterdir()}
    assert {"accuracy.json", "accuracy.csv", "precision.png", "table.csv", "log.txt"} <= files
    assert "stribeck.png" not in files


def test_its_numbers_are_those_of_runs(steady: tuple[Path, Result], tmp_path: Path) -> None:
    found = read(steady[0])
    for n in (0, 5):
        changes = journal(steady[0])[n]["values"]
        texts = [f"{key}={value}" for key, value in changes.items()]
        run_scene(load_scene(JOBS / "case1.toml", texts), tmp_path, quiet=True)
        summary = read_summary(tmp_path / "summary.json")
        for name, about in found["quantities"].items():
            assert about["values"][n] == pytest.approx(summary[name], rel=1e-9)
        assert found["settings"][n]["unknowns"] == summary["dofs"]["total"]
    assert list(found["quantities"]) == ["friction_coefficient", "load_fluid", "approach"]


def test_errors_are_values_minus_limit(steady: tuple[Path, Result]) -> None:
    found = read(steady[0])
    with (steady[0] / "accuracy.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS
    assert len(rows) == 3 * 6
    for n, row in enumerate(rows):
        about = found["quantities"][row["quantity"]]
        error = abs(about["values"][n % 6] - about["limit"])
        assert float(row["error"]) == pytest.approx(error, rel=1e-9, abs=1e-15)
        assert float(row["relative_error"]) == pytest.approx(error / abs(about["limit"]), rel=1e-9)
        assert float(row["wall"]) > 0


def test_the_table_says_what_the_advice_is(steady: tuple[Path, Result]) -> None:
    out, again = steady
    text = again.stdout
    for word in ("strategy", "unknowns", "order", "uniform", "graded", "40 x 4", "80 x 8"):
        assert word in text
    assert "1 case ran at a time" in text
    ten = next(a for a in read(out)["recommendation"] if a["target"] == 0.1)
    assert ten["reached"]
    assert ten["command"] in text
    words = ten["command"].replace("'", "").split(" --set ")
    assert words[0] == f"porolub run {JOBS / 'case1.toml'}"
    load_scene(JOBS / "case1.toml", words[1:])
    assert len({word.split("=")[0] for word in words[1:]}) == len(words) - 1  # no key twice


def test_quiet_writes_and_says_nothing(steady: tuple[Path, Result]) -> None:
    out, _ = steady
    again = accuracy("case1", out, *SMALL, "--levels", "3", "--quiet", "--quantity", "load_ratio")
    assert (again.exit_code, again.output) == (0, "")
    assert list(read(out)["quantities"]) == ["load_ratio"]


def test_runs_in_time_are_judged_by_their_last_period(tmp_path: Path) -> None:
    out = tmp_path / "out"
    cycle = ["--set", "motion.speed.frequency=50 Hz"]
    words = ["--vary", "tolerance", "--levels", "3", "--quantity", "load_fluid,approach.max"]
    result = accuracy("case3", out, *QUICK, *cycle, *words)
    assert (result.exit_code, result.stderr) == (0, "")
    found = read(out)
    assert [s["level"] for s in found["settings"]] == ["0.01", "0.001", "0.0001"]
    assert list(found["quantities"]) == ["load_fluid.mean", "approach.max"]
    assert {s["strategy"] for s in found["settings"]} == {"BDF2"}

    changes = [*QUICK[1::2], cycle[1], "time.frames=0"]
    run_scene(load_scene(JOBS / "case3.toml", changes), tmp_path / "run", quiet=True)
    history = read_history(tmp_path / "run" / "history.csv")
    t, load = history["time"], history["load_fluid"]
    mean = np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(t)) / (t[-1] - t[0])
    about = found["quantities"]
    assert about["load_fluid.mean"]["values"][1] == pytest.approx(mean, rel=1e-6)
    assert about["approach.max"]["values"][1] == pytest.approx(history["approach"].max(), rel=1e-6)


def test_a_study_without_results_ends_with_exit_code_3(tmp_path: Path) -> None:
    """Newton may not iterate, so no run converges."""
    result = accuracy("case1", tmp_path, *SMALL, "--levels", "3", "--petsc", "-snes_max_it 0")
    assert result.exit_code == 3
    assert {row["status"] for row in journal(tmp_path)} == {"failed"}
    assert not (tmp_path / "precision.png").exists()


@pytest.mark.parametrize(
    ("job", "words", "sentence"),
    [
        ("case1", ["--vary", "grid"], "--vary grid: allowed are mesh, degree, time, tolerance."),
        ("case1", ["--vary", "time"], "--vary time: the scene has no [time] section"),
        ("case1", ["--levels", "1"], "--levels 1: a whole number from 3 to 8 is needed."),
        ("case1", ["--quantity", "frction_coefficient"], "(did you mean friction_coefficient?)"),
        ("case1", ["--quantity", "approach.mean"], "the scene has no [time] section"),
        ("case3", ["--quantity", "approach.sum"], "one of mean, min, max, end."),
        ("case1_file", [], "a mesh file is used as it is"),
        ("stribeck", [], "this is a sweep file; porolub accuracy needs a scene."),
        ("case1", ["--effects", "--vary", "mesh"], "--vary has no meaning with --effects."),
    ],
)
def test_what_makes_no_study_is_refused(
    tmp_path: Path, job: str, words: list[str], sentence: str
) -> None:
    result = accuracy(job, tmp_path / "out", *words)
    assert result.exit_code == 2
    assert sentence in result.stderr
    assert not (tmp_path / "out").exists()


def test_effects_are_added_one_at_a_time(tmp_path: Path) -> None:
    result = accuracy("case1", tmp_path, "--effects", *SMALL)
    assert (result.exit_code, result.stderr) == (0, "")
    with (tmp_path / "effects.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["effects"] for row in rows] == [
        "solid, contact", "+ pores", "+ motion", "+ carry", "+ film",
    ]  # fmt: skip
    unknowns = [int(float(row["unknowns"])) for row in rows]
    # what is not there has no unknowns: pressures of the pores, volume change of carry, no more
    pressures = 41 * 5
    assert np.diff(unknowns).tolist() == [pressures, 0, pressures, 0]
    assert all(float(row["each"]) > float(row["assembly"]) > 0 for row in rows)
    assert (tmp_path / "effects.png").exists()
    assert "+ carry" in result.stdout


@pytest.mark.mpi
def test_cases_run_side_by_side(tmp_path: Path) -> None:
    text = mpirun(tmp_path, 2, CLI, "accuracy", JOBS / "case1.toml", *SMALL, "--levels", "3",
                  "--out", tmp_path / "out")  # fmt: skip
    assert "2 cases ran side by side" in text
    assert text.count("Cheapest setting") == 1
    found = read(tmp_path / "out")
    assert found["side_by_side"] == 2
    assert {s["status"] for s in found["settings"]} == {"converged"}
