"""The start-up in time ends where steady Newton ends, and leaves nothing of itself behind."""

import pytest

from porolub.solve.model import Model
from porolub.solve.startup import LIFTED, PRESSED_IN, Starter, StartUp
from tests.solve.models import case1, model_of, newton_on

SAME = 1e-7  # scaled, largest difference of any unknown


def difference(model: Model, x, y) -> float:
    y.axpy(-1.0, x)
    return max(model.dofs.field_norms(y, float("inf")).values())


@pytest.mark.parametrize(
    ("job", "overrides"),
    [
        ("case1", []),
        ("case1", ["load={approach='60 um'}"]),
        ("case1", ["load.force=0.2 kN/m", "motion.speed=-1 rad/s"]),
        ("case1_bonded", []),
        ("appendix_a", []),
    ],
    ids=["sliding base", "given approach", "light, reversed", "bonded base", "sliding plane"],
)
def test_it_reaches_the_state_of_steady_newton(job: str, overrides: list[str]) -> None:
    scene = case1(40, 4, "mesh.grading=none", *overrides, job=job)
    with model_of(scene) as model, newton_on(model) as (watched, _):
        starter = Starter(model, watched.newton)
        x, y = starter.zero(PRESSED_IN), starter.zero(LIFTED)
        straight = starter.straight(x, "straight")
        assert straight.converged, straight.why
        started = starter.physical(y)
        assert started.converged, started.why
        assert starter.steps > 3
        assert difference(model, x, y) < SAME


def test_it_settles_from_a_state_near_by() -> None:
    with model_of(case1(40, 4)) as model, newton_on(model) as (watched, _):
        starter = Starter(model, watched.newton)
        x = starter.zero(PRESSED_IN)
        assert starter.straight(x, "straight").converged
        y = x.copy()
        y.scale(0.9)
        assert starter.physical(y, settle=True).converged
        assert difference(model, x, y) < SAME


@pytest.mark.parametrize("steps", [1, 400], ids=["given up", "settled"])
def test_the_operating_point_and_newton_are_given_back_as_they_were(steps: int) -> None:
    with model_of(case1(16, 3, "load={approach='40 um'}")) as model, \
            newton_on(model) as (watched, _):
        newton, before = watched.newton, vars(model.operation).copy()
        limits = newton.limits
        starter = Starter(model, newton)
        result = starter.physical(starter.zero(0.0), options=StartUp(steps=steps))
        assert result.converged == (steps > 1)
        assert result.converged or result.why == "the start-up did not settle"
        assert vars(model.operation) == before
        assert (newton.limits, newton.abort_below) == (limits, 0.0)


def test_a_start_up_that_cannot_step_says_when_and_why() -> None:
    with model_of(case1(16, 3, "load.force=1 MN/m")) as model, newton_on(model) as (watched, _):
        starter = Starter(model, watched.newton)
        result = starter.physical(starter.zero(LIFTED))
        assert not result.converged
        assert result.why.startswith("the start-up stalled at t = ")
        assert "consolidation times: " in result.why
        assert starter.rejected > 0
