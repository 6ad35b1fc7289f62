"""Reading a sweep file: what it says, what is refused, and the file that stands alone."""

from pathlib import Path
from typing import Any

import pytest
import tomli_w

from porolub.errors import SceneError
from porolub.scene import scene_from_dict
from porolub.study.plan.cases import cases_of
from porolub.study.plan.sweep_file import (
    is_sweep,
    load_sweep,
    read_resolved_sweep,
    write_resolved_sweep,
)
from tests.scene.scenes import ROLLING, changed
from tests.study.sweeps import linear, log, sweep_of, write_sweep

FORCE = linear("load.force", "1 kN/m", "2 kN/m", 3)


def test_the_header_is_read_and_has_defaults(tmp_path: Path) -> None:
    plain = sweep_of(tmp_path, FORCE)
    assert (plain.title, plain.ranks_per_case) == ("untitled sweep", 1)
    assert (plain.start, plain.keep) == ("neighbour", "rows")
    assert plain.scene == tmp_path / "scene.toml"
    told = sweep_of(tmp_path, FORCE, title="T", ranks_per_case=2, start="zero", keep="results")
    assert (told.title, told.ranks_per_case, told.start, told.keep) == ("T", 2, "zero", "results")


def test_changes_are_made_in_order_and_the_case_comes_last(tmp_path: Path) -> None:
    path = write_sweep(tmp_path, FORCE, set=["mesh.along=7", "film=none"])
    sweep = load_sweep(path, ["mesh.along=9"])
    tables = sweep.tables({"load.force": "3 kN/m"})
    wanted = changed(ROLLING, film=None, mesh={"along": 9}, load={"force": "3 kN/m"})
    assert scene_from_dict(tables) == scene_from_dict(wanted)
    assert sweep.set == ("mesh.along=7", "film=none", "mesh.along=9")
    assert "film" not in sweep.base
    assert sweep.base["load"] == ROLLING["load"]  # tables() gives copies


def test_the_command_line_changes_the_sweep_itself_too(tmp_path: Path) -> None:
    path = write_sweep(tmp_path, FORCE)
    assert load_sweep(path, ["sweep.start=zero"]).start == "zero"
    with pytest.raises(SceneError, match='sweep.start = "none": allowed are neighbour, zero'):
        load_sweep(path, ["sweep.start=none"])


def test_sections_are_taken_away_kept_and_replaced(tmp_path: Path) -> None:
    film = {"key": "film", "values": [True, False, "none", {"viscosity": "1 Pa*s"}]}
    sweep = sweep_of(tmp_path, film)
    tables = [sweep.tables(sweep.axes[0].values(i)).get("film") for i in range(4)]
    assert tables == [ROLLING["film"], None, None, {"viscosity": "1 Pa*s"}]


def test_a_resolved_sweep_has_the_same_cases_and_needs_no_base_file(tmp_path: Path) -> None:
    axes = [
        log("load.force", "1 N/m", "4 kN/m", 7),
        {"key": ["film.viscosity", "pores.viscosity"], "name": "eta", "values": ["1 cP", "2 cP"]},
        {"key": "solid.base", "values": ["sliding", "bonded"]},
        {"key": "contact.friction", "values": [0.1, 0.2, 0.5]},
    ]
    sweep = sweep_of(tmp_path, *axes, set=["mesh.along=12"], keep="results", title='"quoted"')
    away = tmp_path / "elsewhere"
    away.mkdir()
    write_resolved_sweep(away / "sweep.resolved.toml", sweep)
    (tmp_path / "scene.toml").unlink()
    again = read_resolved_sweep(away / "sweep.resolved.toml")
    assert cases_of(again) == cases_of(sweep)
    assert again.resolved() == sweep.resolved()
    assert [a.scale for a in again.axes] == [a.scale for a in sweep.axes]


def test_files_are_found_from_anywhere(tmp_path: Path) -> None:
    (tmp_path / "load.csv").write_text("time [s], force [kN/m]\n0, 1\n1, 2\n")
    force = {"table": "load.csv"}
    sweep = sweep_of(tmp_path, {"key": "load.force", "values": [force]})
    tables = sweep.tables(sweep.axes[0].values(0))
    assert tables["load"]["force"]["table"] == str(tmp_path / "load.csv")
    based = sweep_of(tmp_path, {"key": "mesh.along", "values": [4]},
                     base=changed(ROLLING, load={"force": force}))  # fmt: skip
    assert based.base["load"]["force"]["table"] == str(tmp_path / "load.csv")
    meshes = sweep_of(tmp_path, {"key": "geometry.path", "values": ["a.msh", "../b.msh"]})
    assert meshes.axes[0].values(1) == {"geometry.path": str(tmp_path.parent / "b.msh")}


def test_is_sweep(tmp_path: Path) -> None:
    path = write_sweep(tmp_path, FORCE)
    (tmp_path / "broken.toml").write_text("[sweep")
    assert is_sweep(path)
    assert not any(is_sweep(tmp_path / f) for f in ("scene.toml", "broken.toml", "none.toml"))


