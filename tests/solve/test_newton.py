"""Newton: quadratic near a solution, held back far from it, and plain words when it fails."""

import numpy as np
import pytest

from porolub.solve.model import Model
from porolub.solve.newton import NewtonResult
from tests.solve.models import BLOCK, PORES, block, case1, model_of, newton_on

PRESSED = {"top": {"traction": "0.4 MPa"}}
SEEPED = {"top": {"traction": "0.4 MPa", "pressure": "0 Pa"}, "bottom": {
    "displacement": {"normal": "0 mm"}, "pressure": "0.2 MPa"}}
SMOOTH = {
    "solid": block(boundary=PRESSED),
    "solid and pores": block(boundary=SEEPED, pores=PORES),
}


def residual_norm(model: Model, x) -> float:
    out = model.dofs.vector()
    model.system.residual(x, out)
    found = float(out.norm())
    out.destroy()
    return found


@pytest.mark.parametrize("name", SMOOTH)
def test_updates_shrink_quadratically_on_a_smooth_scene(name: str) -> None:
    with model_of(SMOOTH[name]) as model, newton_on(model) as (watched, x):
        watched.newton.limits = dict.fromkeys(watched.newton.limits, np.inf)
        assert watched.newton.solve(x).converged
        sizes = np.array(watched.largest_updates())
        basin = sizes[(sizes < 0.1) & (sizes > 1e-13)]  # near the solution, above rounding
        assert len(basin) >= 3
        # e_next = C e^2 with one C of order one; linear convergence would let C grow like 1 / e
        assert np.all(basin[1:] < 10.0 * basin[:-1] ** 2), sizes
        assert sizes[-1] < 1e-9


@pytest.mark.parametrize("name", SMOOTH)
def test_the_residual_vanishes_at_what_it_calls_converged(name: str) -> None:
    with model_of(SMOOTH[name]) as model, newton_on(model) as (watched, x):
        before = residual_norm(model, x)
        result = watched.newton.solve(x)
        assert result == NewtonResult(True, len(watched.records))
        assert before > 1e-2
        assert residual_norm(model, x) < 1e-12


def test_long_steps_are_shortened_to_the_limit_and_reach_the_same_state() -> None:
    with model_of(SMOOTH["solid"]) as model, newton_on(model) as (watched, x):
        newton, limit = watched.newton, 0.02
        newton.limits = dict.fromkeys(newton.limits, np.inf)
        assert newton.solve(x).converged
        assert all(record.damping == 1.0 for record in watched.records)
        free = x.copy()
        newton.limits["u"] = limit
        watched.records.clear()
        x.set(0.0)
        assert newton.solve(x).converged
        shortened = [r for r in watched.records if r.updates["u"] > limit]
        assert len(shortened) > 3
        steps = np.array([r.damping * r.updates["u"] for r in watched.records])
        assert np.all(steps <= limit * (1 + 1e-12))
        np.testing.assert_allclose(steps[0], limit)
        assert all(r.damping < 1.0 for r in shortened)
        free.axpy(-1.0, x)
        assert free.norm() < 1e-9


@pytest.mark.parametrize("permeability", ["1e-18 m^2", "1e-19 m^2"])
def test_it_ends_when_all_that_is_left_is_rounding(permeability: str) -> None:
    """A nearly undrained layer determines its mean pressure so weakly that it wanders for ever."""
    scene = case1(40, 4, f"pores.permeability={permeability}")
    with model_of(scene) as model, newton_on(model) as (watched, x):
        model.dofs.set_scalar("v0", x, 0.05)
        result = watched.newton.solve(x)
        assert result.converged, result.why
        sizes = watched.largest_updates()
        assert sizes[-1] < 1e-6, sizes
        assert sizes[-1] > 1e-3 * sizes[-3], sizes  # Newton's own steps would have squared twice
        for name, norm in watched.records[-1].residuals.items():
            largest = max(r.residuals[name] for r in watched.records)
            assert norm < 1e-9 * largest, name


