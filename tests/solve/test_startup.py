"""The start-up in time ends where steady Newton ends, and leaves nothing of itself behind."""

import numpy as np
import pytest

from porolub.solve.model import Model
from porolub.solve.startup import LIFTED, PRESSED_IN, Starter, StartUp
from tests.solve.models import PORES, block, case1, model_of, newton_on, physical

SAME = 1e-7  # scaled, largest difference of any unknown


def difference(model: Model, x, y) -> float:
    y.axpy(-1.0, x)
    return max(model.dofs.field_norms(y, float("inf")).values())


@pytest.mark.parametrize(
    ("job", "overrides"),
    [
        ("case1", []),
        ("case1", ["load={approach='60 um'}"]),
        ("case1", ["load.force=0.6 kN/m", "motion.speed=-1 rad/s"]),
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


@pytest.mark.parametrize("permeability", ["1e-18 m^2", "1e-19 m^2"])
def test_its_steps_resolve_the_passage_of_a_nearly_undrained_layer(permeability: str) -> None:
    """The layer consolidates in 10^3 and 10^4 s, and passes the contact in 0.1 s."""
    scene = case1(40, 4, f"pores.permeability={permeability}", job="case1_bonded")
    with model_of(scene) as model, newton_on(model) as (watched, _):
        starter = Starter(model, watched.newton)
        x = starter.zero(LIFTED)
        started = starter.physical(x)
        assert started.converged, started.why
        assert model.system.rate == 0.0
        assert watched.newton.solve(x, max_iterations=3).converged


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


@pytest.mark.parametrize("wet", [False, True], ids=["dry", "wet"])
def test_loading_in_steps_reaches_the_state_of_steady_newton(wet: bool) -> None:
    top = {"traction": {"x": "0.02 MPa", "y": "-0.05 MPa"}}
    top |= {"pressure": "0.1 MPa"} if wet else {}
    sides = {"top": top, "left": {}, "right": {}, "bottom": {"displacement": {
        "x": "0.01 mm", "y": "0.02 mm"}}}
    scene = block(boundary=sides, **({"pores": PORES} if wet else {}))
    with model_of(scene) as model, newton_on(model) as (watched, _):
        starter = Starter(model, watched.newton)
        x, y = starter.zero(0.0), starter.zero(0.0)
        assert starter.straight(x, "straight").converged
        assert starter.loaded(y).converged
        assert {r.fraction for r in watched.records if r.stage == "loading"} >= {0.25, 1.0}
        assert difference(model, x, y) < SAME
        assert (model.operation.share, model.system.share) == (1.0, 1.0)


def test_a_displacement_longer_than_an_element_is_reached_in_steps() -> None:
    """Uniaxial strain: the layer of three elements is pressed by 1.2 of them."""
    scene = block(boundary={"top": {"displacement": {"y": "-0.4 mm"}}})
    with model_of(scene) as model, newton_on(model) as (watched, _):
        starter = Starter(model, watched.newton)
        assert not starter.straight(starter.zero(0.0), "straight").converged
        x = starter.zero(0.0)
        assert starter.loaded(x).converged
        u = model.dofs.field("u", physical(model, x))
        y = model.mesh.coordinates[model.dofs.nodes["u"], 1]
    np.testing.assert_allclose(u[:, 0], 0.0, atol=1e-10)
    np.testing.assert_allclose(u[:, 1], -0.4 * y, atol=1e-10)
