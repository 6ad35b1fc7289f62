"""Newton's method: SNES with the exact Jacobian, a step limiter and a convergence test by field.

Contact and film make the residual kinked, and a line search that insists on descent stalls at
the kinks; full steps, shortened only when they are implausibly long, converge (measured on the
paper's cases).  Convergence is judged by the update of each field, in scaled units.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from petsc4py import PETSc

from porolub.solve.linear import Linear
from porolub.solve.place import Place, place_of_largest
from porolub.solve.report import NewtonRecord
from porolub.solve.system import System
from porolub.terms.load import LoadBalance

CONVERGED = PETSc.SNES.ConvergedReason.CONVERGED_SNORM_RELATIVE
GOES_ON = PETSc.SNES.ConvergedReason.ITERATING
DIVERGED = PETSc.SNES.ConvergedReason.DIVERGED_FUNCTION_DOMAIN
TOO_MANY = PETSc.SNES.ConvergedReason.DIVERGED_MAX_IT

# Largest plausible update of one iteration, in thicknesses and moduli.
LIMITS = {"u": 0.05, "p": 0.5, "l": np.inf, "v0": 0.03, "j": np.inf, "w": np.inf}
SHORT = 0.4  # a step cut below this counts as strongly shortened
STALE = 1e-2  # share of the tolerance that an iteration with an old matrix may leave
NEAR, FAST = 1e-3, 0.3  # size of an update, and how it must shrink, to keep the matrix
FLIPPED = 1e-10  # residual of contact, scaled, above which nodes came into contact or left it
ROUGH = 1e-4  # tolerance above which they may
WANDERS, VANISHED = 1e-5, 1e-9  # size of updates, share of the largest residuals: see _rounding
LONG, FAINT = 6, 1e-7  # iterations with such updates, and the share that is rounding then
UNDETERMINED = 1e9  # an update of this size, scaled, comes from a singular matrix
NAMES = {"u": ("displacement", "thicknesses"), "p": ("fluid pressure", "layer moduli"),
         "l": ("contact pressure", "layer moduli"), "v0": ("approach", "thicknesses"),
         "j": ("volume change", "of the volume"), "w": ("velocity", "thicknesses per unit time")}


@dataclass
class Clock:
    """Wall time spent by purpose, seconds."""

    start: float = field(default_factory=time.perf_counter)
    spent: dict[str, float] = field(default_factory=lambda: {
        "setup": 0.0, "assembly": 0.0, "linear_solve": 0.0, "output": 0.0})

    def add(self, what: str, since: float) -> None:
        self.spent[what] += time.perf_counter() - since

    def elapsed(self) -> float:
        return time.perf_counter() - self.start

    def include(self, before: Clock) -> None:
        """Count what was spent before, too."""
        self.start = before.start
        for what, spent in before.spent.items():
            self.spent[what] += spent


@dataclass
class NewtonResult:
    """converged; iterations; why: a clause when it failed; place: where, in mesh units."""

    converged: bool
    iterations: int
    why: str = ""
    place: Place | None = None


class Newton:
    """Solves F(x) = 0 for one System; reusable over continuation steps (one symbolic analysis).

    ``observe`` is called with a NewtonRecord after each iteration; ``stop`` is asked before each
    whether to give up, and says why (the same on all ranks of the
    communicator it is given).  ``integrator``: a TS whose SNES is
    to iterate like this; it asks for the residual and Jacobian itself.  ``linear``: the solver of
    its linear systems, destroyed with it; by default what PETSc's options say.
    """

    def __init__(self, system: System, clock: Clock,
                 observe: Callable[[NewtonRecord], None] = lambda record: None,
                 stop: Callable[[Any], str] = lambda comm: "",
                 integrator: PETSc.TS | None = None, linear: Linear | None = None) -> None:
        self.system, self.clock, self.observe, self.stop = system, clock, observe, stop
        self.dofs = system.dofs
        self.stage, self.fraction = "steady", 1.0
        self.iterations = self.linear_iterations = 0
        self.limits = dict(LIMITS)
        self.tolerance, self.max_iterations = 1e-9, 40
        self.reuse, self.reused = False, 0  # matrices of the iteration before
        self.abort_below = 0.0  # lowest J tolerated
        self.patience = 1000  # strongly shortened steps tolerated before giving up
        self.hope = 1000  # iterations tolerated in which no update is smaller than all before
        self.given: Callable[[PETSc.Vec], bool] = lambda x: False  # puts in a state known already
        # of the iteration under way
        self._updates: dict[str, float] = {}
        self._damping, self._stalled, self._shortened = 1.0, 0, 0
        self._smallest, self._hopeless = float("inf"), 0  # update, iterations since
        self._wandered = 0  # iterations with updates as small as rounding may be
        self._size = self._size_before = float("inf")  # of the last two updates, unshortened
        self._stale = False  # whether the last of them came from the matrix of the one before
        self._largest: dict[str, float] = {}  # residual so far, by field
        self._first: dict[str, float] = {}  # residual that the first of all iterations began with
        self._previous_size = float("inf")
        self._solve_start: float | None = None
        self._why = ""
        self._place: Place | None = None
        start = time.perf_counter()
        self.matrix = system.create_matrix()
        self.residual = self.dofs.vector()
        self._owned, self.linear = integrator is None, linear
        if integrator is None:
            self.snes = PETSc.SNES().create(comm=self.dofs.mesh.comm)
            self.snes.setFunction(self.function, self.residual)
            self.snes.setJacobian(self.jacobian, self.matrix)
        else:
            self.snes = integrator.getSNES()
        self._configure()
        clock.add("setup", start)

    def _configure(self) -> None:
        snes = self.snes
        snes.setType("newtonls")
        snes.setLineSearchPreCheck(self._limit_step)
        snes.setConvergenceTest(self._test)
        snes.setTolerances(max_it=1000)
        snes.setFromOptions()
        snes.getKSP().setErrorIfNotConverged(False)
        if self.linear is not None:
            self.linear.attach(snes.getKSP())

    # -- callbacks ----------------------------------------------------------------------
    def function(self, snes: PETSc.SNES, x: PETSc.Vec, f: PETSc.Vec) -> None:
        """F(x) into f."""
        start = time.perf_counter()
        self.system.residual(x, f)
        self.clock.add("assembly", start)
        self._solve_start = None

    def jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, J: PETSc.Mat, P: PETSc.Mat) -> None:
        """dF/dx into P; left as it is, and its factors with it, where that will do."""
        self._stale = self._may_reuse()
        if self._stale:
            self.reused += 1
            self._solve_start = time.perf_counter()
            return
        start = time.perf_counter()
        self.system.jacobian(x, P)
        if self.linear is not None:
            self.linear.linearise(x)
        self.clock.add("assembly", start)
        self._solve_start = time.perf_counter()

    def _may_reuse(self) -> bool:
        """Whether the last matrix is near enough: updates are small and shrink fast.

        What is left to do is then done as well by the old factors, at a tenth of the cost.
        """
        size, shrinks = self._size, self._size < FAST * self._size_before
        return self.reuse and self._damping == 1.0 and size < NEAR and shrinks

    def _limit_step(self, x: PETSc.Vec, y: PETSc.Vec) -> bool:
        """Shorten the update y; x_new = x - y."""
        if self._solve_start is not None:
            self.clock.add("linear_solve", self._solve_start)
        self.linear_iterations += max(self.snes.getKSP().getIterationNumber(), 1)
        self._updates = self.dofs.field_norms(y, np.inf)
        self._size_before, self._size = self._size, max(self._updates.values(), default=np.inf)
        # the pressure of a film between rigid walls bends nothing, so no size is implausible
        limits = self.limits if "u" in self._updates else {**self.limits, "p": np.inf}
        worst = max((size / limits[name] for name, size in self._updates.items()), default=0.0)
        self._damping = 1.0 if worst <= 1.0 else 1.0 / worst
        if not np.isfinite(worst):
            self._damping = 1.0
        self._damping *= self._cycle_breaker(worst * self._damping)
        if self._damping < 1.0:
            y.scale(self._damping)
            return True
        return False

    def _cycle_breaker(self, size: float) -> float:
        """Half steps once the updates stop shrinking: nodes flip between open and closed."""
        self._stalled = self._stalled + 1 if size > 0.7 * self._previous_size else 0
        self._previous_size = size
        return 0.5 if self._stalled >= 3 else 1.0

    def _test(self, snes: PETSc.SNES, iteration: int, norms: tuple[float, ...]) -> int:
        if iteration == 0:
            self._updates, self._damping, self._largest = {}, 1.0, {}
            self._size = self._size_before = np.inf
            self._stalled, self._previous_size, self._shortened = 0, np.inf, 0
            self._wandered = 0
            self._smallest, self._hopeless = np.inf, 0
            self._why, self._place = "", None
            if self.given(snes.getSolution()):
                return CONVERGED
        record = self._record(iteration, snes)
        self._first = self._first or record.residuals
        self._largest = {name: max(norm, self._largest.get(name, self._first.get(name, 0.0)))
                         for name, norm in record.residuals.items()}
        if iteration > 0:
            self.iterations += 1
            self.observe(record)
        self._why = self.stop(self.dofs.mesh.comm)
        if self._why:
            return DIVERGED
        size = max(self._updates.values(), default=np.inf)
        if not np.isfinite(norms[2]) or self.system.lowest_jacobian <= self.abort_below:
            return self._not_defined()
        if iteration > 0 and size > UNDETERMINED:
            self._why = (f"the matrix is singular: nothing determines the {self._worst()[0]}; a "
                         "support, a pressure or a surface in contact may be missing")
            return DIVERGED
        self._shortened += self._damping < SHORT
        if self._shortened > self.patience:
            self._why = "Newton's steps stay implausibly long"
            return DIVERGED
        self._hopeless = 0 if size < self._smallest else self._hopeless + 1
        self._smallest = min(size, self._smallest)
        if self._hopeless > self.hope:
            self._why = "Newton's steps do not get smaller"
            return DIVERGED
        if self._damping == 1.0 and ((self._close(size) and self._settled(record))
                                     or self._rounding(size, record)):
            return CONVERGED
        if iteration >= self.max_iterations:
            name, unit = self._worst()
            self._why = (f"no convergence in {iteration} Newton iterations: the {name} still "
                         f"changes by {size:.1e} {unit}")
            return TOO_MANY
        return GOES_ON

    def _close(self, size: float) -> bool:
        """Whether the error left is below the tolerance's square, roughly.

        With a fresh matrix it is of the order of the square of the update; with an old one it is
        the update times the rate of convergence.
        """
        if size >= self.tolerance or not self._stale:
            return size < self.tolerance
        return size * size < STALE * self.tolerance * self._size_before

    def _settled(self, record: NewtonRecord) -> bool:
        """Whether no node came into contact or left it: these rows are linear piece by piece, so
        nothing is left of them then.  Steps of a start-up, on the way to elsewhere, need not be."""
        return self.tolerance > ROUGH or record.residuals.get("l", 0.0) < FLIPPED

    def _rounding(self, size: float, record: NewtonRecord) -> bool:
        """Whether the updates are rounding: small and no longer shrinking, or small for long, of a
        residual that is gone.

        What a nearly undrained layer determines only weakly, its mean pressure, wanders by more
        than the tolerance for ever.  A start that is settled already leaves nothing to fall: what
        the first of all solves began with counts, too.
        """
        self._wandered = self._wandered + 1 if size < WANDERS else 0
        share = FAINT if self._wandered >= LONG else VANISHED
        gone = all(norm <= share * self._largest[name]
                   for name, norm in record.residuals.items())
        return size < WANDERS and gone and (self._stalled > 0 or self._wandered >= LONG)

    def _not_defined(self) -> int:
        """The residual has no value at this state; say why."""
        lowest, place = self.system.lowest()
        if lowest <= self.abort_below:
            self._why, self._place = f"the volume ratio J fell to {lowest:.2g}", place
        else:
            self._why = "the residual is not finite"
        return DIVERGED

    def _worst(self) -> tuple[str, str]:
        """Name and unit of the field that still changes most; notes where it does."""
        field = max(self._updates, key=lambda name: self._updates[name])
        self._place = place_of_largest(self.dofs, field, self.snes.getSolutionUpdate())
        return NAMES.get(field, (field, "scaled"))

    def _record(self, iteration: int, snes: PETSc.SNES) -> NewtonRecord:
        residuals = self.dofs.field_norms(snes.getFunction()[0], 2)
        return NewtonRecord(self.stage, self.fraction, iteration, residuals, dict(self._updates),
                            self._damping, self._load_fraction(), self.clock.elapsed())

    def _load_fraction(self) -> float:
        """Load carried over the load asked for; the row of v0 is their difference."""
        balance = next((t for t in self.system.terms if isinstance(t, LoadBalance)), None)
        if balance is None or not balance.operation.force:
            return float("nan")
        signed = self.dofs.scalar_value("v0", self.snes.getFunction()[0])
        return 1.0 + signed / balance.operation.force

    # -- use ----------------------------------------------------------------------------
    def solve(self, x: PETSc.Vec, stage: str = "steady", fraction: float = 1.0,
              tolerance: float = 1e-9, max_iterations: int = 40) -> NewtonResult:
        """Solve from x, in place."""
        self.stage, self.fraction = stage, fraction
        self.tolerance, self.max_iterations = tolerance, max_iterations
        self._why, self._place = "", None
        before = self.iterations
        self.system.apply_conditions(x)
        self.snes.solve(None, x)
        return self.result(self.iterations - before)

    def result(self, iterations: int) -> NewtonResult:
        """How the last solve ended, which took ``iterations``."""
        reason = self.snes.getConvergedReason()
        if reason < 0 and not self._why:
            self._explain(reason)
        if reason == PETSc.SNES.ConvergedReason.DIVERGED_LINEAR_SOLVE:
            # after a failed factorisation MUMPS refuses (INFOG(1) = -3) until it is set up anew
            self.snes.getKSP().reset()
        return NewtonResult(reason > 0, iterations, self._why, self._place)

    def _explain(self, reason: int) -> None:
        """Why SNES itself gave up."""
        reasons = PETSc.SNES.ConvergedReason
        if reason == reasons.DIVERGED_LINEAR_SOLVE:
            self._why = self._linear_failure()
        elif reason == reasons.DIVERGED_LINE_SEARCH and self.system.lowest_jacobian > 0.0:
            self._why = "the line search found no better state"
        elif reason in (reasons.DIVERGED_LINE_SEARCH, reasons.DIVERGED_FNORM_NAN):
            self._not_defined()
        else:
            self._why = f"SNES stopped with reason {reason}"

    def _linear_failure(self) -> str:
        ksp = self.snes.getKSP()
        if ksp.getConvergedReason() == PETSc.KSP.ConvergedReason.DIVERGED_MAX_IT:
            return (f"the linear solver did not converge in {ksp.getIterationNumber()} "
                    'iterations; solver.preset = "direct" needs none')
        return "the linear solver failed: the matrix is singular to working precision"

    def destroy(self) -> None:
        for o in (*([self.snes] if self._owned else []), self.matrix, self.residual):
            o.destroy()
        if self.linear is not None:
            self.linear.destroy()
