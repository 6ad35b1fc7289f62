"""[accuracy]: mesh and tolerance chosen for an error."""

from typing import Any

import pytest
from mpi4py import MPI

from porolub.errors import SceneError
from porolub.scene import load_scene
from porolub.solve.accurate import AccurateSolver, chosen_in_time, steady_solver
from porolub.solve.derived import scalars
from porolub.solve.options import set_options
from porolub.solve.steady import SteadySolver
from porolub.solve.transient import TransientSolver
from tests.solve.models import JOBS, case1

COMM = MPI.COMM_WORLD
FINEST = 900  # elements along the surface: more take more memory than a small machine has


@pytest.fixture(autouse=True)
def _options() -> None:
    set_options("")


def asked(text: str, *changes: str) -> Any:
    return case1(80, 4, f"accuracy={{{text}}}", *changes)


@pytest.mark.parametrize(("text", "sentence"), [
    ("", "[accuracy] asks for nothing: give one of friction, load, approach, contact"),
    ("friction='0 %'", 'accuracy.friction = "0 %": the value must be at least 0.0001'),
    ("friction='1 mm'", 'accuracy.friction = "1 mm": this is a length'),
    ("friction='1 %', elements=10", "accuracy.elements = 10"),
    ("speed='1 %'", "accuracy.speed"),
])
def test_what_cannot_be_asked(text: str, sentence: str) -> None:
    with pytest.raises(SceneError) as error:
        asked(text)
    assert sentence in str(error.value)


@pytest.mark.parametrize(("changes", "sentence"), [
    (["film=none", "contact=none"], "[accuracy] needs [contact] or [film]"),
    (["time={end='1 s', start='rest'}"], 'time.start = "rest" does not go with [accuracy]'),
])
def test_scenes_it_does_not_fit(changes: list[str], sentence: str) -> None:
    with pytest.raises(SceneError) as error:
        asked("friction='1 %'", *changes)
    assert sentence in str(error.value)


def test_without_it_nothing_is_chosen() -> None:
    assert isinstance(steady_solver(case1(60, 4), COMM), SteadySolver)
    assert isinstance(steady_solver(asked("load='1 %'"), COMM), AccurateSolver)


def test_a_stricter_wish_takes_a_finer_mesh() -> None:
    found = []
    for text in ("friction='5 %'", "friction='0.2 %', load='0.2 %'"):
        outcome = AccurateSolver(asked(text), COMM).solve()
        assert outcome.converged, outcome.message
        mesh = outcome.model.scene.mesh
        numbers = scalars(outcome.model, outcome.x)
        share = outcome.errors["friction_coefficient"] / numbers["friction_coefficient"]
        found.append((mesh.along, share))
        assert mesh.grading == "contact"
        assert f"on {mesh.along} x {mesh.across} elements" in outcome.message
        outcome.destroy()
    assert found[0][0] < found[1][0]
    assert found[0][1] <= 0.05
    assert found[1][1] <= 0.002


def test_what_is_not_reached_is_said() -> None:
    outcome = AccurateSolver(asked("friction='0.01 %', elements=100"), COMM).solve()
    assert (outcome.converged, outcome.status) == (False, "failed")
    assert "The accuracy asked for is not reached on 100 x 5 elements" in outcome.message
    assert "(asked: 0.01 %); raise accuracy.elements." in outcome.message
    outcome.destroy()


@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.parametrize(("job", "changes"), [
    ("case1.toml", ["load.force=700 N/m", "motion.speed=2 rad/s"]),
    ("case1.toml", ["load={approach='25 um'}"]),
    ("case1.toml", ["load={approach='-4 um'}"]),
    ("case1_bonded.toml", ["load.force=900 N/m"]),
    ("appendix_a.toml", ["load.force=1 kN/m"]),
    ("case1.toml", ["pores.permeability=3 um^3/mm", "load.force=1 kN/m"]),
])
def test_one_per_cent_is_met(job: str, changes: list[str]) -> None:
    """Against a graded mesh of twice the elements each way, up to FINEST, half as long at the ends
    of contact; none of these was used to tune it."""
    scene = load_scene(JOBS / job, ["accuracy={friction='1 %', load='1 %'}", *changes])
    outcome = AccurateSolver(scene, COMM).solve()
    assert outcome.converged, outcome.message
    mesh = outcome.model.scene.mesh
    along = min(2 * mesh.along, FINEST)
    finer = mesh.model_copy(update={
        "along": along, "across": round(mesh.across * along / mesh.along), "edge_size": 5e-6})
    plain = scene.model_copy(update={"mesh": finer, "accuracy": None})
    fine = SteadySolver(plain, COMM).solve()
    found, true = scalars(outcome.model, outcome.x), scalars(fine.model, fine.x)
    for name in scene.accuracy.wanted():
        assert found[name] == pytest.approx(true[name], rel=0.01), name
    for each in (outcome, fine):
        each.destroy()


@pytest.mark.slow
def test_mesh_and_tolerance_of_a_run_in_time() -> None:
    scene = load_scene(JOBS / "case3.toml", ["accuracy={friction='1 %'}", "time.end=1 s",
                                             "time.tolerance=1e-2", "mesh.across=10"])
    chosen = chosen_in_time(scene, COMM)
    assert chosen.mesh.grading == "contact"
    assert chosen.mesh.along >= 160
    solver = TransientSolver(chosen, COMM)
    outcome = solver.solve()
    assert outcome.converged
    last = solver.records[-1].values["friction_coefficient"]
    assert 0.0 < outcome.errors["friction_coefficient"] <= 0.01 * last
    solver.destroy()
