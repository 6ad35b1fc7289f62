"""Histories in CSV files: their content counts, and every mistake is named with its line."""

import time
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from porolub.errors import SceneError
from porolub.scene import Scene, load_scene, scene_from_dict, value_at, write_resolved
from tests.scene.scenes import CUBE, ROLLING, changed

GOOD = "# a hip\ntime [ms], force [kN/m]\n\n0,0.3\n120, 3.0\n1e3, .3\n"


def loaded(directory: Path, text: str | None, **keys: Any) -> Scene:
    if text is not None:
        (directory / "load.csv").write_text(text)
    tables = changed(ROLLING, load={"force": {"table": "load.csv"} | keys}, time={"end": "5 s"})
    return scene_from_dict(tables, base_dir=directory)


def test_a_table_is_read_with_its_units(tmp_path: Path) -> None:
    inline = {"times": ["0 s", "120 ms", "1 s"], "values": ["300 N/m", "3 kN/m", "0.3 kN/m"]}
    tables = changed(ROLLING, load={"force": inline}, time={"end": "5 s"})
    assert loaded(tmp_path, GOOD) == scene_from_dict(tables)
    tables["load"]["force"] |= {"interpolation": "smooth", "repeat": True}
    assert loaded(tmp_path, GOOD, interpolation="smooth", repeat=True) == scene_from_dict(tables)


def test_its_path_is_relative_to_the_scene_file(tmp_path: Path) -> None:
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "load.csv").write_text(GOOD)
    tables = changed(ROLLING, load={"force": {"table": "tables/load.csv"}}, time={"end": "5 s"})
    (tmp_path / "scene.toml").write_text(tomli_w.dumps(tables))
    scene = load_scene(tmp_path / "scene.toml")
    assert scene.load is not None
    assert scene.load.at(0.12) == 3000.0
    again = load_scene(tmp_path / "scene.toml", ['load.force={table="tables/load.csv"}'])
    assert again == scene


def test_a_resolved_scene_stands_alone(tmp_path: Path) -> None:
    scene = loaded(tmp_path, GOOD)
    write_resolved(scene, tmp_path / "resolved.toml")
    (tmp_path / "load.csv").unlink()
    assert load_scene(tmp_path / "resolved.toml") == scene
    assert "load.csv" not in (tmp_path / "resolved.toml").read_text()


def test_the_content_counts_not_the_path(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    one = loaded(tmp_path / "a", GOOD)
    same = loaded(tmp_path / "b", GOOD.replace("120", "1.2e2"))
    other = loaded(tmp_path / "b", GOOD.replace("3.0", "3.1"))
    assert one.digest() == same.digest() != other.digest()


def test_all_histories_can_be_tables(tmp_path: Path) -> None:
    for name, heading in (("speed", "[deg/s]"), ("pressure", "[kPa]"), ("length", "[um]")):
        (tmp_path / f"{name}.csv").write_text(f"time [s], value {heading}\n0, 180\n1, 90\n")
    speed, pressure, length = ({"table": f"{n}.csv"} for n in ("speed", "pressure", "length"))
    inlet = {"pressure": pressure, "displacement": {"normal": length}, "traction": {"y": pressure}}
    tables = changed(
        ROLLING,
        motion={"speed": speed},
        load={"force": None, "approach": length},
        boundary={"inlet": inlet},
    )
    scene = scene_from_dict(tables, base_dir=tmp_path)
    values = {key: value_at(h, 0.0) for key, h in scene.histories().items()}
    assert values == {
        "load.approach": 180e-6,
        "motion.speed": pytest.approx(3.14159265358979),
        "boundary.inlet.displacement.normal": 180e-6,
        "boundary.inlet.traction.x": 0.0,
        "boundary.inlet.traction.y": 180e3,
        "boundary.inlet.traction.z": 0.0,
        "boundary.inlet.pressure": 180e3,
    }


def test_a_normal_traction_can_be_a_table(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("time [s], value [kPa]\n0, 2\n1, 3\n")
    tables = changed(ROLLING, boundary={"inlet": {"traction": {"table": "p.csv"}}})
    traction = scene_from_dict(tables, base_dir=tmp_path).boundary["inlet"].traction
    assert isinstance(traction, float) is False
    assert [value_at(traction, t) for t in (0.0, 1.0)] == [2000.0, 3000.0]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (None, "there is no such table"),
        ("", "the table is empty"),
        ("0, 1\n1, 2\n", 'the column "0" has no unit; a header is needed, such as time [s], value'),
        ("time, force [kN/m]\n0, 1\n1, 2\n", 'the column "time" has no unit'),
        ("time [], force [kN/m]\n0, 1\n1, 2\n", "the unit is missing; a time"),
        ("time [s], force [mm]\n0, 1\n1, 2\n", '"force [mm]": this is a length; a load per length'),
        ("time [mm], force [kN/m]\n0, 1\n1, 2\n", '"time [mm]": this is a length; a time'),
        ("time [s], force [kX/m]\n0, 1\n1, 2\n", 'the unit "kX/m" is not known'),
        ("time [s], force [kN/m]\n0, 1\n# x\n1, two\n", 'line 4: "two" is not a number'),
        ("time [s], force [kN/m]\n0, 1\n1, nan\n", 'line 3: "nan" is not a number'),
        ("time [s], force [kN/m]\n0, 1\n1,\n", 'line 3: "" is not a number'),
        ("time [s], force [kN/m]\n0, 1\n1, 2, 3\n", "line 3 must have two columns, separated by a"),
        ("time [s]; force [kN/m]\n0; 1\n1; 2\n", "line 1 must have two columns, separated by a"),
        ("time [s], force [kN/m]\n0, 1\n", "at least two rows are needed under the header, not 1"),
        ("time [s], force [kN/m]\n0, 1\n2, 2\n2, 3\n", "line 4: the times must increase, but 2 s"),
        ("time [s], force [kN/m]\n-1, 1\n1, 2\n", "line 2: a time must not be negative"),
    ],
)
def test_what_is_wrong_with_a_table_is_said(tmp_path: Path, text: str | None, reason: str) -> None:
    with pytest.raises(SceneError) as caught:
        loaded(tmp_path, text)
    sentence = str(caught.value)
    assert sentence.startswith('load.force.table = "load.csv": ')
    assert reason in sentence
    assert "\n" not in sentence
    assert sentence.endswith(".")


