"""What is said of a solution that converged and may still be wrong."""

from typing import Any

import pytest

from porolub.solve.doubts import UNCERTAIN, VACUUM, doubts
from tests.solve.models import case1

NUMBERS = {"load_total": 1500.0, "load_solid": 10.0, "load_fluid": 1490.0, "approach": 1e-4,
           "friction_coefficient": 0.2, "contact_length": 9e-3, "pressure_min": -2e4}
SCENE = case1(60, 4)


def said(numbers: dict[str, Any], errors: dict[str, float], scene: Any = SCENE) -> list[str]:
    return doubts(scene, NUMBERS | numbers, errors)


def test_nothing_where_errors_are_small_or_unknown() -> None:
    assert said({}, {}) == []
    assert said({}, {"approach": 0.99 * UNCERTAIN * 1e-4, "pressure_max": 1e9}) == []
    assert said({"approach": None, "load_total": None}, {"approach": 1.0, "load_solid": 9.0}) == []


def test_uncertain_numbers_are_named_largest_first_with_what_to_try() -> None:
    sentence, = said({}, {"approach": 0.4e-4, "friction_coefficient": 0.3, "contact_length": 1e-4})
    assert "uncertain are friction by 150 %, approach by 40 % (estimated)" in sentence
    assert 'mesh.along and mesh.across or mesh.grading = "contact"' in sentence


def test_loads_count_beside_the_whole_load() -> None:
    assert said({}, {"load_solid": 100.0}) == []  # ten times itself
    assert "load by contact by 27 %" in said({}, {"load_solid": 400.0})[0]


@pytest.mark.parametrize(("changes", "advised"), [
    ([], True), (["conventions.entering=fresh"], False), (["solid.base=bonded"], False),
    (["pores.carry=false"], False)])
def test_what_enters_is_named_where_only_what_drains_determines_it(
    changes: list[str], advised: bool
) -> None:
    sentence, = said({}, {"approach": 1e-4}, case1(60, 4, *changes))
    assert ('conventions.entering = "fresh"' in sentence) == advised


def test_of_runs_in_time_the_steps_may_be_at_fault() -> None:
    sentence, = said({}, {"approach": 1e-4}, case1(60, 4, "time={end='1 s'}"))
    assert "The mesh or the time steps do not resolve" in sentence
    assert "time.tolerance" in sentence


def test_pressures_below_vacuum() -> None:
    assert said({"pressure_min": 0.99 * VACUUM}, {}) == []
    sentence, = said({"pressure_min": -363e3}, {})
    assert sentence.startswith("The fluid pressure falls to -363 kPa, below vacuum (-101 kPa)")
