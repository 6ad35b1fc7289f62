"""What an accuracy study varies: levels around the scene's own, strategies that are scenes."""

from typing import Any

import pytest

from porolub.errors import SceneError
from porolub.scene import Scene, load_scene, scene_from_dict
from porolub.study.accuracy.strategies import Setting, read_varied, settings_of
from porolub.study.plan.cases import cases_of
from porolub.study.plan.definition import Sweep
from porolub.study.plan.named_axis import named_axis
from tests.run.output import JOBS
from tests.scene.scenes import CUBE, ROLLING, changed

TIME = {"end": "1 s", "tolerance": 1e-3}


def scene(base: dict[str, Any] = ROLLING, **sections: Any) -> Scene:
    return scene_from_dict(changed(base, **sections))


def cases(scene: Scene, settings: list[Setting]) -> list[Scene]:
    """The scenes of the settings, as a sweep makes them."""
    axis = named_axis("setting", {s.name: s.values for s in settings})
    found = [case.scene for case in cases_of(Sweep("", scene.resolved(), (axis,), start="zero"))]
    return [case for case in found if case is not None]


def test_meshes_double_and_the_own_is_the_last_but_one() -> None:
    own = scene()
    settings = settings_of(own, ["mesh"], 4)
    assert [s.name for s in settings[:4]] == [
        "uniform, 75 x 8", "uniform, 150 x 15", "uniform, 300 x 30", "uniform, 600 x 60",
    ]  # fmt: skip
    assert [s.strategy for s in settings[4:]] == ["graded"] * 4
    assert settings[2].changes == ()
    assert settings[2].size == 1
    assert settings[3].size == 0.5
    found = cases(own, settings)
    assert len(found) == 8
    assert [s.mesh.along for s in found] == [75, 150, 300, 600] * 2
    assert [s.mesh.grading for s in found] == ["none"] * 4 + ["contact"] * 4
    assert found[2] == own


def test_a_graded_mesh_is_refined_at_its_edges_too() -> None:
    own = scene(mesh={"grading": "contact", "edge_size": "8 um"})
    settings = settings_of(own, ["mesh"], 3)
    sizes = [s.mesh.edge_size for s in cases(own, settings)]
    assert sizes == [None, None, None, pytest.approx(16e-6), pytest.approx(8e-6),
                     pytest.approx(4e-6)]  # fmt: skip


def test_changes_make_the_scene_of_the_setting() -> None:
    path = JOBS / "case1.toml"
    own = load_scene(path)
    settings = settings_of(own, ["mesh", "degree"], 3)
    for setting, case in zip(settings, cases(own, settings), strict=True):
        assert load_scene(path, setting.changes) == case
    assert settings[-1].options.startswith("--set mesh.grading=contact --set mesh.pressure_degree")
    assert "--set 'mesh.edge_size=5 um'" in settings[-1].options


@pytest.mark.parametrize(
    ("sections", "expected"),
    [
        ({}, ["Q1/Q1", "Q2/Q1", "Q2/Q2"]),
        ({"time": TIME}, ["Q2/Q1", "Q2/Q2"]),
        ({"pores": None, "film": None}, ["Q1", "Q2"]),
        ({"mesh": {"element": "triangle"}}, ["P1/P1", "P2/P1", "P2/P2"]),
    ],
)
def test_degrees_are_those_the_scene_allows(sections: dict[str, Any], expected: list[str]) -> None:
    settings = settings_of(scene(**sections), ["degree"], 3)
    assert list(dict.fromkeys(s.strategy for s in settings)) == expected
    assert len(settings) == 3 * len(expected)


def test_tolerances_fall_tenfold_and_the_own_is_the_second() -> None:
    settings = settings_of(scene(time=TIME), ["time", "tolerance"], 4)
    assert [s.name for s in settings[:4]] == [
        "BDF1, 0.01", "BDF1, 0.001", "BDF1, 0.0001", "BDF1, 1e-05"
    ]  # fmt: skip
    assert [s.strategy for s in settings[::4]] == ["BDF1", "BDF2", "BDF3"]
    assert [s.size for s in settings[:4]] == pytest.approx([10, 1, 0.1, 0.01])
    assert settings[5].changes == ()
    assert settings[9].changes == ("time.order=3",)
    loose = settings_of(scene(time=TIME | {"tolerance": 0.2}), ["tolerance"], 3)
    assert [s.name for s in loose] == ["BDF2, 0.2", "BDF2, 0.02", "BDF2, 0.002"]


def test_mesh_and_tolerance_are_refined_together() -> None:
    settings = settings_of(scene(time=TIME), ["mesh", "tolerance"], 3)
    assert [s.level for s in settings[:3]] == [
        "150 x 15, 0.01", "300 x 30, 0.001", "600 x 60, 0.0001"
    ]  # fmt: skip


def test_settings_that_are_no_scene_are_left_out() -> None:
    inertia = scene(time=TIME, solid={"inertia": True, "density": "1 g/cm^3"})
    settings = settings_of(inertia, ["time"], 3)
    assert {s.strategy for s in settings} == {"BDF1", "BDF2"}
    fluid_only = scene(CUBE, contact=None, load=None)
    assert {s.strategy for s in settings_of(fluid_only, ["mesh"], 3)} == {"uniform"}


def test_meshes_that_are_the_same_stand_there_once() -> None:
    tiny = scene(mesh={"along": 2, "across": 1})
    assert [s.level for s in settings_of(tiny, ["mesh"], 5)[:3]] == ["1 x 1", "2 x 1", "4 x 2"]


def test_bodies_are_refined_each_way() -> None:
    settings = settings_of(scene(CUBE), ["mesh"], 3)
    assert [s.level for s in settings[:3]] == ["2 x 1 x 2", "4 x 2 x 3", "8 x 4 x 6"]


def test_what_is_varied_has_defaults_and_is_checked() -> None:
    steady, transient = scene(), scene(time=TIME)
    assert read_varied("", steady) == ("mesh",)
    assert read_varied("", transient) == ("time", "tolerance")
    assert read_varied(" degree, mesh,mesh", steady) == ("degree", "mesh")
    with pytest.raises(SceneError, match="--vary grid: allowed are mesh, degree, time, tolerance"):
        read_varied("grid", steady)
    with pytest.raises(SceneError, match=r"--vary tolerance: the scene has no \[time\] section"):
        read_varied("tolerance", steady)
    with pytest.raises(SceneError, match="--levels 2: a whole number from 3 to 8"):
        settings_of(steady, ["mesh"], 2)


def test_a_mesh_file_cannot_be_refined() -> None:
    own = load_scene(JOBS / "case1_file.toml")
    with pytest.raises(SceneError, match="a mesh file is used as it is"):
        settings_of(own, ["mesh"], 3)