def test_a_table_that_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "load.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SceneError, match="cannot be read: a CSV file in UTF-8 is needed"):
        loaded(tmp_path, None)
    (tmp_path / "load.csv").unlink()
    (tmp_path / "load.csv").mkdir()
    with pytest.raises(SceneError, match="cannot be read"):
        loaded(tmp_path, None)


@pytest.mark.parametrize(
    ("force", "sentence"),
    [
        ({"table": 3}, "load.force.table = 3: the path of a CSV file is needed."),
        (
            {"table": "load.csv", "times": []},
            'load.force.table = "load.csv": table and times are both given; keep one of them.',
        ),
        (
            {"table": "load.csv", "repeet": True},
            "load.force.repeet = true: there is no such key; did you mean load.force.repeat?",
        ),
        (
            {"tabel": "load.csv"},
            'load.force.tabel = "load.csv": there is no such key; did you mean load.force.table?',
        ),
        (
            {"table": "load.csv", "repeat": True},
            "with repeat = true the last value must equal the first",
        ),
    ],
)
def test_the_keys_of_a_table_are_checked(
    tmp_path: Path, force: dict[str, Any], sentence: str
) -> None:
    (tmp_path / "load.csv").write_text("time [s], force [kN/m]\n0, 1\n1, 2\n")
    with pytest.raises(SceneError) as caught:
        scene_from_dict(changed(ROLLING, load={"force": force}), base_dir=tmp_path)
    assert sentence in str(caught.value)


def test_a_load_is_a_force_in_three_dimensions(tmp_path: Path) -> None:
    (tmp_path / "load.csv").write_text("time [s], force [N]\n0, 1\n1, 2\n")
    tables = changed(CUBE, load={"force": {"table": "load.csv"}})
    load = scene_from_dict(tables, base_dir=tmp_path).load
    assert load is not None
    assert load.at(0.0) == 1.0
    with pytest.raises(SceneError, match="this is a force; a load per length"):
        loaded(tmp_path, None)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(st.floats(1e-6, 1e6), min_size=2, max_size=20, unique=True).map(sorted),
    st.lists(st.floats(0.1, 1e9), min_size=20, max_size=20),
)
def test_numbers_are_read_to_the_last_digit(
    tmp_path: Path, times: list[float], values: list[float]
) -> None:
    rows = [f"{t!r},{v!r}" for t, v in zip(times, values, strict=False)]
    scene = loaded(tmp_path, "\n".join(["t [s], F [N/m]", *rows]))
    assert scene.load is not None
    force: Any = scene.load.force
    assert list(force.times) == times
    assert list(force.values) == values[: len(times)]


def test_long_tables_are_read_in_a_moment(tmp_path: Path) -> None:
    rows = [f"{k / 1000!r}, {1 + k % 7}" for k in range(10_000)]
    begin = time.perf_counter()
    scene = loaded(tmp_path, "\n".join(["t [s], F [kN/m]", *rows]))
    write_resolved(scene, tmp_path / "resolved.toml")
    assert load_scene(tmp_path / "resolved.toml") == scene
    assert time.perf_counter() - begin < 10  # about half a second
