"""Steps in time: prescribed values, starts from rest, films between walls, rejections, checks."""

from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from porolub.scene import scene_from_dict
from porolub.solve.stepping import TimeStepper
from porolub.solve.transient import TransientSolver
from porolub.solve.watch import Watch
from tests.physics import consolidation as column
from tests.physics.stepped import Look, Steps, fixed, stepped

G, K = 0.5e6, 2e6  # of the block, Pa
DOWN = 1e-6  # m
PORES = {"biot": 1.0, "permeability": "1e-15 m^2", "viscosity": "1 mPa*s"}


def block(**others: Any) -> dict[str, Any]:
    """A porous block, 2 mm x 1 mm, its sides and bottom on rollers unless overridden."""
    return {
        "geometry": {"shape": "block", "width": "2 mm", "thickness": "1 mm"},
        "mesh": {"along": 3, "across": 3},
        "solid": {"law": "linear", "shear_modulus": f"{G} Pa", "bulk_modulus": f"{K} Pa"},
        "pores": PORES,
        "time": {"end": "0.2 s", "frames": 0},
        **others,
    }


def pressed_down(history: Any) -> dict[str, Any]:
    """The block under a plate that is moved; its right side is free and drained."""
    free = {"traction": "0 Pa", "pressure": "0 Pa"}
    return block(boundary={"top": {"displacement": {"y": history}}, "right": free})


def pressures(look: Look) -> Any:
    return look.pressure()[1]


@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_moving_plate_presses_out_what_the_layer_loses(order: int) -> None:
    """A Newton step does not tell the rows of fluid that a prescribed value will change."""
    moving = {"mean": "0 m", "amplitude": f"{DOWN} m", "frequency": "2 Hz", "shape": "sine"}
    tables = pressed_down(moving)
    tables["time"]["order"] = order
    run = stepped(tables)
    assert run.steps > 15
    assert np.ptp(run["fluid_content"]) > 1e-7
    assert run.fluid_error() < 1e-9


def test_a_plate_that_is_down_at_the_start_has_come_down_on_an_undeformed_layer() -> None:
    """Undrained plane strain under a smooth plate: p = 2 G times the strain, but at the rim."""
    run = stepped(pressed_down(f"{-DOWN} m") | {"mesh": {"along": 12, "across": 1}}, pressures)
    where, _ = run.last().pressure()
    inside = run.seen[0][where[:, 0] < 0.0]
    assert inside == pytest.approx(np.full(len(inside), 2.0 * G * DOWN / 1e-3), rel=1e-3)


@pytest.mark.parametrize("porous", [True, False])
def test_a_plate_under_load_rests_on_contact_alone(porous: bool) -> None:
    """No film holds it up while it comes down: at rest it only touches."""
    tables = block(contact={}, load={"force": "100 N/m"}, mesh={"along": 12, "across": 1})
    if porous:
        tables["boundary"] = {"right": {"traction": "0 Pa", "pressure": "0 Pa"}}
    else:
        del tables["pores"]
    run = stepped(tables)
    assert run["load_total"] == pytest.approx(np.full(run.steps + 1, 100.0), rel=1e-9)
    assert run["load_fluid"][0] == pytest.approx(50.0 if porous else 0.0, abs=2.0)


def film(load: dict[str, Any], **time: Any) -> Steps:
    """A plane over a rigid block 10 mm wide, 0.01 Pa s between them."""
    return stepped({
        "geometry": {"shape": "block", "width": "10 mm", "thickness": "1 mm"},
        "mesh": {"along": 8, "across": 1, "pressure_degree": 2},
        "film": {"viscosity": "10 mPa*s"}, "load": load,
        "time": {"end": "1 s", "frames": 0, **time},
    })


@pytest.mark.parametrize("height", [20e-6, 2e-6])
def test_a_thin_film_between_walls_loses_what_leaves_it(height: float) -> None:
    """Under loads that bring it down at the same pace."""
    force = 100.0 * (20e-6 / height) ** 2
    run = film({"force": f"{force} N/m"}, approach=f"{-height} m")
    assert run["film_min"][-1] < 0.4 * height
    assert run.fluid_error() < 1e-7


def crushed(depth: float, **time: Any) -> dict[str, Any]:
    """A dry block whose top comes down by ``depth`` of its height at even speed."""
    ramp = {"times": ["0 s", "1 s"], "values": ["0 mm", f"{-depth} mm"]}
    tables = block(boundary={"top": {"displacement": {"y": ramp}}},
                   time={"end": "1 s", "frames": 0, **time})
    tables["solid"] = {**tables["solid"], "law": "neo-hookean"}
    del tables["pores"]
    return tables


def stretch(look: Look) -> float:
    return 1.0 + look.displacement()[:, 1].min() / 1e-3


