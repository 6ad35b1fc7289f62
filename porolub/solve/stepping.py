"""Steps in time: PETSc's TS with variable-step BDF around Newton, adaptive by local error.

TS chooses the steps from the error of the differential unknowns alone; the contents of the terms
are what is differenced (see ``Lookback``).  A step is rejected when its local error is above the
tolerance or Newton fails (a volume ratio J that is not positive included).
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.fem.dofs import Field
from porolub.mesh.library import petsc_library
from porolub.solve.balance import fluid_balance
from porolub.solve.drive import drive
from porolub.solve.linear import Linear
from porolub.solve.lookback import Entry, Lookback
from porolub.solve.model import Model
from porolub.solve.newton import Clock, Newton
from porolub.solve.place import Place
from porolub.solve.report import NewtonRecord
from porolub.solve.startup import STEP_LIMIT

Array = NDArray[np.float64]
NEWTON_TOLERANCE = 1e-5  # scaled update at which Newton stops; the error left is of its square
RIGID_TOLERANCE = 1e-7  # between rigid walls, where a film may be far thinner than a layer
MAX_ITERATIONS = 12
OLD_FACTORS_COST = 0.7  # counts as so much of an iteration that factorises
PATIENCE = 3  # strongly shortened Newton steps, after which a shorter time step is better
SMALLEST_STEP = 1e-10  # of the layer's own time and the end; below it a step that fails is given up
GUESS = 0.8  # share of the straight extrapolation Newton starts from
JUMP = 1e-7  # likewise; what changes within so short a step is a jump, which no step resolves
IGNORED = 1e10  # error tolerance of an algebraic unknown
TOO_INACCURATE = "the local error is above the tolerance"
GAVE_UP = PETSc.TS.ConvergedReason.DIVERGED_NONLINEAR_SOLVE
_PreStage = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_double)
_PostStage = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_double, ctypes.c_int,
                              ctypes.c_void_p)


@dataclass(frozen=True)
class Rejection:
    """A step that was taken back: from ``time``, its ``size`` (scaled), and why, a clause."""

    time: float
    size: float
    why: str


@dataclass(frozen=True)
class Step:
    """A step: ``time`` reached and ``size`` (scaled), BDF order, Newton iterations (those of
    rejected attempts included); effort of the last attempt alone: its iterations, those with old
    factors counted by what they cost; rejections; ``failed``: why it could not be done, and the
    place.
    """

    time: float
    size: float
    order: int
    newton_iterations: int
    effort: float = 0.0
    rejected: tuple[Rejection, ...] = ()
    failed: str = ""
    place: Place | None = None


def differential(fields: dict[str, Field]) -> list[str]:
    """Unknowns whose error counts: those with a time derivative in their equations.

    The approach has one where nothing else moves: between rigid surfaces.
    """
    moving = ["v0"] if "v0" in fields and "u" not in fields else []
    return [name for name, f in fields.items() if f.differential] + moving


class TimeStepper:
    """Steps one model on from a consistent state; ``x`` is the current one (scaled, global).

    All times are scaled.  ``stop`` is asked in every Newton iteration whether to give up.
    """

    def __init__(self, model: Model, order: int, tolerance: float, clock: Clock,
                 observe: Callable[[NewtonRecord], None] = lambda record: None,
                 stop: Callable[[Any], str] = lambda comm: "") -> None:
        self.model, self.tolerance = model, tolerance
        self.x = model.dofs.vector()
        self.lookback = Lookback(order)
        self.sizes = dict.fromkeys(differential(model.dofs.fields), 0.0)
        self._error_weights = model.dofs.vector()
        self._span = min(1.0, model.scene.time.end / model.scales.time)
        # of the step under way
        self._stage, self._iterations, self._reused_before = -np.inf, 0, 0
        self._pending: Entry | None = None
        self._scheme: tuple[float, dict[str, Array]] = (0.0, {})  # rate, known of the last step
        self._rejected: list[Rejection] = []
        self._place: Place | None = None
        self._problem: Exception | None = None
        self._replay: tuple[Array, Array] | None = None  # states of its half step and its end
        self.ts = self._create(order)
        self.newton = Newton(model.system, clock, observe, stop, self.ts, Linear(model))
        soft = "u" in model.dofs.fields
        self.newton.tolerance = NEWTON_TOLERANCE if soft else RIGID_TOLERANCE
        self.newton.max_iterations = MAX_ITERATIONS
        self.newton.limits, self.newton.patience = dict(STEP_LIMIT), PATIENCE
        self.newton.given, self.newton.reuse = self._given, True
        self.newton.snes.setInitialGuess(self._guess)
        self.ts.setIFunction(self._function, self.newton.residual)
        self.ts.setIJacobian(self._jacobian, self.newton.matrix)

    def _create(self, order: int) -> PETSc.TS:
        ts = PETSc.TS().create(comm=self.model.mesh.comm)
        ts.setType(PETSc.TS.Type.BDF)
        ts.setEquationType(PETSc.TS.EquationType.IMPLICIT)
        library, handle = petsc_library(), ctypes.c_void_p(ts.handle)
        library.TSBDFSetOrder(handle, ctypes.c_int(order))
        self._stages = _PreStage(self._stage_begins), _PostStage(self._stage_done)  # TS needs them
        library.TSSetPreStage(handle, self._stages[0])
        library.TSSetPostStage(handle, self._stages[1])
        ts.setExactFinalTime(PETSc.TS.ExactFinalTime.STEPOVER)
        ts.setMaxTime(1e300)
        ts.setMaxSteps(2**31 - 1)
        ts.setMaxSNESFailures(-1)
        ts.setMaxStepRejections(-1)
        ts.setErrorIfStepFails(False)
        ts.setTolerances(rtol=0.0, atol=self._error_weights)
        ts.setSolution(self.x)
        ts.setFromOptions()
        return ts

    # -- use --------------------------------------------------------------------------------
    def restart(self, t: float, x: PETSc.Vec | None = None) -> None:
        """Begin at time t from a consistent state (the present one by default), at order 1."""
        if x is not None:
            x.copy(self.x)
        drive(self.model, t * self.model.scales.time)
        gained = self.lookback.entries[0].gained if self.lookback.entries else 0.0
        held = self.model.system.content(self._physical(self.x))
        self.lookback.restart(Entry(t, self.x.array.copy(), held, gained, 1))
        self.sizes = self._sizes_of(self.x)
        self.ts.setTime(t)
        self.ts.restartStep()

    def step(self, size: float) -> Step:
        """One accepted step of at most ``size``; ``next_size`` is what to try after it."""
        self.ts.setTimeStep(size)
        self._stage, self._iterations, self._pending, self._rejected = -np.inf, 0, None, []
        self._place = None
        order = self.lookback.order(half=False)
        try:
            self.ts.step()
        except PETSc.Error:
            if self._problem is not None:
                raise self._problem from None
            raise
        rejected = tuple(self._rejected)
        if self.ts.getConvergedReason() < 0 or self._pending is None:
            last = rejected[-1]
            self._take_back()
            return Step(last.time, last.size, order, self._iterations, 0.0, rejected, last.why,
                        self._place)
        entry, before = self._pending, self.lookback.entries[0].time
        self.lookback.accept(entry)
        self._scheme = self.model.system.rate, self.model.system.known
        self.sizes = self._sizes_of(self.x)
        PETSc.garbage_cleanup(self.model.mesh.comm)
        old = self.newton.reused - self._reused_before
        effort = self.newton.snes.getIterationNumber() - old * (1.0 - OLD_FACTORS_COST)
        return Step(entry.time, entry.time - before, order, self._iterations, effort, rejected)

    def _take_back(self) -> None:
        """After a step that failed: all is again as the last accepted one left it."""
        system, newest = self.model.system, self.lookback.entries[0]
        self.x.array[:] = newest.x
        system.rate, system.known = self._scheme
        drive(self.model, newest.time * self.model.scales.time)
        system.residual(self.x, self.newton.residual)  # for the lowest J

    @property
    def next_size(self) -> float:
        """The step TS thinks the error allows after the last one."""
        return float(self.ts.getTimeStep())

    def replay(self, entries: Sequence[tuple[float, Array, float]]) -> None:
        """Walk through stored states (time, owned values of x, gained), newest first.

        Afterwards TS and porolub look back on the same states as when they were stored, so the
        run goes on as if it had not been interrupted.
        """
        *later, half = entries
        if not (len(entries) > 2 and half[0] > later[-1][0]):  # no half step of a start in it
            later, half = list(entries), (0.0, entries[-1][1], 0.0)
        first = later.pop()
        self.x.array[:] = first[1]
        self.restart(first[0])
        self._set_gained(first[2])
        for time, x, gained in reversed(later):
            self._replay = half[1], x
            self.step(time - self.lookback.entries[0].time)
            self._set_gained(gained)
        self._replay = None

    def _set_gained(self, gained: float) -> None:
        newest = self.lookback.entries[0]
        self.lookback.entries[0] = Entry(newest.time, newest.x, newest.content, gained,
                                         newest.order)

    def destroy(self) -> None:
        self.newton.destroy()
        self.ts.destroy()
        self._error_weights.destroy()

    # -- callbacks of TS ----------------------------------------------------------------------
    def _function(self, ts: PETSc.TS, t: float, x: PETSc.Vec, xdot: PETSc.Vec,
                  f: PETSc.Vec) -> None:
        self.newton.function(self.newton.snes, x, f)

    def _aim(self, t: float) -> None:
        """A stage at time t begins: bring loads there and tell the system how to difference."""
        if self._pending is not None:  # what was computed last has not been accepted
            now = self.lookback.entries[0].time
            self._rejected.append(Rejection(now, self._pending.time - now, TOO_INACCURATE))
            self._pending = None
        self._stage, self._reused_before = t, self.newton.reused
        drive(self.model, t * self.model.scales.time)
        half = self._is_half(t)
        rate, *others = self.lookback.weights(t, half)
        nodes = self.lookback.nodes(half)
        self.model.system.rate = rate
        self.model.system.known = {
            name: np.sum([w * e.content[name] for w, e in zip(others, nodes, strict=True)], axis=0)
            for name in nodes[0].content}

    def _is_half(self, t: float) -> bool:
        return self.lookback.is_half(t, self.ts.getTimeStep())

    def _jacobian(self, ts: PETSc.TS, t: float, x: PETSc.Vec, xdot: PETSc.Vec, shift: float,
                  J: PETSc.Mat, P: PETSc.Mat) -> None:
        rate = self.model.system.rate
        if abs(shift - rate) > 1e-6 * abs(shift):
            raise RuntimeError(f"TS differences with {shift:.6g}, the contents with {rate:.6g}")
        self.newton.jacobian(self.newton.snes, x, J, P)

    def _guess(self, snes: PETSc.SNES, x: PETSc.Vec) -> None:
        """Extrapolate in a straight line, and a little less than all the way.

        TS's own guess is a parabola at order 2; where nodes open and close it overshoots, and
        Newton then needs a third more iterations (measured on Case 2).  Prescribed values are put
        in at once: other rows of the matrix do not know of them.
        """
        newest = self.lookback.entries[0]
        x.array[:] = newest.x
        if self.lookback.steps > 0:
            before = self.lookback.entries[1]
            ahead = (self._stage - newest.time) / (newest.time - before.time)
            x.array[:] += GUESS * ahead * (newest.x - before.x)
        self.model.system.apply_conditions(x)

    def _given(self, x: PETSc.Vec) -> bool:
        """In a replay the state is known: put it in, there is nothing to iterate."""
        if self._replay is None:
            return False
        half, end = self._replay
        x.array[:] = half if self._is_half(self._stage) else end
        return True

    # Called from C before and after a Newton solve: an exception goes on in ``step``.
    def _stage_begins(self, ts: int, t: float) -> int:
        return self._kept(self._aim, t)

    def _stage_done(self, ts: int, t: float, index: int, states: int) -> int:
        return self._kept(self._take_note, t)

    def _kept(self, work: Callable[[float], None], t: float) -> int:
        try:
            work(t)
        except Exception as problem:
            self._problem = problem
            return 1
        return 0

    def _take_note(self, t: float) -> None:
        snes, size = self.newton.snes, self.ts.getTimeStep()
        self._iterations += snes.getIterationNumber()
        result = self.newton.result(snes.getIterationNumber())
        if not result.converged:
            now, self._place = self.lookback.entries[0].time, result.place
            self._rejected.append(Rejection(now, size, result.why))
            if self.newton.stop(self.model.mesh.comm) or size < SMALLEST_STEP * self._span:
                self.ts.setConvergedReason(GAVE_UP)
            return
        entry = self._entry(t, snes.getSolution())
        if self._is_half(t):
            self.lookback.halfway(entry)
        else:
            self._pending = entry
            self._weigh(snes.getSolution(), size)

    def _entry(self, t: float, x: PETSc.Vec) -> Entry:
        half = self._is_half(t)
        local = self._physical(x)
        held = self.model.system.content(local)
        gained = 0.0
        if "p" in self.model.dofs.fields:
            rate, *others = self.lookback.weights(t, half)
            past = sum(w * e.gained for w, e in zip(others, self.lookback.nodes(half),
                                                    strict=True))
            gained = (fluid_balance(self.model, local, held).entering - past) / rate
        return Entry(t, x.array.copy(), held, float(gained), self.lookback.order(half))

    # -- error norm ---------------------------------------------------------------------------
    def _physical(self, x: PETSc.Vec) -> Array:
        return self.model.system.physical(self.model.dofs.to_local(x))

    def _sizes_of(self, x: PETSc.Vec) -> dict[str, float]:
        norms = self.model.dofs.field_norms(x, np.inf)
        return {name: max(size, norms[name]) for name, size in self.sizes.items()}

    def _weigh(self, x: PETSc.Vec, size: float) -> None:
        """Set what error of each unknown is one tolerance.

        The norm is then the root mean square over each differential unknown of error / (tolerance
        times its largest value so far), and over these unknowns.
        """
        dofs, weights = self.model.dofs, self._error_weights
        weights.set(IGNORED)
        if self._replay is not None or size < JUMP * self._span:
            return
        counts = dofs.counts()
        first = weights.getOwnershipRange()[0]
        for name, largest in self._sizes_of(x).items():
            r = dofs.range[name]
            mine = dofs.global_numbers[r][dofs.owned[r]] - first
            share = np.sqrt(counts[name] * len(self.sizes) / dofs.size)
            weights.array[mine] = max(self.tolerance * largest * share, 1e-30)
