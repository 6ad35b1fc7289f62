"""keep = "results": each case has the directory a run of its own would have; sweeps of runs in
time."""

from pathlib import Path
from typing import Any

import pytest

from porolub.io.history import read_history
from porolub.io.summary import read_summary
from porolub.run import run_scene
from porolub.scene import load_scene
from porolub.study.table import read_table
from tests.run.output import JOBS
from tests.run.transient import same_frames
from tests.study.drills import PLOTS, SMALL, forces, journal, no_remains, sweep, sweep_file

IN_TIME = ["mesh.along=20", "mesh.across=2", "time.end=10 ms", "time.frames=10"]
SPEED = {"key": "motion.speed", "values": ["0.5 rad/s", "1 rad/s"]}
OF_THE_MACHINE = {"wall_time", "peak_memory"}


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PLOTS, lambda directory: [])


def names(directory: Path) -> set[str]:
    return {str(path.relative_to(directory)) for path in directory.rglob("*")}


def same_summary(found: dict[str, Any], expected: dict[str, Any]) -> None:
    assert set(found) == set(expected)
    for key, value in expected.items():
        if key not in OF_THE_MACHINE and not key.endswith("balance_error"):
            approximate = isinstance(value, float)
            assert found[key] == (pytest.approx(value, rel=1e-8) if approximate else value), key


def test_a_steady_case_has_the_directory_of_a_run(tmp_path: Path) -> None:
    file = sweep_file(tmp_path, forces(2), keep="results")
    assert sweep(file, tmp_path / "sweep").exit_code == 0
    scene = load_scene(JOBS / "case1.toml", [*SMALL, "load.force=1.5 kN/m"])
    assert run_scene(scene, tmp_path / "run", quiet=True) == 0
    assert names(tmp_path / "sweep" / "cases") >= {"0000/summary.json", "0001/surface.csv"}
    case = tmp_path / "sweep" / "cases" / "0001"
    assert names(case) == names(tmp_path / "run") - {"log.txt"}
    for name in ("scene.resolved.toml", "petsc.options"):
        assert (case / name).read_text() == (tmp_path / "run" / name).read_text()
    same_summary(read_summary(case / "summary.json"),
                 read_summary(tmp_path / "run" / "summary.json"))
    row = journal(tmp_path / "sweep")[1]
    same_summary(row["summary"], read_summary(case / "summary.json"))
    no_remains(tmp_path / "sweep")


def test_a_case_in_time_has_the_directory_and_the_history_of_a_run(tmp_path: Path) -> None:
    file = sweep_file(tmp_path, SPEED, job="case2", set=IN_TIME, keep="results")
    assert sweep(file, tmp_path / "sweep").exit_code == 0
    scene = load_scene(JOBS / "case2.toml", [*IN_TIME, "motion.speed=1 rad/s"])
    assert run_scene(scene, tmp_path / "run", quiet=True) == 0
    case = tmp_path / "sweep" / "cases" / "0001"
    assert names(case) == names(tmp_path / "run") - {"log.txt"}
    assert (case / "history.csv").read_bytes() == (tmp_path / "run" / "history.csv").read_bytes()
    assert len(read_history(case / "history.csv")["time"]) > 3
    same_frames(case, tmp_path / "run")
    expected = read_summary(tmp_path / "run" / "summary.json")
    same_summary(read_summary(case / "summary.json"), expected)

    # rows alone are the same rows
    rows = sweep_file(tmp_path, SPEED, job="case2", set=IN_TIME)
    assert sweep(rows, tmp_path / "rows").exit_code == 0
    assert not (tmp_path / "rows" / "cases").exists()
    same_summary(journal(tmp_path / "rows")[1]["summary"], expected)
    table = read_table(tmp_path / "rows")
    assert table.columns["time"].tolist() == [expected["time"]] * 2
    assert set(table.columns["start"]) == {"zero"}
