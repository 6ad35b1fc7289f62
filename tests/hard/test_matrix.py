"""Any speed from 0 to 2 rad/s in either sense, any load from 0.1 to 3 kN/m, from zero in one call.

Friction drags a layer that slides on its base; whether that has a steady state is another
question (test_drag.py), so the sliding base is frictionless here.
"""

from itertools import product

import pytest

from tests.hard.stable import assert_stable, scene_of, solve

SPEEDS, LOADS = (0.0, 0.01, 1.0, -2.0), (0.1, 3.0)
BASES = (("sliding", False), ("bonded", True))
SMALL = (75, 8)


def named(case: tuple[tuple[str, bool], float, float]) -> str:
    (base, friction), speed, load = case
    return f"{base}{', friction' * friction}, {speed} rad/s, {load} kN/m"


FAST = list(product(BASES, SPEEDS, LOADS))
ALSO = list(product((("bonded", False),), SPEEDS, LOADS))
BETWEEN = list(product((*BASES, ("bonded", False)), (0.001, 0.1, 0.5, 2.0), (0.3, 1.5)))


@pytest.mark.parametrize("case", FAST, ids=named)
def test_small_mesh(case: tuple[tuple[str, bool], float, float]) -> None:
    (base, friction), speed, load = case
    assert_stable(solve(scene_of(base, speed, load, friction, *SMALL)))


@pytest.mark.slow
@pytest.mark.parametrize("case", [*ALSO, *BETWEEN], ids=named)
def test_small_mesh_more_of_them(case: tuple[tuple[str, bool], float, float]) -> None:
    (base, friction), speed, load = case
    assert_stable(solve(scene_of(base, speed, load, friction, *SMALL)))


@pytest.mark.slow
@pytest.mark.parametrize("grading", ["none", "contact"])
@pytest.mark.parametrize("case", [*FAST, *ALSO], ids=named)
def test_finer_mesh(case: tuple[tuple[str, bool], float, float], grading: str) -> None:
    (base, friction), speed, load = case
    scene = scene_of(base, speed, load, friction, 150, 15, f"mesh.grading={grading}")
    assert_stable(solve(scene))
