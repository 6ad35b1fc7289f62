"""The sweeps in jobs/: what issues from them is what their comments say."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from porolub.study.plan.cases import Case, cases_of
from porolub.study.plan.sweep_file import load_sweep

JOBS = Path(__file__).parents[2] / "jobs"


def cases(name: str) -> list[Case]:
    return cases_of(load_sweep(JOBS / f"{name}.toml"))


@pytest.mark.parametrize(
    ("name", "count"),
    [
        ("stribeck", 46),
        ("stribeck_load", 40),
        ("stribeck_map", 100),
        ("viscosity", 14),
        ("permeability", 17),
        ("modulus", 12),
    ],
)
def test_every_case_is_a_scene_that_most_begin_near(name: str, count: int) -> None:
    found = cases(name)
    assert len(found) == count
    assert [case.refusal for case in found if case.scene is None] == []
    assert sum(not case.parents for case in found) == (4 if name == "stribeck_map" else 2)


def test_the_curve_by_approach_is_that_of_the_paper() -> None:
    found = cases("stribeck")
    approaches = [case.axes["approach"] for case in found]
    assert (approaches[0], approaches[-1]) == (-10e-6, 200e-6)
    assert approaches == sorted(approaches)
    scene = found[-1].scene
    assert scene is not None
    assert scene.load is not None
    assert (scene.load.force, scene.load.approach) == (None, 200e-6)
    where_mu_turns = [x for x in approaches if isinstance(x, float) and -2e-6 <= x <= 20e-6]
    assert np.diff(where_mu_turns) == pytest.approx(1e-6)


def test_no_gap_in_the_loads_is_wide() -> None:
    loads = [float(case.axes["force"]) for case in cases("stribeck_load")]
    assert (loads[0], loads[-1]) == (1.0, 4000.0)
    assert all(1.1 < after / before < 1.6 for before, after in pairwise(loads))


def test_film_and_pores_hold_the_same_fluid() -> None:
    for case in cases("viscosity"):
        scene = case.scene
        assert scene is not None
        assert scene.film is not None
        assert scene.pores is not None
        assert scene.film.viscosity == scene.pores.viscosity == case.axes["viscosity"]


def test_the_moduli_keep_their_ratio() -> None:
    for case in cases("modulus"):
        assert case.scene is not None
        assert case.scene.solid is not None
        ratio = case.scene.solid.bulk_modulus / case.scene.solid.shear_modulus
        assert ratio == pytest.approx(10.0)
