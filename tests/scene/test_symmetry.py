"""Which sides are symmetry planes, and how a motion may lie to them."""

from typing import Any

import pytest

from porolub.errors import SceneError
from porolub.scene import scene_from_dict
from tests.scene.scenes import CUBE, ROLLING, changed

BARREL = changed(
    ROLLING,
    scene={"dimension": 3},
    geometry={"shape": "barrel", "width": "10 mm"},
    mesh={"deep": 4},
    load={"force": "15 N"},
)
CROWNED = changed(BARREL, geometry={"crown_radius": "200 mm"})
SLIDING = changed(
    CUBE, film={"viscosity": "1 mPa*s"}, motion={"kind": "sliding", "speed": "1 mm/s"}
)


@pytest.mark.parametrize(
    ("tables", "planes"),
    [(BARREL, ("front", "back")), (CROWNED, ()), (CUBE, ("front", "back")), (ROLLING, ())],
)
def test_what_is_straight_is_a_slice_and_a_crown_has_ends(
    tables: dict[str, Any], planes: tuple[str, ...]
) -> None:
    scene = scene_from_dict(tables)
    assert scene.geometry.symmetry == planes
    assert scene.resolved()["geometry"]["symmetry"] == list(planes)
    given = changed(tables, geometry={"symmetry": list(planes)})
    assert scene_from_dict(given) == scene


@pytest.mark.parametrize(
    ("planes", "half"),
    [(["front"], "front"), (["back"], "back"), ([], None), (["front", "back"], None)],
)
@pytest.mark.parametrize("tables", [BARREL, CROWNED])
def test_one_plane_halves_a_barrel(
    tables: dict[str, Any], planes: list[str], half: str | None
) -> None:
    scene = scene_from_dict(changed(tables, geometry={"symmetry": planes}))
    assert scene.geometry.half == half


def refusal(tables: dict[str, Any]) -> str:
    with pytest.raises(SceneError) as caught:
        scene_from_dict(tables)
    return str(caught.value)


@pytest.mark.parametrize(
    ("tables", "value", "parts"),
    [
        (CROWNED, "front", ["geometry.symmetry", "names of boundaries are needed"]),
        (CROWNED, [1], ["geometry.symmetry", "names of boundaries are needed"]),
        (CROWNED, ["frnt"], ['"frnt" is no boundary', "did you mean front?"]),
        (CUBE, ["inlet"], ['"inlet" is no boundary', "left, right, front, back"]),
        (ROLLING, ["front"], ['"front" is no boundary', "allowed are inlet, outlet"]),
        (CROWNED, ["lubricated"], ["cannot be a symmetry plane"]),
        (CUBE, ["bottom"], ["cannot be a symmetry plane"]),
        (CROWNED, ["back", "back"], ['"back" is named twice']),
        (CROWNED, ["outlet", "front"], ['motion.axis = "z"', "moves through outlet,", '["front"]']),
    ],
)
def test_what_is_no_symmetry_plane(tables: dict[str, Any], value: Any, parts: list[str]) -> None:
    text = refusal(changed(tables, geometry={"symmetry": value}))
    assert all(part in text for part in parts), text
    assert "\n" not in text


@pytest.mark.parametrize("direction", ["z", [0.3, 0.0, 1.0]])
def test_a_plane_slides_along_symmetry_planes_only(direction: Any) -> None:
    tables = changed(SLIDING, motion={"direction": direction})
    text = refusal(tables)
    assert "moves through front and back, which are symmetry planes" in text
    assert "geometry.symmetry = []" in text
    scene_from_dict(changed(tables, geometry={"symmetry": []}))


def test_the_sides_of_a_plane_problem_can_be_planes() -> None:
    at_rest = changed(
        SLIDING,
        scene={"dimension": 2},
        motion=None,
        mesh={"deep": None},
        load={"force": "3 kN/m"},
        geometry={"symmetry": ["left"], "depth": None},
    )
    assert scene_from_dict(at_rest).geometry.symmetry == ("left",)
    moving = changed(at_rest, motion={"kind": "sliding", "speed": "1 mm/s"})
    assert "moves through left" in refusal(moving)
