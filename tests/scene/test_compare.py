"""What differs between two scenes, and what a restart may change."""

import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings

from porolub.scene import (
    MAY_CHANGE,
    differences,
    load_scene,
    scene_from_dict,
    write_resolved,
)
from tests.scene.scenes import ROLLING, changed, scene_tables

WAVE = {"mean": "1 kN/m", "amplitude": "0.5 kN/m", "frequency": "1 Hz"}
SWINGING = changed(ROLLING, load={"force": WAVE}, time={"end": "5 s"})


def between(**sections: Any) -> list[str]:
    one, other = SWINGING, changed(SWINGING, **sections)
    return differences(scene_from_dict(one).resolved(), scene_from_dict(other).resolved())


@pytest.mark.parametrize(
    ("sections", "keys"),
    [
        ({}, []),
        ({"load": {"force": WAVE | {"mean": "1000 N/m"}}}, []),
        ({"time": {"start": "steady"}}, []),
        ({"load": {"force": WAVE | {"mean": "2 kN/m"}}}, ["load.force.mean"]),
        ({"load": {"force": "1 kN/m"}}, ["load.force"]),
        ({"solid": {"shear_modulus": "1 MPa"}}, ["solid.shear_modulus"]),
        ({"time": {"order": 3}}, ["time.order"]),
        ({"time": {"start": "rest"}}, ["time.approach", "time.start"]),
        ({"film": None}, ["film"]),
        ({"time": None}, ["time"]),
        ({"boundary": {"inlet": {"pressure": "1 kPa"}}}, ["boundary"]),
        (
            {"mesh": {"along": 100}, "contact": {"friction": 0.1}},
            ["contact.friction", "mesh.along"],
        ),
    ],
)
def test_what_changes_the_answer_is_named_by_its_key(
    sections: dict[str, Any], keys: list[str]
) -> None:
    assert between(**sections) == keys


@pytest.mark.parametrize(
    "sections",
    [
        {"scene": {"title": "again"}},
        {"time": {"end": "7 s"}},
        {"time": {"until": "periodic", "repeat_tolerance": 0.1}},
        {"time": {"frames": 3}},
        {"time": {"step_max": "0.1 s", "first_step": "1 ms", "tolerance": 1e-4}},
    ],
)
def test_a_restart_may_change_how_far_and_how_finely_it_goes(sections: dict[str, Any]) -> None:
    assert between(**sections) == []


def test_keys_a_restart_may_change_are_keys_of_a_scene() -> None:
    full = {"step_max": "1 s", "first_step": "1 s", "repeat_tolerance": 0.1}
    tables = scene_from_dict(changed(SWINGING, time=full)).resolved()
    for key in MAY_CHANGE:
        section, _, name = key.partition(".")
        assert name in tables[section]


def test_samples_are_compared_entry_by_entry() -> None:
    ramp = {"times": ["0 s", "1 s"], "values": ["1 kN/m", "2 kN/m"]}
    one = scene_from_dict(changed(SWINGING, load={"force": ramp})).resolved()
    steeper = ramp | {"values": ["1 kN/m", "3 kN/m"]}
    other = scene_from_dict(changed(SWINGING, load={"force": steeper})).resolved()
    assert differences(one, other) == ["load.force.values"]
    assert differences(one, one) == []


@settings(deadline=None)
@given(scene_tables())
def test_a_scene_does_not_differ_from_the_file_it_was_written_to(
    tmp_path_factory: Any, tables: dict[str, Any]
) -> None:
    scene = scene_from_dict(tables)
    path: Path = tmp_path_factory.getbasetemp() / "before.toml"
    write_resolved(scene, path)
    before = tomllib.loads(path.read_text(encoding="utf-8"))
    assert differences(before, scene.resolved()) == []
    assert differences(before, load_scene(path).resolved()) == []


@settings(deadline=None)
@given(scene_tables(), scene_tables())
def test_scenes_that_do_not_differ_solve_the_same_problem(
    one: dict[str, Any], other: dict[str, Any]
) -> None:
    a, b = scene_from_dict(one).resolved(), scene_from_dict(other).resolved()
    found = differences(a, b)
    assert found == differences(b, a)
    for tables in (a, b):
        tables["scene"].pop("title")
        for key in MAY_CHANGE:
            tables.get("time", {}).pop(key.partition(".")[2], None)
    assert (a == b) == (found == [])