def test_a_step_that_turns_elements_inside_out_is_tried_at_a_quarter() -> None:
    """The rows are a third of a millimetre high; the first tries move the top beyond them."""
    run = stepped(crushed(0.9, first_step="1 s", tolerance=0.5), stretch)
    times, sizes, why = zip(*run.rejections, strict=True)
    assert len(why) >= 2
    assert all(reason.startswith("the volume ratio J fell to -") for reason in why[:2])
    assert sizes[0] == pytest.approx(1.0, abs=1e-3)
    assert sizes[1] == pytest.approx(sizes[0] / 4.0, rel=1e-9)
    assert times[0] == times[1] == run["time"][0]
    assert run.seen[-1] == pytest.approx(0.1, abs=1e-9)
    assert run["rejected_steps"].sum() == len(run.rejections)


def test_what_no_step_can_do_ends_the_run_with_time_place_and_reason() -> None:
    """Crushed to nothing at t = 1/1.1 s."""
    run = stepped(crushed(1.1), stretch, fails=True)
    assert 0.85 < run["time"][-1] < 1.0 / 1.1
    assert run.seen[-1] > 0.0
    assert run.message.startswith(f"At t = {run['time'][-1]:.6g} s even a step of")
    assert "near x = " in run.message
    assert any(why.startswith("the volume ratio J fell to -") for _, _, why in run.rejections)


def test_newton_without_convergence_is_a_reason_too() -> None:
    """Allowed a single iteration, Newton cannot do long steps of a nonlinear block."""
    scene = scene_from_dict(crushed(0.5, first_step="0.5 s"))
    reasons: list[str] = []
    solver = TransientSolver(scene, MPI.COMM_SELF, Watch(rejected=lambda *r: reasons.append(r[2])))
    begun(solver)
    solver.stepper.newton.max_iterations = 1
    step = solver.stepper.step(0.3)
    assert step.rejected
    assert all(r.why.startswith("no convergence in 1 Newton iterations") for r in step.rejected)
    assert step.size < 0.01 or step.failed


@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_load_that_all_but_jumps_is_survived(order: int) -> None:
    """Doubled within a nanosecond; linear, so the settlement is the sum of two."""
    jump = 0.3 * column.TAU
    load = {"times": ["0 s", f"{jump!r} s", f"{jump + 1e-9!r} s"],
            "values": ["1 kPa", "1 kPa", "2 kPa"]}
    run = stepped(column.column(16, 1.0, load, order=order, tolerance=1e-4), column.settlement)
    T = run["time"] / column.TAU
    exact = column.degree_of_consolidation(T)
    exact += np.where(T > 0.3, column.degree_of_consolidation(np.maximum(T - 0.3, 1e-9)), 0.0)
    away = (T > 0.01) & (np.abs(T - 0.305) > 0.01)
    error = np.abs(run.sight / column.SETTLED - exact)[away]
    assert error.max() < (5e-3 if order == 1 else 2e-3)
    assert np.abs(T - 0.3).min() < 1e-12
    assert run.fluid_error() < 1e-9


def begun(solver: TransientSolver) -> None:
    """At its consistent start, before the first step."""
    assert solver._start() is None


def started() -> TransientSolver:
    solver = TransientSolver(scene_from_dict(column.column(4, 1.0)), MPI.COMM_SELF)
    begun(solver)
    return solver


def test_contents_that_are_differenced_otherwise_than_ts_does_are_an_error() -> None:
    """TS and porolub each keep the times of past steps; the shift tells whether they agree."""
    solver = started()
    weights = solver.stepper.lookback.weights
    solver.stepper.lookback.weights = (  # type: ignore[method-assign]
        lambda t, half: 1.001 * weights(t, half))
    with pytest.raises(RuntimeError, match="TS differences with"):
        solver.stepper.step(1e-3)


@pytest.mark.parametrize("stage", ["_aim", "_take_note"])
def test_an_error_within_a_stage_comes_out_as_itself(
        stage: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """TS calls these from C."""
    def broken(self: TimeStepper, t: float) -> None:
        raise ZeroDivisionError("in a stage")

    solver = started()
    monkeypatch.setattr(TimeStepper, stage, broken)
    with pytest.raises(ZeroDivisionError, match="in a stage"):
        solver.stepper.step(1e-3)


def test_fixed_steps_are_honoured() -> None:
    """As `--petsc "-ts_adapt_type none"` asks."""
    run = fixed(column.column(4, 1.0), 12)
    assert np.diff(run["time"]) == pytest.approx(np.full(12, column.TAU / 12), rel=1e-4)


def test_the_longest_step_is_honoured() -> None:
    run = stepped(column.column(4, 2.0, step_max=f"{column.TAU / 20!r} s"))
    assert run["time_step"].max() <= column.TAU / 20 * (1 + 1e-12)
    assert run["time"][-1] == pytest.approx(2.0 * column.TAU, rel=1e-12)
