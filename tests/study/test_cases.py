"""Cases: every combination of the axes is a scene, or a row that says why it is none."""

import hashlib
import time
from pathlib import Path

import pytest

from porolub.errors import SceneError
from porolub.scene import scene_from_dict
from porolub.study.plan.cases import cases_of
from tests.scene.scenes import ROLLING, changed
from tests.study.sweeps import cases_along, linear, log, sweep_of

FORCE = linear("load.force", "1 kN/m", "3 kN/m", 3)
SPEED = log("motion.speed", "0.1 rad/s", "10 rad/s", 5)
TIME = {"end": "1 s"}
MESH = Path(__file__).resolve().parents[2] / "meshes" / "sector.msh"
FILE = {**ROLLING, "geometry": {"shape": "file", "path": str(MESH)}, "mesh": {}}


def test_the_last_axis_is_the_fastest(tmp_path: Path) -> None:
    cases = cases_along(tmp_path, FORCE, {"key": "solid.base", "values": ["sliding", "bonded"]})
    assert [case.index for case in cases] == list(range(6))
    assert [case.position for case in cases] == [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)]
    assert cases[3].values == {"load.force": "2 kN/m", "solid.base": "bonded"}
    assert cases[3].axes == {"force": 2000.0, "base": "bonded"}
    wanted = changed(ROLLING, load={"force": "2 kN/m"}, solid={"base": "bonded"})
    assert cases[3].scene == scene_from_dict(wanted)
    assert cases[3].refusal == ""


def test_the_key_is_that_of_the_scene_alone(tmp_path: Path) -> None:
    cases = cases_along(tmp_path, FORCE)
    assert all(case.scene is not None and case.key == case.scene.digest() for case in cases)
    finer = cases_along(tmp_path, linear("load.force", "1 kN/m", "3 kN/m", 5), title="finer")
    assert [case.key for case in finer[::2]] == [case.key for case in cases]


def test_what_a_digest_leaves_out_counts_where_it_is_swept(tmp_path: Path) -> None:
    presets = {"key": "solver.preset", "values": ["direct", "fieldsplit"]}
    assert len({case.key for case in cases_along(tmp_path, presets)}) == 2
    transient = changed(ROLLING, time=TIME)
    ends = cases_along(tmp_path, {"key": "time.end", "values": ["1 s", "2 s"]}, base=transient)
    assert len({case.key for case in ends}) == 2
    longer = cases_along(tmp_path, FORCE, base=changed(ROLLING, time={"end": "2 s"}))
    assert longer[0].key != cases_along(tmp_path, FORCE, base=transient)[0].key


@pytest.mark.parametrize(
    ("key", "values", "reason"),
    [
        ("geometry.thickness", ["1 mm", "-1 mm"], "geometry.thickness = \"-1 mm\": the value must"),
        ("load.force", ["1 kN/m", "3 m"], 'load.force = "3 m": this is a length'),
        ("geometry.outer_radius", ["100 mm", "0.5 mm"], "must be less than geometry.outer_radius"),
        ("load.approach", ["", "1 um"], "exactly one of load.force and load.approach"),
    ],
)  # fmt: skip
def test_a_refused_value_is_a_case_without_a_scene(
    tmp_path: Path, key: str, values: list[str], reason: str
) -> None:
    good, bad = cases_along(tmp_path, {"key": key, "values": values})
    assert good.scene is not None
    assert bad.scene is None
    assert reason in bad.refusal
    assert bad.parents == ()
    assert bad.key == cases_along(tmp_path, {"key": key, "values": values})[1].key
    assert len(bad.key) == len(hashlib.sha256().hexdigest())


def test_where_every_value_is_refused_there_are_still_rows(tmp_path: Path) -> None:
    cases = cases_along(tmp_path, {"key": "geometry.thickness", "values": ["-1 mm", "-2 mm"]})
    assert [case.scene for case in cases] == [None, None]
    assert cases[0].key != cases[1].key