def test_each_iteration_is_reported_with_every_field() -> None:
    with model_of(case1(16, 3)) as model, newton_on(model) as (watched, x):
        model.dofs.set_scalar("v0", x, 0.05)
        result = watched.newton.solve(x, "a stage", 0.5)
        assert [r.iteration for r in watched.records] == list(range(1, result.iterations + 1))
        for record in watched.records:
            assert (record.stage, record.fraction) == ("a stage", 0.5)
            assert set(record.updates) == set(record.residuals) == set(model.dofs.fields)
        assert watched.records[-1].load == pytest.approx(1.0, abs=1e-12)
        assert watched.newton.linear_iterations == result.iterations


def test_too_few_iterations_are_called_so_with_the_field_that_moves() -> None:
    with model_of(SMOOTH["solid"]) as model, newton_on(model) as (watched, x):
        result = watched.newton.solve(x, max_iterations=2)
        assert (result.converged, result.iterations) == (False, 2)
        assert result.why.startswith("no convergence in 2 Newton iterations")
        assert "the displacement still changes by" in result.why
        assert result.place is not None
        assert abs(result.place[1] - 1.0) < 1e-12  # the loaded top moves most


def test_a_material_turned_inside_out_is_called_so() -> None:
    law = {**BLOCK["solid"], "law": "linear"}
    crushed = block(solid=law, boundary={"top": {"traction": "10 MPa"}})
    with model_of(crushed) as model, newton_on(model) as (watched, x):
        watched.newton.limits = dict.fromkeys(watched.newton.limits, np.inf)
        result = watched.newton.solve(x)
        assert not result.converged
        assert "volume ratio J fell to -" in result.why


def test_conditions_that_turn_the_material_inside_out_are_called_so() -> None:
    """Neo-Hookean stress has no value there: the failure must not be called anything else."""
    crushed = block(boundary={"top": {"displacement": {"y": "-1.2 mm"}}})
    with model_of(crushed) as model, newton_on(model) as (watched, x):
        result = watched.newton.solve(x)
        assert not result.converged
        assert "volume ratio J fell to -" in result.why
        assert result.place is not None
        assert result.place[1] > 2 / 3  # in the row of elements below the moved top


def test_a_plane_that_touches_nothing_leaves_a_singular_matrix_and_is_called_so() -> None:
    lifted = block(contact={}, load={"force": "1 kN/m"})
    with model_of(lifted) as model, newton_on(model) as (watched, x):
        model.dofs.set_scalar("v0", x, -0.1)
        result = watched.newton.solve(x)
        assert not result.converged
        assert "singular" in result.why


def test_a_body_nothing_holds_is_called_so() -> None:
    floating = block(boundary={**PRESSED, **{side: {} for side in ("left", "right", "bottom")}})
    with model_of(floating) as model, newton_on(model) as (watched, x):
        result = watched.newton.solve(x)
        assert not result.converged
        assert "singular: nothing determines the displacement" in result.why


def test_a_failed_solve_does_not_spoil_the_next() -> None:
    with model_of(SMOOTH["solid"]) as model, newton_on(model) as (watched, x):
        newton = watched.newton
        first = newton.solve(x)
        good = x.copy()
        x.set(0.0)
        assert not newton.solve(x, max_iterations=1).converged
        x.set(np.nan)
        assert not newton.solve(x).converged
        x.set(0.0)
        assert newton.solve(x) == first
        good.axpy(-1.0, x)
        assert good.norm() == 0.0
        assert newton.iterations == len(watched.records)


def test_a_state_that_is_no_number_is_called_so() -> None:
    with model_of(SMOOTH["solid"]) as model, newton_on(model) as (watched, x):
        x.set(np.nan)
        assert watched.newton.solve(x) == NewtonResult(False, 0, "the residual is not finite")
