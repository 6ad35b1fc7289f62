"""From zero to the steady state without hand-made steps.

First Newton straight from the undeformed state.  Where that fails, the physical start-up: the
plane comes down on the film at full speed and load, in backward Euler steps of the true storage
and squeeze terms whose size follows Newton's ease, until the state no longer changes; then
steady Newton.  Squeeze keeps the surfaces apart while the pressure builds, so contact is reached
last and from the right side.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from porolub.solve.model import Model
from porolub.solve.newton import Newton, NewtonResult

PRESSED_IN = 0.05  # first guess of the approach for a straight start, thicknesses
LIFTED = -0.01  # where the plane starts in the physical start-up
STEP_LIMIT = {"u": 0.3, "p": 0.3, "l": 0.3, "v0": 0.3, "j": np.inf, "w": np.inf}
PATIENCE = 2  # strongly shortened steps: a good guess converges at once or not at all
STANDS_STILL, TRIES = 1e-6, 3  # change per step, and how often Newton may fail from such a state
SMALLEST_SHARE = 2e-3  # of load or friction, below which a ramp is given up


@dataclass(frozen=True)
class StartUp:
    """Knobs of the start-up, in scaled time (one unit is the consolidation time of the layer).

    A layer that is nearly undrained meets the plane long before it consolidates: where the body
    would move on by more than ``moved`` thicknesses in the first step, all steps are as much
    shorter.

    A given approach is reached in the time ``lowered``, in which a contact of twenty thicknesses
    drains to its ends: pressed faster, fluid that has nowhere to go carries many times the load
    of the steady state, and a deep approach fails.
    """

    first_step: float = 1e-4
    moved: float = 0.01
    smallest_step: float = 1e-7
    steps: int = 400
    lowered: float = 100.0
    settled: float = 2e-3  # change per step below which steady Newton is tried
    settled_after: float = 0.05


class Starter:
    """Finds the steady state of one model."""

    def __init__(self, model: Model, newton: Newton) -> None:
        self.model, self.newton, self.steps, self.rejected = model, newton, 0, 0

    def zero(self, approach: float) -> PETSc.Vec:
        x = self.model.dofs.vector()
        if "v0" in self.model.dofs.fields:
            self.model.dofs.set_scalar("v0", x, approach)
        return x

    def straight(self, x: PETSc.Vec, stage: str, max_iterations: int = 25) -> NewtonResult:
        """Steady Newton from x."""
        self.model.system.steady()
        return self.newton.solve(x, stage, 1.0, max_iterations=max_iterations)

    def tried(self, x: PETSc.Vec, stage: str, max_iterations: int = 25, hope: int | None = None
              ) -> NewtonResult:
        """Steady Newton from a guess x, in place, given up where it turns out to be a bad one.

        ``hope``: iterations tolerated in which no update gets smaller (None: any number).
        """
        newton = self.newton
        before = newton.patience, newton.hope
        newton.patience = PATIENCE
        newton.hope = before[1] if hope is None else hope
        result = self.straight(x, stage, max_iterations)
        newton.patience, newton.hope = before
        return result

    def ramped(self, x: PETSc.Vec) -> NewtonResult:
        """For a dry scene, which has no time to start up in: the load first, then its friction.

        From x, in place; each is raised in steps that follow Newton's ease.
        """
        operation, newton = self.model.operation, self.newton
        force, approach = operation.force, operation.approach
        limits, newton.limits = newton.limits, dict.fromkeys(STEP_LIMIT, 1.0)

        def load(share: float) -> None:
            operation.friction = 0.0
            operation.force = None if force is None else share * force
            operation.approach = share * approach

        def friction(share: float) -> None:
            operation.friction = share

        result = self._raise(x, "load", load)
        if result.converged:
            result = self._raise(x, "friction", friction)
        operation.force, operation.approach, operation.friction = force, approach, 1.0
        newton.limits = limits
        return result

    def loaded(self, x: PETSc.Vec) -> NewtonResult:
        """For a scene without a plane: tractions and prescribed values raised together.

        In place from x = 0. A prescribed displacement longer than an element would turn the
        elements at the boundary inside out; raised step by step, the inside follows.
        """
        def boundaries(share: float) -> None:
            self.model.operation.share = self.model.system.share = share

        limits, self.newton.limits = self.newton.limits, dict.fromkeys(STEP_LIMIT, 1.0)
        result = self._raise(x, "loading", boundaries, proportional=True)
        boundaries(1.0)
        self.newton.limits = limits
        return result

    def _raise(self, x: PETSc.Vec, stage: str, apply: Callable[[float], None],
               proportional: bool = False) -> NewtonResult:
        """Bring a share from 0 to 1 in adaptive steps; ``proportional``: x grows with it."""
        share, step = 0.0, 0.25
        while True:
            apply(min(1.0, share + step))
            trial = x.copy()
            if proportional and share > 0.0:
                trial.scale(min(1.0, share + step) / share)
            result = self.newton.solve(trial, stage, min(1.0, share + step), max_iterations=12)
            if result.converged:
                share += step
                trial.copy(x)
                step *= 1.5 if result.iterations <= 7 else 1.0
            else:
                self.rejected += 1
                step *= 0.4
            trial.destroy()
            if share >= 1.0 or step < SMALLEST_SHARE:
                return result

    def _body_speed(self) -> float:
        """Of the fastest part of the body, thicknesses per unit time."""
        v = self.model.operation.body_velocity(self.model.mesh.coordinates)
        fastest = float(np.linalg.norm(v, axis=-1).max(initial=0.0))
        return float(self.model.mesh.comm.allreduce(fastest, op=MPI.MAX))

    def physical(self, x: PETSc.Vec, settle: bool = False,
                 options: StartUp = StartUp()) -> NewtonResult:
        """Start-up in time from x, in place; ends with steady Newton.

        ``settle``: x is near the steady state already, so nothing is brought down.
        """
        operation, system, dofs = self.model.operation, self.model.system, self.model.dofs
        target = operation.approach
        limits, self.newton.limits = self.newton.limits, dict(STEP_LIMIT)
        patience, self.newton.patience = self.newton.patience, PATIENCE
        self.newton.abort_below = 0.05
        share = min(1.0, options.moved / max(options.first_step * self._body_speed(), 1e-300))
        dt, smallest, t = share * options.first_step, share * options.smallest_step, 0.0
        result = NewtonResult(False, 0, "the start-up did not settle")
        in_vain = 0
        for _ in range(options.steps):
            system.backward_euler(system.physical(dofs.to_local(x)), dt)
            if operation.force is None and not settle:  # a prescribed approach comes down with time
                lowered = min(1.0, (t + dt) / options.lowered)
                operation.approach = LIFTED + (target - LIFTED) * lowered
            trial = x.copy()
            step = self.newton.solve(trial, "start-up", min(1.0, t), 1e-3, 10)
            if not step.converged:
                self.rejected += 1
                dt *= 0.25
                trial.destroy()
                if dt < smallest:
                    result = NewtonResult(False, 0, f"the start-up stalled at t = {t:.2g} "
                                          f"consolidation times: {step.why}", step.place)
                    break
                continue
            self.steps += 1
            t += dt
            x.aypx(-1.0, trial)
            change = max(dofs.field_norms(x, np.inf).values())
            trial.copy(x)
            trial.destroy()
            if change < options.settled and dt > options.settled_after:
                in_vain += change < STANDS_STILL and operation.approach == target
                system.steady()
                operation.approach = target
                attempt = x.copy()
                result = self.newton.solve(attempt, "steady", 1.0, max_iterations=20)
                if result.converged:
                    attempt.copy(x)
                attempt.destroy()
                if result.converged or in_vain == TRIES:
                    break
            dt *= 3.0 if step.iterations <= 3 else 2.0 if step.iterations <= 5 else 1.3
        system.steady()
        operation.approach = target
        self.newton.limits, self.newton.abort_below = limits, 0.0
        self.newton.patience = patience
        return result
