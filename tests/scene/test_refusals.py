"""What a scene cannot be: each mistake is answered by its key, its value and what is allowed."""

from typing import Any

import pytest

from porolub.errors import SceneError
from porolub.scene import scene_from_dict
from tests.scene.scenes import CUBE, ROLLING, changed


def refusal(tables: dict[str, Any]) -> str:
    with pytest.raises(SceneError) as caught:
        scene_from_dict(tables)
    return str(caught.value)


@pytest.mark.parametrize(
    ("section", "key", "value", "parts"),
    [
        # a unit is missing, unknown or of the wrong dimension
        ("geometry", "thickness", 1, ["= 1:", "plain number has no unit", '"1 mm"']),
        ("geometry", "thickness", "1 mmm", ['= "1 mmm":', '"mmm" is not known']),
        ("solid", "shear_modulus", "0.5 mm", ['= "0.5 mm":', "a length", "a pressure", "MPa"]),
        ("solid", "shear_modulus", True, ["= true:", "a pressure is needed"]),
        ("pores", "permeability", "1 mm", ["a length", "a permeability", "um^3/mm"]),
        ("motion", "speed", "1 m/s", ["a speed", "an angular speed", "rad/s"]),
        ("motion", "speed", "1 Hz", ["a frequency", "an angular speed"]),
        ("load", "force", "3 kN", ["a force", "a load per length", "kN/m"]),
        # out of range
        ("solid", "shear_modulus", "0 Pa", ['= "0 Pa":', "greater than 0"]),
        ("solid", "bulk_modulus", "-5 MPa", ['= "-5 MPa":', "greater than 0"]),
        ("solid", "density", "0 kg/m^3", ["greater than 0"]),
        ("geometry", "half_angle", "90 deg", ["greater than 0 and less than 90 deg"]),
        ("geometry", "half_angle", "0 deg", ["greater than 0 and less than 90 deg"]),
        ("pores", "biot", 1.5, ["= 1.5:", "greater than 0 and at most 1"]),
        ("pores", "biot", 0.0, ["greater than 0 and at most 1"]),
        ("pores", "permeability", "0 m^2", ["greater than 0"]),
        ("pores", "viscosity", "-1 mPa*s", ["greater than 0"]),
        ("pores", "storage", "-1 1/GPa", ["at least 0"]),
        ("film", "viscosity", "0 Pa*s", ["greater than 0"]),
        ("film", "shear_film_min", "0 um", ["greater than 0"]),
        ("contact", "friction", -0.1, ["= -0.1:", "at least 0"]),
        ("load", "force", "-1 kN/m", ["greater than 0"]),
        ("mesh", "along", 0, ["= 0:", "at least 1"]),
        ("time", "end", "0 s", ["greater than 0"]),
        ("time", "tolerance", 1.0, ["greater than 0 and less than 1"]),
        ("time", "order", 4, ["allowed are 1, 2, 3"]),
        # of the wrong type
        ("mesh", "along", "300", ['= "300":', "whole number"]),
        ("mesh", "across", 30.0, ["= 30.0:", "whole number"]),
        ("mesh", "degree", True, ["= true:", "whole number"]),
        ("pores", "carry", "yes", ['= "yes":', "true or false"]),
        ("scene", "title", 3, ["= 3:", "text"]),
        ("geometry", "thickness", ["1 mm"], ['= ["1 mm"]:', "a length is needed"]),
        ("motion", "speed", {"mean": 1}, ["motion.speed.mean = 1:", "an angular speed"]),
        # not among the choices
        ("scene", "dimension", 4, ["= 4:", "allowed are 2, 3"]),
        ("geometry", "shape", "sectr", ['= "sectr":', "sector, block", "did you mean sector?"]),
        ("mesh", "degree", 3, ["= 3:", "allowed are 1, 2"]),
        ("mesh", "grading", "contacts", ["none, contact", "did you mean contact?"]),
        ("solid", "law", "neo-hooke", ["linear, neo-hookean", "did you mean neo-hookean?"]),
        ("solid", "base", "glued", ['= "glued":', "allowed are sliding, bonded"]),
        ("motion", "kind", "rotating", ['= "rotating":', "did you mean rotation?"]),
        ("conventions", "frame", "deformed", ["allowed are spatial, material"]),
        ("conventions", "surface_traction", "exact", ["allowed are balanced, paper"]),
        ("conventions", "entering", "old", ["allowed are computed, fresh"]),
    ],
)
def test_a_wrong_value_is_named_with_what_is_allowed(
    section: str, key: str, value: Any, parts: list[str]
) -> None:
    start = {"time": {"end": "1 s"}} if section == "time" else {}
    text = refusal(changed(ROLLING | start, **{section: {key: value}}))
    assert text.startswith(f"{section}.{key}")
    assert "\n" not in text or section == "motion"
    assert all(part in text for part in parts), text


