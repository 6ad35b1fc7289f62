"""A scene's effects one at a time: each step is a scene, the last one is the scene itself."""

from typing import Any

import pytest
from hypothesis import given

from porolub.errors import SceneError
from porolub.scene import Scene, effects, load_scene, scene_from_dict
from porolub.study.accuracy.effect_steps import effect_steps
from porolub.study.plan.cases import cases_of
from porolub.study.plan.definition import Sweep
from porolub.study.plan.named_axis import named_axis
from tests.run.output import JOBS
from tests.scene.scenes import CUBE, ROLLING, changed, scene_tables


def scenes(scene: Scene) -> list[Scene]:
    """The steps as a sweep makes them; none of them refused."""
    axis = named_axis("effects", {step.name: step.values for step in effect_steps(scene)})
    cases = cases_of(Sweep("", scene.resolved(), (axis,), start="zero"))
    assert [case.refusal for case in cases if case.scene is None] == []
    return [case.scene for case in cases if case.scene is not None]


def names(scene: Scene) -> list[str]:
    return [step.name for step in effect_steps(scene)]


def test_case_1_with_all_that_can_be_added() -> None:
    scene = load_scene(JOBS / "case1_bonded.toml")
    assert names(scene) == [
        "solid, contact", "+ pores", "+ motion", "+ carry", "+ film", "+ friction traction",
    ]  # fmt: skip
    found = scenes(scene)
    assert effects(found[0]) == ["solid", "contact", "load"]
    assert effects(found[1]) == ["solid", "pores", "contact", "load"]
    assert "carry" not in effects(found[2])
    assert found[-1] == scene


def test_time_comes_last() -> None:
    scene = load_scene(JOBS / "case3.toml")
    assert names(scene)[-1] == "+ time"
    assert [s.time is None for s in scenes(scene)] == [True] * 5 + [False]


def test_what_is_no_scene_alone_is_added_with_the_next() -> None:
    tables = changed(ROLLING, contact=None)
    assert names(scene_from_dict(tables)) == ["solid, film", "+ pores", "+ motion", "+ carry"]
    moving = changed(CUBE, time={"end": "1 s"}, solid={"inertia": True, "density": "1 g/cm^3"})
    assert names(scene_from_dict(moving)) == ["solid, contact", "+ time", "+ inertia"]


def test_pressures_on_boundaries_come_with_the_pores() -> None:
    tables: dict[str, Any] = changed(ROLLING, boundary={"inlet": {"pressure": "1 kPa"}})
    found = scenes(scene_from_dict(tables))
    assert found[0].boundary["inlet"].pressure is None
    assert found[-1] == scene_from_dict(tables)


def test_one_effect_is_nothing_to_add() -> None:
    with pytest.raises(SceneError, match="one effect only"):
        effect_steps(scene_from_dict(CUBE))


@given(scene_tables())
def test_every_scene_comes_apart(tables: dict[str, Any]) -> None:
    scene = scene_from_dict(tables)
    try:
        found = scenes(scene)
    except SceneError:
        assert len(effects(scene)) <= 5
        return
    assert found[-1] == scene
    counts = [len(effects(s)) for s in found]
    assert counts == sorted(counts)
