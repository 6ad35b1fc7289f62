"""table.csv and table.h5 hold all that the rows hold, in columns."""

import csv
from pathlib import Path

import h5py
import numpy as np
import pytest

from porolub.errors import SceneError, SolveError
from porolub.io.summary import ORDER
from porolub.study.plan.axis import Axis
from porolub.study.work.columns import _UNITS, FACTS, LIKE, NESTED, headings
from porolub.study.work.table import comparable, read_table, write_table
from tests.study.rows import APPROACHES, GRADINGS, row, sweep


def cells(directory: Path) -> list[dict[str, str]]:
    with (directory / "table.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_both_files_have_a_row_for_each_case_in_their_order(tmp_path: Path) -> None:
    write_table(tmp_path, sweep(), [row(5), row(0), row(3, "failed")])
    assert [r["case"] for r in cells(tmp_path)] == ["0", "3", "5"]
    table = read_table(tmp_path)
    assert len(table) == 3
    np.testing.assert_array_equal(table.columns["case"], [0, 3, 5])
    assert table.columns["case"].dtype == np.int64
    assert list(cells(tmp_path)[0]) == list(table.names) == list(table.columns)
    assert not list(tmp_path.glob(".*"))


def test_columns_are_case_axes_facts_and_the_summary_in_its_order(tmp_path: Path) -> None:
    write_table(tmp_path, sweep(), [row(3, "failed"), row(4, stages=3)])
    names = read_table(tmp_path).names
    assert names[:3] == ("case", "load.approach", "grading")
    assert names[3:9] == FACTS
    top = list(dict.fromkeys(name.split(".")[0] for name in names[9:]))
    assert top == [k for k in ORDER if k not in ("status", "message", "contact_area",
                                                 "contact_width")] + ["stages"]  # fmt: skip
    assert [n for n in names if "." in n][1:] == [
        "dofs.displacement", "dofs.total", "wall_time.setup", "wall_time.total", "versions.python",
    ]  # fmt: skip


def test_a_converged_case_reads_back_to_the_same_values(tmp_path: Path) -> None:
    write_table(tmp_path, sweep(), [row(4), row(5, "failed"), row(6)])
    expected = {
        "load.approach": (2e-5, 2e-5, 5e-5),
        "grading": ("none", "contact", "none"),
        "status": ("converged", "failed", "converged"),
        "message": ("converged", 'It "failed",\nor so it says.', "converged"),
        "regime": ("mixed", "", "mixed"),
        "sommerfeld_number": (6.67e-8, np.nan, 6.67e-8),
        "start": ("cases 3, 5",) * 3,
        "wall": (1.25,) * 3,
        "load_total": (1500.1, np.nan, 1500.1),
        "load_ratio": (np.nan,) * 3,
        "friction_coefficient": (1 / 7, np.nan, 1 / 7),
        "effects": ("solid film", "", "solid film"),
        "dofs.total": (165.0, np.nan, 165.0),
        "newton_iterations": (7.0, np.nan, 7.0),
        "versions.python": ("3.11.2", "", "3.11.2"),
    }
    table, text = read_table(tmp_path), cells(tmp_path)
    for name, values in expected.items():
        np.testing.assert_array_equal(table.columns[name], values, err_msg=name)
        for shown, value in zip(text, values, strict=True):
            if isinstance(value, str):
                assert shown[name] == value
            elif name in ("dofs.total", "newton_iterations"):
                assert shown[name] == ("" if np.isnan(value) else str(int(value)))
            else:
                assert shown[name] == ("" if np.isnan(value) else repr(value))


def test_whole_numbers_stay_whole_where_all_cases_have_one(tmp_path: Path) -> None:
    write_table(tmp_path, sweep(), [row(0), row(1)])
    columns = read_table(tmp_path).columns
    assert columns["newton_iterations"].dtype == columns["peak_memory"].dtype == np.int64
    assert columns["friction_coefficient"].dtype == np.float64


def test_not_a_number_and_infinity_are_told_apart_from_nothing(tmp_path: Path) -> None:
    rows = [row(0, load_ratio=np.nan), row(1, load_ratio=np.inf), row(2)]
    write_table(tmp_path, sweep(), rows)
    assert [r["load_ratio"] for r in cells(tmp_path)] == ["nan", "inf", ""]
    np.testing.assert_array_equal(
        read_table(tmp_path).columns["load_ratio"], [np.nan, np.inf, np.nan]
    )


def test_without_results_the_columns_keep_their_kinds(tmp_path: Path) -> None:
    write_table(tmp_path, sweep(), [row(0, "failed"), row(1, "refused")])
    columns = read_table(tmp_path).columns
    assert list(columns["regime"]) == list(columns["effects"]) == ["", ""]
    assert np.isnan(columns["load_total"]).all()
    assert not any(name.startswith(NESTED) for name in columns)


def test_a_sweep_without_rows_has_an_empty_table(tmp_path: Path) -> None:
    write_table(tmp_path, sweep(), [])
    assert len(read_table(tmp_path)) == len(cells(tmp_path)) == 0


def test_many_cases_read_back_too(tmp_path: Path) -> None:
    """They are compressed."""
    messages = ["", "µ", "a long one " * 30]
    rows = [row(k % 8) | {"case": k, "wall": k / 3, "message": messages[k % 3]}
            for k in range(3000)]  # fmt: skip
    write_table(tmp_path, sweep(), rows)
    columns = read_table(tmp_path).columns
    np.testing.assert_array_equal(columns["wall"], np.arange(3000) / 3)
    assert list(columns["message"]) == messages * 1000
    assert (tmp_path / "table.h5").stat().st_size < (tmp_path / "table.csv").stat().st_size / 5


def test_odd_texts_are_written_as_far_as_they_are_text(tmp_path: Path) -> None:
    rows = [row(0) | {"message": "a\r\nb\rc µ"}, row(1) | {"message": "file \udcff"}]
    write_table(tmp_path, sweep(), rows)
    assert [r["message"] for r in cells(tmp_path)] == ["a\nb\nc µ", "file ?"]
    assert list(read_table(tmp_path).columns["message"]) == ["a\r\nb\rc µ", "file ?"]


def test_others_can_read_the_file(tmp_path: Path) -> None:
    """Names, units and axes, by plain HDF5."""
    write_table(tmp_path, sweep(), [row(0), row(1)])
    with h5py.File(tmp_path / "table.h5") as file:
        assert file.attrs["title"] == 'Curves, "two" of them'
        assert list(file.attrs["axes"]) == ["approach", "grading"]
        assert list(file["status"].asstr()[:]) == ["converged", "converged"]
        assert file["load_total"].attrs["unit"] == "N/m"
        assert file["load.approach"].attrs["unit"] == file["approach"].attrs["unit"] == "m"
        assert file["wall_time.total"].attrs["unit"] == "s"
        assert "unit" not in file["friction_coefficient"].attrs
        axis = file["axes/load.approach"]
        np.testing.assert_allclose(axis[:], [0, 5e-6, 2e-5, 5e-5], rtol=1e-15)
        assert (axis.attrs["name"], axis.attrs["scale"], axis.attrs["unit"]) == (
            "approach", "log", "m")  # fmt: skip
        assert list(file["axes/grading"].asstr()[:]) == list(GRADINGS)


def test_axes_read_back(tmp_path: Path) -> None:
    write_table(tmp_path, sweep(), [row(0)])
    table = read_table(tmp_path)
    approach, grading = table.axes
    assert table.title == 'Curves, "two" of them'
    assert (approach.name, approach.column, approach.keys, approach.unit, approach.scale) == (
        "approach", "load.approach", ("load.approach",), "m", "log")  # fmt: skip
    assert approach.numbers is not None
    assert len(approach.numbers) == len(APPROACHES)
    assert approach.texts == ()
    assert (grading.column, grading.numbers, grading.texts) == ("grading", None, GRADINGS)
    assert (grading.unit, grading.scale) == ("", "")


@pytest.mark.parametrize("name", ["approach", "status", "case", "axes", "time", "a/b", "."])
def test_an_axis_whose_name_is_taken_has_its_key_for_a_heading(tmp_path: Path, name: str) -> None:
    axis = Axis(name, ("motion.speed",), (("1 m/s",),), np.array([1.0]), "m/s")
    assert headings([axis]) == ["motion.speed"]
    write_table(tmp_path, sweep(axis), [row(0, time=5.0) | {"axes": {name: 1.0}}])
    table = read_table(tmp_path)
    assert table.columns["motion.speed"] == 1.0
    assert table.axes[0].name == name
    assert len(set(table.names)) == len(table.names)


def test_a_body_has_other_units(tmp_path: Path) -> None:
    write_table(tmp_path, sweep(), [row(0, contact_area=None)])
    units = read_table(tmp_path).units
    assert (units["load_total"], units["inflow_left"]) == ("N", "kg/s")
    assert units["contact_area"] == "m^2"
    write_table(tmp_path, sweep(), [row(0)])
    assert read_table(tmp_path).units["load_total"] == "N/m"


def test_each_number_of_the_summary_has_a_unit_or_none_on_purpose() -> None:
    texts = {"status", "message", "warnings", "effects", "versions"}
    plain = {*LIKE, "load_ratio", "friction_coefficient", "friction_fluid", "jacobian_min",
             "mass_balance_error", "load_balance_error", "dofs", "ranks", "newton_iterations",
             "linear_iterations", "time_steps", "rejected_steps"}  # fmt: skip
    assert set(ORDER) - texts - plain == set(_UNITS) - {"wall", "time"}


def test_what_depends_on_the_machine_is_not_compared(tmp_path: Path) -> None:
    other = {"wall_time": {"setup": 9.0, "total": 9.0}, "peak_memory": 1, "ranks": 4}
    for name, rows in {
        "a": [row(0), row(1)],
        "b": [row(1, **other), row(0, **other) | {"wall": 9.0}],
    }.items():
        (tmp_path / name).mkdir()
        write_table(tmp_path / name, sweep(), rows)
    a, b = (comparable(read_table(tmp_path / name)) for name in "ab")
    assert list(a) == list(b)
    assert {"case", "start", "friction_coefficient", "newton_iterations", "dofs.total"} <= set(a)
    assert not [n for n in a if n.startswith(("wall", "peak", "versions", "ranks"))]
    for name in a:
        np.testing.assert_array_equal(a[name], b[name])


def test_no_table_and_a_damaged_one_are_sentences(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"there is no table\.h5, so this is no output of a sweep"):
        read_table(tmp_path)
    (tmp_path / "table.h5").write_bytes(b"half")
    with pytest.raises(SceneError, match=r"table\.h5: this file is damaged"):
        read_table(tmp_path)
    with h5py.File(tmp_path / "table.h5", "w") as file:
        file["x"] = 1.0
    with pytest.raises(SceneError, match=r"table\.h5: this file is damaged"):
        read_table(tmp_path)


def test_a_table_that_cannot_be_written_is_a_sentence_and_the_old_one_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_table(tmp_path, sweep(), [row(0)])
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("porolub.io.atomic.to_disk", full)
    with pytest.raises(SolveError, match=r"the table of the sweep cannot be written \(No space"):
        write_table(tmp_path, sweep(), [row(0), row(1)])
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
