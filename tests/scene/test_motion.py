"""Directions, axes and centres of the motion: what is read and what is refused."""

from typing import Any

import pytest

from porolub.errors import SceneError
from porolub.scene import scene_from_dict
from porolub.scene.derived import surface_speed
from tests.scene.scenes import CUBE, ROLLING, changed
from tests.scene.test_symmetry import CROWNED

SLIDING = changed(
    CUBE,
    geometry={"symmetry": []},
    film={"viscosity": "1 mPa*s"},
    motion={"kind": "sliding", "speed": "1 mm/s"},
)
SPINNING = changed(SLIDING, motion={"kind": "rotation", "speed": "1 rad/s", "axis": "y"})


def refusal(tables: dict[str, Any]) -> str:
    with pytest.raises(SceneError) as caught:
        scene_from_dict(tables)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("direction", ["x", "z", (1.0, 0.0, 0.5), (-2.0, 0.0, 0.0)])
def test_the_plane_slides_any_way_in_itself(direction: Any) -> None:
    scene = scene_from_dict(changed(SLIDING, motion={"direction": direction}))
    assert scene.motion is not None
    assert scene.motion.direction == direction
    assert scene_from_dict(scene.resolved()) == scene


@pytest.mark.parametrize(
    ("direction", "parts"),
    [
        ("y", ['motion.direction = "y"', "must lie in the rigid plane", "[0.0, 1.0, 0.0]"]),
        ([1.0, 0.1, 0.0], ["must lie in the rigid plane"]),
        ("up", ['motion.direction = "up"', "allowed are x, y, z or a direction"]),
        ([1.0, 0.0], ["must have 3 components", "scene.dimension = 3"]),
        ([0.0, 0.0, 0.0], ["a direction is needed"]),
        (1.0, ["a direction is needed"]),
    ],
)
def test_directions_out_of_the_plane_are_refused(direction: Any, parts: list[str]) -> None:
    text = refusal(changed(SLIDING, motion={"direction": direction}))
    assert all(part in text for part in parts), text


def test_a_plane_problem_has_one_axis_and_one_direction() -> None:
    assert "allowed here: z" in refusal(changed(ROLLING, motion={"axis": "x"}))
    assert "axis" not in scene_from_dict(ROLLING).resolved()["motion"]
    two = changed(ROLLING, motion={"centre": ["0 mm", "100 mm", "0 mm"]})
    assert "motion.centre must have 2 entries" in refusal(two)
    still = changed(ROLLING, pores={"carry": False})
    slides = {"kind": "sliding", "speed": "1 m/s"}
    assert scene_from_dict(changed(still, motion=slides | {"direction": [-1.0, 0.0]}))
    text = refusal(changed(still, motion=slides | {"direction": [0.0, 1.0]}))
    assert "must lie in the rigid plane" in text


def test_a_block_turns_where_it_is_told_to() -> None:
    assert "needs a shape with an axis" in refusal(SPINNING)
    scene = scene_from_dict(changed(SPINNING, motion={"centre": ["1 mm", "0 m", "2 cm"]}))
    assert scene.motion is not None
    assert scene.motion.kind == "rotation"
    assert scene.motion.centre == (1e-3, 0.0, 2e-2)
    assert scene_from_dict(scene.resolved()) == scene


@pytest.mark.parametrize(
    ("keys", "parts"),
    [
        ({"axis": [1.0, 0.0]}, ["motion.axis", "must have 3 components"]),
        ({"axis": "w"}, ["motion.axis", "allowed are x, y, z"]),
        ({"centre": ["0 mm", "100 mm"]}, ["motion.centre must have 3 entries", "it has 2"]),
        ({"centre": ["0 mm", "100 mm", 0.0]}, ["motion.centre (no. 3)", "a plain number"]),
        ({"centre": "0 mm"}, ["motion.centre", "an array in brackets is needed"]),
        ({"centre": ["1 s", "0 m", "0 m"]}, ["motion.centre (no. 1)", "a length is needed"]),
    ],
)
def test_axes_and_centres_that_are_none(keys: dict[str, Any], parts: list[str]) -> None:
    text = refusal(changed(CROWNED, motion=keys))
    assert all(part in text for part in parts), text


def test_the_surface_speed_is_that_about_the_shape_s_own_axis() -> None:
    assert surface_speed(scene_from_dict(CROWNED)) == pytest.approx(0.1)
    back = scene_from_dict(changed(CROWNED, motion={"axis": [0.0, 0.0, -2.0]}))
    assert surface_speed(back) == pytest.approx(0.1)
    for other in ({"axis": [0.0, 1.0, 1.0]}, {"centre": ["0 m", "0 m", "0 m"]}):
        assert surface_speed(scene_from_dict(changed(CROWNED, motion=other))) is None