@pytest.mark.parametrize(
    ("key", "part"),
    [
        ("load.froce", "load.froce = 1: there is no such key; did you mean load.force?"),
        ("laod.force", "[laod]: there is no such section; did you mean [load]?"),
        ("motion.centre.x", "motion.centre.x cannot be set: motion.centre is no table of keys"),
        ("geometry.width", "geometry.width = 1: there is no such key; allowed for shape"),
    ],
)
def test_a_key_that_no_scene_knows_is_an_error_at_once(tmp_path: Path, key: str, part: str) -> None:
    base = changed(ROLLING, motion={"centre": ["0 mm", "0 mm"]})
    with pytest.raises(SceneError) as caught:
        cases_along(tmp_path, {"key": key, "values": [1, 2]}, base=base)
    assert part in str(caught.value)


def test_a_key_that_only_some_shapes_know_makes_rows(tmp_path: Path) -> None:
    block = {"shape": "block", "width": "10 mm", "thickness": "1 mm"}
    shapes = {"key": "geometry", "values": [True, block]}
    cases = cases_along(tmp_path, shapes, set=["geometry.half_angle=4 deg", "motion=none",
                                               "pores.carry=false"])  # fmt: skip
    assert all(case.scene is not None for case in cases)
    angles = {"key": "geometry.half_angle", "values": ["4 deg", "5 deg"]}
    kinds = {"key": "geometry.shape", "values": ["sector", "block"]}
    mixed = cases_along(tmp_path, kinds, angles)
    assert [case.scene is not None for case in mixed] == [True, True, False, False]


def test_a_misspelt_key_of_the_base_scene_is_an_error_at_once(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="did you mean mesh.along"):
        cases_along(tmp_path, FORCE, base=changed(ROLLING, mesh={"alnog": 3}))


def test_cases_that_are_the_same_scene_are_refused(tmp_path: Path) -> None:
    default = {"key": "mesh.grading", "values": ["", "none"]}
    with pytest.raises(SceneError, match="cases 0 and 1 are the same scene"):
        cases_along(tmp_path, default)


def test_neighbours_lie_along_numbers_only(tmp_path: Path) -> None:
    bases = {"key": "solid.base", "values": ["sliding", "bonded"]}
    cases = cases_along(tmp_path, SPEED, bases)
    assert cases[0].coordinates == (pytest.approx(-2.302585), None)
    middle = cases[5]  # 1 rad/s, bonded: half way on a logarithmic axis
    assert [parent for parent, _ in middle.parents] == [1, 9]
    assert [weight for _, weight in middle.parents] == pytest.approx([0.5, 0.5])
    meshes = cases_along(tmp_path, linear("mesh.along", 4, 12, 5))
    assert all(case.parents == () for case in meshes)


@pytest.mark.parametrize("how", ["zero", "time", "times", "file"])
def test_some_sweeps_always_start_from_zero(tmp_path: Path, how: str) -> None:
    base = {"time": changed(ROLLING, time=TIME), "file": FILE}.get(how, ROLLING)
    axes = [FORCE, SPEED] + ([{"key": "time", "values": [TIME]}] if how == "times" else [])
    start = "zero" if how == "zero" else "neighbour"
    cases = cases_along(tmp_path, *axes, base=base, start=start)
    assert all(case.scene is not None and case.parents == () for case in cases)
    assert [case.order for case in cases] == list(range(15))


def test_refused_cases_leave_the_neighbours_of_the_others_alone(tmp_path: Path) -> None:
    times = {"key": "time", "values": ["none", TIME]}
    friction = {"key": "contact.friction", "values": [0.1, -0.1, 0.2, 0.3]}
    cases = cases_along(tmp_path, FORCE, times, friction)
    assert sum(case.scene is None for case in cases) == 6
    steady = [case for case in cases if case.position[1] == 0 and case.scene is not None]
    assert any(case.parents for case in steady)
    assert not any(case.parents for case in cases if case.position[1] == 1)


def test_thousands_of_cases_take_seconds(tmp_path: Path) -> None:
    axes = (
        linear("load.force", "1 kN/m", "2 kN/m", 100),
        log("film.viscosity", "1 cP", "1 Pa*s", 50),
    )
    sweep = sweep_of(tmp_path, *axes)
    begin = time.process_time()
    assert len(cases_of(sweep)) == 5000
    assert time.process_time() - begin < 15  # s; 1 s when this was written