@pytest.mark.parametrize(
    ("axis", "parts"),
    [
        ({"key": "load.force"}, ["axis 1: exactly one of linear, log and values", "none of them"]),
        (FORCE | {"values": [1]}, ["axis 1: exactly one of", "linear and values"]),
        (FORCE | {"scale": "log"}, ["axis 1: scale belongs to values"]),
        (FORCE | {"nmae": "x"}, ['axis 1: nmae = "x": there is no such key; did you mean name?']),
        ({"key": "load.force", "values": []}, ["axis 1: values = []", "array of values"]),
        ({"key": "load..force", "values": [1]}, ['axis 1: key = "load..force"', "a key of the"]),
        ({"key": ["a.b", "a.b"], "values": [1]}, ["axis 1: key", "once only"]),
        ({"values": [1]}, ["axis 1: key is missing"]),
        (FORCE | {"name": "a/b"}, ['axis 1: name = "a/b"', "without /"]),
        (linear("load.force", "1 N/m", "2 N/m", 1), ["axis 1: linear no. 1.count = 1: the value "
                                                     "must be at least 2"]),
        (linear("load.force", "1 N/m", "2 N/m", 2.5), ["a whole number is needed"]),
        (linear("load.force", True, "2 N/m", 2), ["axis 1: linear no. 1.from = true", "quantity"]),
        ({"key": "load.force", "linear": {"from": 1, "too": 2, "count": 3}},
         ["axis 1: linear no. 1.too = 2: there is no such key; did you mean to?"]),
        ({"key": "load.force", "linear": 3}, ["axis 1: linear = 3", "a table {from"]),
        (log("load.force", "0 N/m", "2 N/m", 2), ["axis 1 (force): from", "greater than 0"]),
    ],
)  # fmt: skip
def test_wrong_axes_are_named(tmp_path: Path, axis: dict[str, Any], parts: list[str]) -> None:
    with pytest.raises(SceneError) as caught:
        sweep_of(tmp_path, axis)
    assert all(part in str(caught.value) for part in parts), caught.value


@pytest.mark.parametrize(
    ("header", "parts"),
    [
        ({"ranks_per_case": 0}, ["sweep.ranks_per_case = 0: the value must be at least 1"]),
        ({"ranks_per_case": True}, ["sweep.ranks_per_case = true: a whole number"]),
        ({"keep": "row"}, ['sweep.keep = "row": allowed are rows, results (did you mean rows?)']),
        ({"scnee": "x"}, ["sweep.scnee", "did you mean scene?"]),
        ({"set": "mesh.along=3"}, ["sweep.set", "an array of changes"]),
        ({"set": ["mesh.along"]}, ['the override "mesh.along"', "section.key=value"]),
        ({"scene": "nowhere.toml"}, ["nowhere.toml: there is no such scene file"]),
        ({"scene": "sweep.toml"}, ["sweep.toml", "this is a sweep file; a scene is needed"]),
    ],
)
def test_wrong_headers_are_named(tmp_path: Path, header: dict[str, Any], parts: list[str]) -> None:
    with pytest.raises(SceneError) as caught:
        sweep_of(tmp_path, FORCE, **header)
    assert all(part in str(caught.value) for part in parts), caught.value


@pytest.mark.parametrize(
    ("tables", "parts"),
    [
        ({"axis": [FORCE]}, ["[sweep] is missing"]),
        ({"sweep": {"scene": "scene.toml"}}, ["[[axis]] is missing"]),
        ({"sweep": {}, "axis": [FORCE]}, ["sweep.scene and [base]", "neither"]),
        ({"sweep": {"scene": "x"}, "base": {}, "axis": [FORCE]}, ["both are given"]),
        ({"sweep": {"scene": "x"}, "axes": [FORCE]}, ["[axes]: there is no such section; "
                                                      "did you mean axis?"]),
    ],
)  # fmt: skip
def test_wrong_files_are_named(tmp_path: Path, tables: dict[str, Any], parts: list[str]) -> None:
    path = tmp_path / "sweep.toml"
    path.write_text(tomli_w.dumps(tables))
    with pytest.raises(SceneError) as caught:
        load_sweep(path)
    assert all(part in str(caught.value) for part in parts), caught.value


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="there is no such sweep file"):
        load_sweep(tmp_path / "nope.toml")


def test_a_single_axis_table_is_taken(tmp_path: Path) -> None:
    path = write_sweep(tmp_path, FORCE)
    path.write_text(path.read_text().replace("[[axis]]", "[axis]"))
    assert len(load_sweep(path).axes[0]) == 3


@pytest.mark.parametrize(
    ("other", "part"),
    [
        (FORCE | {"name": "again"}, "axes 1 and 2 both change load.force"),
        ({"key": "load", "values": [True]}, "axes 1 and 2 both change load.force"),
        ({"key": "load.force.mean", "values": [1]}, "axes 1 and 2 both change load.force.mean"),
        ({"key": "film.viscosity", "name": "force", "values": [1]}, 'both called "force"'),
        (linear("film.viscosity", 1, 2, 40_000), "3 x 40000 = 120000 cases"),
    ],
)
def test_axes_must_fit_together(tmp_path: Path, other: dict[str, Any], part: str) -> None:
    with pytest.raises(SceneError) as caught:
        sweep_of(tmp_path, FORCE, other)
    assert part in str(caught.value), caught.value


@pytest.mark.parametrize("override", ["load.force=3 kN/m", "load.force.mean=3 kN/m"])
def test_an_override_that_an_axis_would_undo_is_refused(tmp_path: Path, override: str) -> None:
    path = write_sweep(tmp_path, FORCE)
    with pytest.raises(SceneError, match="has no effect: axis 1 of the sweep sets load.force"):
        load_sweep(path, [override])
