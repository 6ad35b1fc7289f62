"""A sweep is so many runs: the same numbers, in one table."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from porolub.io.summary import read_summary
from porolub.run import run_scene
from porolub.scene import load_scene
from porolub.study.work.table import read_table
from tests.run.output import JOBS
from tests.study.drills import (
    PLOTS,
    SMALL,
    computed,
    forces,
    journal,
    no_remains,
    same_table,
    sweep,
    sweep_file,
)  # fmt: skip
from tests.study.sweeps import log

NOT_COMPARED = {"wall_time", "peak_memory", "newton_iterations", "linear_iterations"}
ROUNDING = {"mass_balance_error", "load_balance_error"}
ERROR = "error_estimate."  # differences of the numbers: rounding is that of these


def flat(summary: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Keys of a summary as the table has them."""
    found: dict[str, Any] = {}
    for key, value in summary.items():
        name = prefix + key
        found |= flat(value, f"{name}.") if isinstance(value, dict) else {name: value}
    return found


def test_each_row_is_the_summary_of_a_run(tmp_path: Path) -> None:
    file = sweep_file(tmp_path)
    result = sweep(file, tmp_path / "sweep", quiet=False)
    assert (result.exit_code, result.stderr) == (0, "")
    assert "converged          6 of 6 cases" in result.stdout
    table = read_table(tmp_path / "sweep")
    assert table.columns["case"].tolist() == [0, 1, 2, 3, 4, 5]
    assert len((tmp_path / "sweep" / "table.csv").read_text().splitlines()) == 1 + 6
    assert set(table.columns["status"]) == {"converged"}
    files = {path.name for path in (tmp_path / "sweep").iterdir()}
    assert {"stribeck.png", "map_friction_coefficient.png", "log.txt", "journal.jsonl",
            "sweep.resolved.toml"} <= files
    no_remains(tmp_path / "sweep")

    by_case = {row["case"]: row for row in journal(tmp_path / "sweep")}
    for case in (0, 4):  # one from zero, one from its neighbours
        values = [f"{key}={value}" for key, value in by_case[case]["values"].items()]
        scene = load_scene(JOBS / "case1.toml", [*SMALL, *values])
        run_scene(scene, tmp_path / "run", quiet=True)
        summary = flat(read_summary(tmp_path / "run" / "summary.json"))
        assert set(summary) <= set(table.names)
        for key, expected in summary.items():
            found = table.columns[key][case]
            if key.split(".")[0] in NOT_COMPARED:
                assert found > 0
            elif key in ROUNDING:
                assert found < 1e-8
            elif isinstance(expected, float):
                # what passes at one side may be next to nothing beside the other
                like = summary["inflow_left" if "flow_" in key else key.removeprefix(ERROR)]
                size = 1e-8 * abs(like) if "flow_" in key or key.startswith(ERROR) else 1e-30
                assert found == pytest.approx(expected, rel=1e-8, abs=size), key
            elif expected is None:
                assert np.isnan(found), key
            else:
                assert found == (" ".join(expected) if isinstance(expected, list) else expected)


def test_the_same_command_again_does_no_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[Path] = []
    monkeypatch.setattr(PLOTS, drawn.append)
    file = sweep_file(tmp_path, forces(3))
    expected = computed(file, tmp_path / "here")
    before = {name: (tmp_path / "here" / name).read_bytes()
              for name in ("journal.jsonl", "table.csv", "table.h5")}  # fmt: skip
    with monkeypatch.context() as patch:
        patch.setattr("porolub.solve.accurate.SteadySolver", None)
        result = sweep(file, tmp_path / "here", quiet=False)
    assert (result.exit_code, result.stderr) == (0, "")
    assert "3 of 3 cases need no work" in result.stdout
    assert {name: (tmp_path / "here" / name).read_bytes() for name in before} == before
    same_table(read_table(tmp_path / "here"), expected)
    assert drawn == [tmp_path / "here"] * 2  # the figures may be what was missing


def test_neighbours_save_newton_iterations_and_change_no_number(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(PLOTS, lambda directory: [])
    axes = log("motion.speed", "0.5 rad/s", "1 rad/s", 3), log("load.force", "1 kN/m", "2 kN/m", 5)
    finer = ["mesh.along=40", "mesh.across=4"]
    tables = {start: computed(sweep_file(tmp_path, *axes, set=finer, start=start), tmp_path / start)
              for start in ("zero", "neighbour")}  # fmt: skip
    cold, warm = tables["zero"].columns, tables["neighbour"].columns
    assert set(cold["start"]) == {"zero"}
    assert list(warm["start"]).count("zero") == 4  # the corners
    begun = warm["start"] != "zero"
    assert warm["newton_iterations"][begun].sum() <= 0.5 * cold["newton_iterations"][begun].sum()
    assert warm["newton_iterations"].sum() <= 0.6 * cold["newton_iterations"].sum()
    assert tables["neighbour"].names == tables["zero"].names
    for name, values in cold.items():
        if name.split(".")[0] in (*NOT_COMPARED, *ROUNDING, "wall", "start"):
            continue
        if values.dtype == float:
            size = np.nanmax(np.abs(cold[name.removeprefix(ERROR)]), initial=0.0)
            np.testing.assert_allclose(warm[name], values, rtol=1e-6, atol=1e-9 * size,
                                       err_msg=name)
        else:
            np.testing.assert_array_equal(warm[name], values, err_msg=name)