@pytest.mark.parametrize(
    ("section", "key", "hint"),
    [
        ("solid", "shear_modulos", "did you mean solid.shear_modulus?"),
        ("mesh", "alon", "did you mean mesh.along?"),
        ("boundary", "inlt", "did you mean boundary.inlet?"),
        ("pores", "friction", "did you mean contact.friction?"),
        ("motion", "direction", 'allowed for kind = "rotation" are kind, speed'),
        ("film", "colour", "allowed are viscosity, shear_film_min, squeeze, fluid_density"),
    ],
)
def test_an_unknown_key_is_answered_by_the_nearest_valid_one(
    section: str, key: str, hint: str
) -> None:
    value: Any = {"pressure": "0 Pa"} if section == "boundary" else "1 mm"
    text = refusal(changed(ROLLING, **{section: {key: value}}))
    assert f"{section}.{key}" in text
    assert hint in text


def test_unknown_keys_within_keys_are_found_too() -> None:
    speed = {"mean": "1 rad/s", "amplitud": "1 rad/s", "frequency": "1 Hz"}
    text = refusal(changed(ROLLING, motion={"speed": speed}))
    assert text == (
        'motion.speed.amplitud = "1 rad/s": there is no such key; '
        "did you mean motion.speed.amplitude?"
    )
    inlet = {"displacement": {"norml": "0 mm"}}
    text = refusal(changed(ROLLING, boundary={"inlet": inlet}))
    assert "did you mean boundary.inlet.displacement.normal?" in text
    inlet = {"traction": {"q": "0 Pa"}}
    text = refusal(changed(ROLLING, boundary={"inlet": inlet}))
    assert "boundary.inlet.traction.q" in text
    assert "allowed are x, y, z" in text


def test_unknown_sections_are_answered_by_the_nearest_valid_one() -> None:
    assert refusal(ROLLING | {"sold": {}}) == (
        "[sold]: there is no such section; did you mean [solid]?"
    )
    assert "did you mean contact.friction?" in refusal(ROLLING | {"friction": 0.4})
    assert "allowed are scene, geometry" in refusal(ROLLING | {"weather": {}})


@pytest.mark.parametrize(
    ("section", "key", "parts"),
    [
        ("geometry", "thickness", ["a length is needed", '"1 mm"']),
        ("geometry", "shape", ["allowed are sector, block, barrel, file"]),
        ("mesh", "along", ["a number of elements", "30"]),
        ("solid", "law", ["allowed are linear, neo-hookean"]),
        ("pores", "biot", ["a number is needed, such as 0.5"]),
        ("pores", "permeability", ["a permeability", "um^3/mm"]),
        ("film", "viscosity", ["a dynamic viscosity"]),
        ("motion", "kind", ["allowed are rotation, sliding"]),
        ("motion", "speed", ["an angular speed is needed"]),
    ],
)
def test_a_missing_key_is_named_with_an_example(section: str, key: str, parts: list[str]) -> None:
    text = refusal(changed(ROLLING, **{section: {key: None}}))
    assert text.startswith(f"{section}.{key} is missing")
    assert all(part in text for part in parts), text


