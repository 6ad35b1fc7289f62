"""surface.csv, history.csv and summary.json."""

import csv
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from porolub.errors import SceneError
from porolub.io.history import write_history
from porolub.io.summary import KEYS, number, read_summary, write_summary
from porolub.io.surface import read_surface, write_surface
from porolub.solve.report import StepRecord, SurfaceData


def test_surface_reads_back_to_the_same_floats(tmp_path: Path, surface: SurfaceData) -> None:
    path = tmp_path / "surface.csv"
    awkward = replace(surface, p=surface.p / 3 + np.nextafter(1, 2), V=surface.V * 1e-300)
    write_surface(path, awkward)
    assert path.read_text().splitlines()[0] == "s,x,p,p_c,h,Q,V"
    again = read_surface(path)
    for name in ("s", "x", "p", "p_c", "h", "Q", "V"):
        np.testing.assert_array_equal(getattr(again, name), getattr(awkward, name))


@pytest.mark.parametrize("text", ["", "s,x,p\n1,2,3\n", "s,x,p,p_c,h,Q,V\n1,2,3\n", "\xff\n"])
def test_a_damaged_surface_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "surface.csv"
    path.write_text(text, encoding="latin-1")
    with pytest.raises(SceneError, match=r"surface\.csv: a table with the columns s,x,p,p_c"):
        read_surface(path)


def test_history_has_the_union_of_columns_in_the_summarys_order(tmp_path: Path) -> None:
    path = tmp_path / "history.csv"
    steps = [
        StepRecord(0.0, {"fraction": 0.3, "approach": 1e-5, "load_total": np.float64(450.1)}),
        StepRecord(0.5, {"film_min": math.nan, "load_total": 1500.0, "fraction": 1.0}),
    ]
    write_history(path, steps)
    with path.open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows == [
        ["time", "load_total", "approach", "film_min", "fraction"],
        ["0.0", "450.1", "1e-05", "", "0.3"],
        ["0.5", "1500.0", "", "nan", "1.0"],
    ]


def test_summary_has_every_key_of_the_contract_in_its_order(
    tmp_path: Path, summary: dict[str, Any]
) -> None:
    path = tmp_path / "summary.json"
    shuffled = dict(sorted(summary.items(), reverse=True)) | {"stages": 3}
    del shuffled["film_min"]
    write_summary(path, shuffled)
    again = read_summary(path)
    assert tuple(again) == (*KEYS, "stages")
    assert again["film_min"] is None
    assert {key: again[key] for key in shuffled} == shuffled


def test_summary_has_no_number_json_does_not_know(tmp_path: Path) -> None:
    path = tmp_path / "summary.json"
    given = {
        "load_ratio": math.inf,
        "approach": np.float64(1e-4),
        "film_min": np.nan,
        "ranks": np.int64(4),
        "dofs": {"total": np.int32(7)},
        "wall_time": {"total": np.float64("nan"), "parts": np.array([0.5, np.inf])},
    }
    write_summary(path, given)

    def refuse(constant: str) -> None:
        pytest.fail(f"{constant} is no JSON")

    again = json.loads(path.read_text(), parse_constant=refuse)
    assert again["load_ratio"] is None
    assert again["film_min"] is None
    assert again["approach"] == 1e-4
    assert again["ranks"] == 4
    assert again["dofs"] == {"total": 7}
    assert again["wall_time"] == {"total": None, "parts": [0.5, None]}


def test_what_is_no_data_is_refused_and_the_old_summary_stays(tmp_path: Path) -> None:
    path = tmp_path / "summary.json"
    write_summary(path, {"ranks": 1})
    before = path.read_bytes()
    with pytest.raises(TypeError):
        write_summary(path, {"ranks": object()})
    assert path.read_bytes() == before


@pytest.mark.parametrize("text", ["{", "[1, 2]", "nonsense"])
def test_a_damaged_summary_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "summary.json"
    path.write_text(text)
    with pytest.raises(SceneError, match=r"summary\.json: this file"):
        read_summary(path)


def test_a_missing_summary_names_the_directory(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=f"{tmp_path.name}: there is no summary.json"):
        read_summary(tmp_path / "summary.json")


@pytest.mark.parametrize("value", [None, math.nan, math.inf, "1", True])
def test_number_is_none_for_what_is_no_finite_number(value: object) -> None:
    assert number({"load_total": value}, "load_total") is None
    assert number({}, "load_total") is None
    assert number({"load_total": np.float64(2)}, "load_total") == 2.0
