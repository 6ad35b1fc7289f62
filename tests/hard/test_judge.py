"""The matrix sees what it is there for: broken states, cases that end otherwise than they say."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from porolub.solve.derived import Derived
from tests.hard.case import MESH, Bounds, Case, Verdict
from tests.hard.judge import Trial, compared, judged
from tests.hard.matrix import chosen, main, print_matrix
from tests.hard.measures import complementarity, measured
from tests.hard.meshes import lean_of, skewed_sector
from tests.hard.rows import all_cases
from tests.hard.stable import scene_of, solve

SMALL = Case("test", "small", "A steady state.", "case1", mesh=(30, 3))


@pytest.fixture(scope="module")
def outcome():
    return solve(scene_of("sliding", 1.0, 1.5, False, 30, 3))


def disturbed(outcome, field: str, disturb) -> object:
    """The measures of the solution with one of its fields changed by ``disturb`` (array, d)."""
    x, dofs = outcome.x.copy(), outcome.model.dofs
    local = dofs.to_local(x)
    values = dofs.field(field, local)
    disturb(values, Derived(outcome.model, outcome.x))
    x.array[:] = local[dofs.owned]
    found = measured(outcome.model, x)
    x.destroy()
    return found


def test_a_good_state_violates_nothing(outcome) -> None:
    found = measured(outcome.model, outcome.x)
    assert found.contact < 1e-12
    assert found.along < 1e-3 * found.largest
    assert found.largest > 0.01


def test_a_node_that_pulls_is_seen(outcome) -> None:
    def pull(values: np.ndarray, d: Derived) -> None:
        values[np.argmin(values)] -= 1e-3

    assert disturbed(outcome, "l", pull).contact > 1e-4


def test_a_node_that_presses_though_it_is_open_is_seen(outcome) -> None:
    def press(values: np.ndarray, d: Derived) -> None:
        gap = d.gap()[d.model.dofs.nodes["l"]]
        values[np.argmax(gap)] += 1e-2

    assert complementarity(Derived(outcome.model, outcome.x)) < 1e-12
    assert disturbed(outcome, "l", press).contact > 1e-3


@pytest.mark.parametrize("way", ["along", "across"])
def test_a_pressure_that_alternates_is_seen(outcome, way: str) -> None:
    def alternate(values: np.ndarray, d: Derived) -> None:
        mesh = d.model.mesh
        places = mesh.logical(mesh.coordinates[d.model.dofs.nodes["p"]])
        counts = np.round(places * (30, 3)).astype(int)
        values[:, 0] += 0.05 * (-1.0) ** counts[:, ["along", "across"].index(way)]

    found = disturbed(outcome, "p", alternate)
    assert getattr(found, way) > 0.05 * found.largest


def test_what_does_not_end_as_it_is_said_to_does_not_hold(tmp_path: Path) -> None:
    fails = replace(SMALL, fails="no such sentence")
    assert not judged(Trial(fails, tmp_path))["end"].ok
    refused = replace(SMALL, refused="solid.poisson_ratio")
    assert not judged(Trial(refused, tmp_path))["end"].ok
    other = replace(refused, overrides=("pores.permeability=0 m^2",))
    verdict = judged(Trial(other, tmp_path))["end"]
    assert not verdict.ok
    assert "pores.permeability" in verdict.text


def test_bounds_and_own_checks_decide(tmp_path: Path) -> None:
    def never(found: object) -> str:
        raise AssertionError("not this one")

    verdicts = judged(Trial(replace(SMALL, bounds=Bounds(lowest=0.999), also=never), tmp_path))
    assert verdicts["end"].ok
    assert not verdicts["J"].ok
    assert verdicts["own"] == Verdict(False, "not this one")


def test_the_reference_sees_a_coarse_mesh(tmp_path: Path) -> None:
    case = replace(SMALL, refined=("mesh.along=60", "mesh.across=6"), within=1e-9)
    assert not compared(Trial(case, tmp_path))["reference"].ok


def test_elements_lean_as_they_are_told(tmp_path: Path) -> None:
    for degrees in (0.0, 30.0):
        path = skewed_sector(tmp_path / f"{degrees}.msh", *MESH, degrees)
        assert lean_of(path) == pytest.approx(degrees, abs=0.5)


def test_the_matrix_names_what_does_not_hold() -> None:
    out = io.StringIO()
    found = {"a: b": {"end": Verdict(True, "9 it"), "J": Verdict(False, "-0.100")},
             "c: d": {"end": Verdict(True, "8 it")}}
    print_matrix(Console(file=out, width=100), found)
    assert "1 of 2 cases hold." in out.getvalue()
    assert "a: b: J: -0.100" in out.getvalue()


def test_cases_are_chosen_by_words(capsys: pytest.CaptureFixture[str]) -> None:
    assert len(chosen([])) == len(all_cases()) > 150
    assert {c.group for c in chosen(["speed 20 sliding"])} == {"speed"}
    assert main(["--list", "--only", "speed 20 sliding"]) == 0
    assert "speed: -20 rad/s, sliding: The mirror image of the other sense." in (
        capsys.readouterr().out)


def test_names_are_unique_and_statements_are_sentences() -> None:
    cases = all_cases()
    assert len({c.id for c in cases}) == len(cases)
    for case in cases:
        assert case.stable[0].isupper(), case.id
        assert case.stable.endswith("."), case.id
        assert not (case.fails and case.refused), case.id