def test_missing_sections_and_tables_are_named() -> None:
    assert refusal({}).startswith("[geometry] is missing: geometry.shape is one of sector, block")
    assert "[mesh] = 3: a table of keys is needed" in refusal(ROLLING | {"mesh": 3})
    assert "[geometry] = 3: a table of keys is needed" in refusal(ROLLING | {"geometry": 3})


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ({"solid": {"shear_modulus": None}}, ["solid.young_modulus", "given: solid.bulk_modulus"]),
        (
            {"solid": {"young_modulus": "1 MPa"}},
            ["given: solid.bulk_modulus, solid.shear_modulus, solid.young_modulus"],
        ),
        ({"geometry": {"thickness": "100 mm"}}, ["geometry.thickness = 0.1 m", "outer_radius"]),
        ({"mesh": {"degree": 1, "pressure_degree": 2}}, ["mesh.pressure_degree = 2", "degree = 1"]),
        ({"mesh": {"edge_size": "5 um"}}, ["mesh.edge_size", "mesh.grading", '"contact"']),
        ({"mesh": {"deep": 3}}, ["mesh.deep = 3", "scene.dimension = 2"]),
        (
            {"mesh": {"grading": "contact"}, "film": None, "contact": None, "load": None},
            ['mesh.grading = "contact"', "[contact] or [film]"],
        ),
        ({"solid": None, "contact": None}, ["[pores] needs a [solid] section"]),
        ({"solid": None, "pores": None}, ["[contact] needs a [solid] section"]),
        (
            dict.fromkeys(("solid", "pores", "contact", "film", "load")),
            ["[solid] is missing", "[film] is needed"],
        ),
        ({"film": None, "contact": None}, ["[load] needs [contact] or [film]"]),
        ({"load": None}, ["[load] is missing", "load.force or load.approach"]),
        ({"load": {"approach": "50 um"}}, ["exactly one of load.force and load.approach", "both"]),
        ({"load": {"force": None}}, ["exactly one of load.force and load.approach", "neither"]),
        ({"film": {"fluid_density": "900 kg/m^3"}}, ["film.fluid_density = 900 kg/m^3", "pores"]),
        ({"motion": None}, ["pores.carry = true", 'motion.kind = "rotation"']),
        ({"motion": {"kind": "sliding", "speed": "1 m/s"}}, ["pores.carry = true"]),
        (
            {"motion": None, "pores": {"carry": False}, "contact": {"friction_traction": True}},
            ["contact.friction_traction = true", "[motion]"],
        ),
        (
            {
                "motion": {"kind": "sliding", "speed": "1 m/s", "direction": "z"},
                "pores": {"carry": False},
            },
            ['motion.direction = "z"', "scene.dimension = 3"],
        ),
        ({"boundary": {"lubricated": {"pressure": "0 Pa"}}}, ["[boundary.lubricated]", "[film]"]),
        (
            {"boundary": {"inlet": {"pressure": "0 Pa"}}, "pores": None},
            ["boundary.inlet.pressure", "[pores]"],
        ),
        (
            {"boundary": {"inlet": {"displacement": {"z": "0 m"}}}},
            ["boundary.inlet.displacement.z", "scene.dimension = 2"],
        ),
        (
            {"boundary": {"inlet": {"displacement": {"normal": "0 m", "x": "0 m"}}}},
            ["[boundary.inlet]", "normal and by x, y, z"],
        ),
        (
            {"boundary": {"inlet": {"displacement": {"normal": "0 m"}, "traction": "1 Pa"}}},
            ["[boundary.inlet]", "traction and displacement.normal"],
        ),
        (
            {"boundary": {"inlet": {"displacement": {"y": "0 m"}, "traction": {"y": "1 Pa"}}}},
            ["[boundary.inlet]", "traction and displacement.y"],
        ),
        (
            {
                "boundary": {"inlet": {"traction": "1 Pa"}},
                "solid": None,
                "pores": None,
                "contact": None,
            },
            ["[boundary.inlet]", "[solid]"],
        ),
    ],
)
def test_parts_that_do_not_fit_together_are_refused(
    changes: dict[str, Any], parts: list[str]
) -> None:
    text = refusal(changed(ROLLING, **changes))
    assert "\n" not in text
    assert text.endswith(".")
    assert all(part in text for part in parts), text


@pytest.mark.parametrize(
    ("tables", "parts"),
    [
        (
            changed(ROLLING, scene={"dimension": 3}, load={"force": "1 N"}),
            ["block, barrel or file"],
        ),
        (changed(ROLLING, scene={"dimension": 3}), ["a load per length", "a force"]),
        (changed(CUBE, geometry={"depth": None}), ["geometry.depth is missing"]),
        (changed(CUBE, mesh={"deep": None}), ["mesh.deep is missing"]),
        (changed(CUBE, mesh={"element": "triangle"}), ['mesh.element = "triangle"', "quad"]),
        (changed(CUBE, load={"force": "3 kN/m"}), ["a load per length", "a force"]),
        (changed(CUBE, motion={"kind": "rotation", "speed": "1 rad/s"}), ["shape with an axis"]),
        (
            changed(CUBE, scene={"dimension": 2}, load={"force": "3 kN/m"}, mesh={"deep": None}),
            ["geometry.depth", "scene.dimension = 2"],
        ),
        (
            CUBE
            | {
                "geometry": {
                    "shape": "barrel",
                    "outer_radius": "100 mm",
                    "thickness": "1 mm",
                    "half_angle": "5 deg",
                    "width": "10 mm",
                    "crown_radius": "4 mm",
                }
            },
            ["geometry.crown_radius", "geometry.width"],
        ),
    ],
)
def test_dimension_and_shape_must_fit(tables: dict[str, Any], parts: list[str]) -> None:
    text = refusal(tables)
    assert all(part in text for part in parts), text


def test_several_mistakes_are_reported_together_one_a_line() -> None:
    text = refusal(changed(ROLLING, solid={"base": "glued"}, mesh={"along": -1}))
    assert [line.split(" ")[0] for line in text.splitlines()] == ["mesh.along", "solid.base"]


def test_at_most_five_mistakes_are_reported_and_the_rest_counted() -> None:
    lines = refusal(changed(ROLLING, film={f"k{i}": i for i in range(7)})).splitlines()
    assert len(lines) == 6
    assert lines[-1] == "... and 2 more."


def test_long_values_are_shortened() -> None:
    text = refusal(changed(ROLLING, solid={"base": "x" * 500}))
    assert len(text) < 200
