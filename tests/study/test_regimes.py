"""Sommerfeld number and regime follow from a scene and its summary, each case by itself."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.scene import Scene, scene_from_dict
from porolub.study.work.regimes import CRITERIA, REGIMES, regime, sommerfeld_number
from tests.io.conftest import scene_tables

BARREL = {"shape": "barrel", "outer_radius": "100 mm", "thickness": "1 mm", "half_angle": "5 deg",
          "width": "20 mm"}  # fmt: skip
BLOCK = {"shape": "block", "width": "20 mm", "thickness": "1 mm"}
MESH = {"along": 6, "across": 2, "deep": 2}
SLIDING = {"kind": "sliding", "speed": "-0.2 m/s"}


def scene(**changes: Any) -> Scene:
    return scene_from_dict(scene_tables(**changes))


def body(symmetry: list[str] | None = None) -> Scene:
    shape = BARREL if symmetry is None else BARREL | {"symmetry": symmetry}
    return scene(scene={"dimension": 3}, geometry=shape, mesh=MESH, load={"force": "6 N"})


def summary(**changes: Any) -> dict[str, Any]:
    """A case with a full film, 4 um thick where a rigid surface would leave 3.9 um."""
    film = {"status": "converged", "effects": ["solid", "film", "contact"], "load_total": 5.0,
            "film_min": 4e-6, "approach": -3.9e-6, "friction_coefficient": 0.03,
            "friction_fluid": 0.03}  # fmt: skip
    return film | changes


def touching(film: float | None, whole: float | None = 0.2) -> dict[str, Any]:
    return summary(film_min=0.0, approach=2e-5, friction_fluid=film, friction_coefficient=whole)


def test_the_papers_case_1() -> None:
    """6.67e-8, Section 3.2.2 of the paper."""
    assert sommerfeld_number(scene(), {"load_total": 1500.0}) == pytest.approx(1e-4 / 1500)


def test_the_direction_of_the_motion_does_not_count() -> None:
    back = scene(motion={"kind": "rotation", "speed": "-1 rad/s"})
    assert sommerfeld_number(back, {"load_total": 1500.0}) == pytest.approx(6.667e-8, rel=1e-3)


def test_a_sliding_plane_on_a_block() -> None:
    flat = scene(geometry=BLOCK, motion=SLIDING)
    assert sommerfeld_number(flat, {"load_total": 100.0}) == pytest.approx(2e-6)


def test_a_history_counts_as_at_its_beginning() -> None:
    speed = {"mean": "0 rad/s", "amplitude": "2 rad/s", "frequency": "1 Hz", "shape": "cosine"}
    moving = scene(motion={"kind": "rotation", "speed": speed}, time={"end": "1 s"})
    assert sommerfeld_number(moving, {"load_total": 1500.0}) == pytest.approx(2e-4 / 1500)


@pytest.mark.parametrize(("symmetry", "width"), [(None, 0.02), ([], 0.02), (["front"], 0.01)])
def test_the_load_on_a_body_counts_by_the_width_it_is_on(
    symmetry: list[str] | None, width: float
) -> None:
    found = sommerfeld_number(body(symmetry), {"load_total": 6.0})
    assert found == pytest.approx(1e-3 * 0.1 / (6.0 / width))


def test_a_block_has_its_depth() -> None:
    cuboid = scene(scene={"dimension": 3}, geometry=BLOCK | {"depth": "5 mm"}, mesh=MESH,
                   motion=SLIDING, load={"force": "6 N"})  # fmt: skip
    assert sommerfeld_number(cuboid, {"load_total": 6.0}) == pytest.approx(1e-3 * 0.2 * 5e-3 / 6)


@pytest.mark.parametrize(
    ("changes", "load"),
    [
        ({"film": None}, 1500.0),
        ({"motion": None}, 1500.0),
        ({"motion": {"kind": "rotation", "speed": "0 rad/s"}}, 1500.0),
        ({}, None),
        ({}, 0.0),
        ({}, -3.0),
        ({}, math.nan),
    ],
)
def test_there_is_no_number_without_film_motion_or_load(changes: Any, load: float | None) -> None:
    assert sommerfeld_number(scene(**changes), {"load_total": load}) is None


def test_a_stiff_surface_is_hydrodynamic() -> None:
    assert regime(summary()) == "hydrodynamic"


@pytest.mark.parametrize("approach", [-3.5e-6, -4.5e-6, 0.0, 1e-5])
def test_a_surface_that_gives_way_is_elastohydrodynamic(approach: float) -> None:
    assert regime(summary(approach=approach)) == "elastohydrodynamic"


@pytest.mark.parametrize(
    ("film", "found"),
    [(0.05, "mixed"), (0.021, "mixed"), (0.019, "boundary"), (0.0, "boundary"), (None, "boundary")],
)
def test_in_contact_the_films_friction_decides(film: float | None, found: str) -> None:
    assert regime(touching(film)) == found


def test_contact_without_friction_and_film_is_boundary() -> None:
    assert regime(touching(0.0, 0.0)) == "boundary"
    assert regime(touching(0.01, 0.0)) == "mixed"


def test_dry_contact_is_boundary() -> None:
    assert regime(touching(0.0) | {"effects": ["solid", "contact"]}) == "boundary"


@pytest.mark.parametrize(
    "changes",
    [
        {"status": "failed"},
        {"film_min": None},
        {"effects": ["solid", "contact"]},
        {"load_total": 0.0},
        {"load_total": None},
        {"load_total": -1.0},
    ],
)
def test_no_regime_where_there_is_nothing_to_tell(changes: dict[str, Any]) -> None:
    assert regime(summary(**changes)) == ""
    assert regime({}) == ""


NUMBERS = st.none() | st.floats()


@given(NUMBERS, NUMBERS, NUMBERS, NUMBERS, NUMBERS)
def test_every_summary_has_a_regime_with_a_criterion_or_none(
    film_min: float | None, approach: float | None, load: float | None, mu: float | None,
    mu_f: float | None,
) -> None:  # fmt: skip
    found = regime(summary(film_min=film_min, approach=approach, load_total=load,
                           friction_coefficient=mu, friction_fluid=mu_f))  # fmt: skip
    assert found in ("", *REGIMES)
    assert set(CRITERIA) == set(REGIMES)
