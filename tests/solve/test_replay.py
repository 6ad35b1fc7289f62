"""A run taken up again goes on as if it had not been interrupted: same steps, same states.

Told at the level of the solver: what a checkpoint holds is handed from one run to another.
"""

from functools import cache
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from porolub.scene import Scene, scene_from_dict
from porolub.solve.report import Resume, StateData
from porolub.solve.transient import TransientSolver
from porolub.solve.watch import Watch

SAME = 1e-12  # relative
STEPS = 9  # in the run, about


def scene(order: int, kink: bool) -> Scene:
    """A neo-Hookean layer, drained at the top, under a load that swings (or has a kink)."""
    load: dict[str, Any] = {"mean": "0.3 MPa", "amplitude": "-0.25 MPa", "frequency": "0.5 Hz",
                            "shape": "cosine"}
    if kink:
        load = {"times": ["0 s", "0.2 s", "0.5 s"], "values": ["0.05 MPa", "0.4 MPa", "0.1 MPa"]}
    return scene_from_dict({
        "geometry": {"shape": "block", "width": "1 mm", "thickness": "1 mm"},
        "mesh": {"along": 2, "across": 4},
        "solid": {"law": "neo-hookean", "shear_modulus": "0.5 MPa", "bulk_modulus": "5 MPa"},
        "pores": {"biot": 0.9, "permeability": "1e-15 m^2", "viscosity": "1 mPa*s"},
        "boundary": {"top": {"traction": load, "pressure": "0 Pa"}},
        "time": {"end": "0.5 s", "frames": 0, "order": order, "tolerance": 0.03,
                 "first_step": "10 ms"},
    })


class Run:
    """A run, and all it would have written to a checkpoint after each step."""

    def __init__(self, wanted: Scene, resume: Resume | None = None) -> None:
        self.saved: list[Resume] = []
        self.solver = TransientSolver(wanted, MPI.COMM_SELF, Watch(checkpoint=self._save))
        outcome = self.solver.solve(resume)
        assert outcome.converged, outcome.message

    def _save(self, gather: Any) -> None:
        self.saved.append(gather())

    @property
    def last(self) -> StateData:
        return self.saved[-1].states[0]


@cache
def whole(order: int, kink: bool) -> Run:
    return Run(scene(order, kink))


def assert_same(found: StateData, expected: StateData) -> None:
    assert found.time == pytest.approx(expected.time, rel=SAME)
    for name, (_, values) in expected.fields.items():
        size = np.abs(values).max()
        np.testing.assert_allclose(found.fields[name][1], values, rtol=0.0, atol=SAME * size)


@pytest.mark.parametrize("kink", [False, True])
@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("after", [1, 2, 3, 6, -2])
def test_a_run_taken_up_after_some_steps_ends_the_same(order: int, kink: bool, after: int) -> None:
    """After 1: the half step of the start is still looked back on."""
    first = whole(order, kink)
    count = len(first.saved)
    assert count > STEPS
    after = after % count
    second = Run(scene(order, kink), first.saved[after - 1])
    assert len(second.saved) == count - after, "the same steps"
    assert_same(second.last, first.last)
    for name in ("time_step", "order", "fluid_content", "fluid_gained", "pressure_max"):
        here, there = (np.array([r.values[name] for r in run.solver.records[-count + after:]])
                       for run in (second, first))
        np.testing.assert_allclose(here, there, rtol=0.0, atol=1e-9 * np.abs(there).max(),
                                   err_msg=name)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_each_stop_on_the_way_changes_nothing(order: int) -> None:
    """Taken up again three times, a step each."""
    first = whole(order, True)
    resume = first.saved[0]
    for _ in range(3):
        resume = Run(scene(order, True), resume).saved[0]
    expected = first.saved[3]
    assert_same(resume.states[0], expected.states[0])
    assert resume.step == pytest.approx(expected.step, rel=1e-9)
    assert resume.orders == expected.orders


def test_the_steps_differ_from_each_other() -> None:
    """So that their history matters, and the load bends the layer far enough to be nonlinear."""
    for kink in (False, True):
        records = whole(3, kink).solver.records
        sizes = np.array([r.values["time_step"] for r in records[1:]])
        assert sizes.max() > 3.0 * sizes.min()
        assert min(r.values["jacobian_min"] for r in records) < 0.9
