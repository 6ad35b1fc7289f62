"""keep = "results": each case has the directory a run of its own would have; sweeps of runs in
time."""

from pathlib import Path
from typing import Any

import pytest

from porolub.io.history import read_history
from porolub.io.summary import read_summary
from porolub.run import run_scene
from porolub.scene import load_scene
from porolub.study.work.table import read_table
from tests.run.output import JOBS
from tests.run.transient import same_frames
from tests.study.drills import PLOTS, SMALL, forces, journal, no_remains, sweep, sweep_file

IN_TIME = ["mesh.along=20", "mesh.across=2", "time.end=10 ms", "time.frames=10"]
SPEED = {"key": "motion.speed", "values": ["0.5 rad/s", "1 rad/s"]}
OF_THE_MACHINE = {"wall_time", "peak_memory"}


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PLOTS, lambda directory: [])


@pytest.fixture
def _no_pictures_of_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("porolub.io.plots.plot_directory", lambda directory: [])


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
    assert names(case) == names(tmp_path / "run") - {"log.txt"} | {".case"}
    for name in ("scene.resolved.toml", "petsc.options"):
        assert (case / name).read_text() == (tmp_path / "run" / name).read_text()
    same_summary(read_summary(case / "summary.json"),
                 read_summary(tmp_path / "run" / "summary.json"))
    row = journal(tmp_path / "sweep")[1]
    same_summary(row["summary"], read_summary(case / "summary.json"))
    no_remains(tmp_path / "sweep")


@pytest.mark.usefixtures("_no_pictures_of_cases")
def test_a_case_in_time_has_the_directory_and_the_history_of_a_run(tmp_path: Path) -> None:
    file = sweep_file(tmp_path, SPEED, job="case2", set=IN_TIME, keep="results")
    assert sweep(file, tmp_path / "sweep").exit_code == 0
    scene = load_scene(JOBS / "case2.toml", [*IN_TIME, "motion.speed=1 rad/s"])
    assert run_scene(scene, tmp_path / "run", quiet=True) == 0
    case = tmp_path / "sweep" / "cases" / "0001"
    assert names(case) == names(tmp_path / "run") - {"log.txt"} | {".case"}
    assert (case / "history.csv").read_bytes() == (tmp_path / "run" / "history.csv").read_bytes()
    assert len(read_history(case / "history.csv")["time"]) > 3
    same_frames(case, tmp_path / "run")
    expected = read_summary(tmp_path / "run" / "summary.json")
    same_summary(read_summary(case / "summary.json"), expected)

    # rows alone are the same rows
    rows = sweep_file(tmp_path, SPEED, job="case2", set=IN_TIME)
    assert sweep(rows, tmp_path / "rows").exit_code == 0
    assert not (tmp_path / "rows" / "cases").exists()
    found = journal(tmp_path / "rows")[1]["summary"]
    assert found.pop("over_time")  # of quantities of the history, for studies of accuracy
    same_summary(found, expected)
    table = read_table(tmp_path / "rows")
    assert table.columns["time"].tolist() == [expected["time"]] * 2
    assert set(table.columns["start"]) == {"zero"}


def of_case(directory: Path) -> dict[str, tuple[float, int]]:
    """What each directory of a case was computed for, and when."""
    found = {}
    for place in (directory / "cases").iterdir():
        scene = load_scene(place / "scene.resolved.toml")
        found[place.name] = (scene.load.force, (place / "summary.json").stat().st_mtime_ns)
    return found


@pytest.mark.usefixtures("_no_pictures_of_cases")
def test_directories_follow_the_numbers_of_their_cases(tmp_path: Path) -> None:
    here = tmp_path / "sweep"

    def computed(*given: int) -> dict[str, tuple[float, int]]:
        axis = {"key": "load.force", "values": [f"{f} N/m" for f in given]}
        assert sweep(sweep_file(tmp_path, axis, keep="results"), here).exit_code == 0
        assert read_table(here).columns["force"].tolist() == list(given)
        return of_case(here)

    few = computed(300, 2000)
    more = computed(300, 600, 1000, 2000)
    assert [force for force, _ in (more[f"000{k}"] for k in range(4))] == [300, 600, 1000, 2000]
    assert (more["0000"], more["0003"]) == (few["0000"], few["0001"])
    # a killed job has left one on its way, and taken half of another along
    (here / "cases" / "0002").rename(here / "cases" / f".{journal(here)[-1]['key']}")
    (here / "cases" / "0001" / "summary.json").unlink()
    again = computed(300, 600, 1000, 2000)
    assert again.keys() == more.keys()
    assert {name for name in more if again[name] != more[name]} == {"0001"}
    fewer = computed(600, 2000)
    assert (fewer.pop("0000"), fewer.pop("0001")) == (again["0001"], again["0003"])
    assert {force for force, _ in fewer.values()} == {300, 1000}  # kept by other names
    assert all(name.startswith("other-") for name in fewer)


@pytest.mark.usefixtures("_no_pictures_of_cases")
def test_rows_without_results_do_not_do_where_results_are_to_be_kept(tmp_path: Path) -> None:
    assert sweep(sweep_file(tmp_path, forces(2)), tmp_path / "here").exit_code == 0
    file = sweep_file(tmp_path, forces(2), keep="results")
    assert sweep(file, tmp_path / "here").exit_code == 0
    assert len(of_case(tmp_path / "here")) == 2
    assert len(journal(tmp_path / "here")) == 4
    assert sweep(file, tmp_path / "here").exit_code == 0
    assert len(journal(tmp_path / "here")) == 4


@pytest.mark.usefixtures("_no_pictures_of_cases")
def test_results_of_parts_do(tmp_path: Path) -> None:
    file = sweep_file(tmp_path, forces(2), keep="results")
    for words in (["--part", "1/2"], ["--part", "2/2"], []):
        assert sweep(file, tmp_path / "here", *words).exit_code == 0
    assert journal(tmp_path / "here") == []
    assert set(of_case(tmp_path / "here" / "part-2-of-2")) == {"0001"}
