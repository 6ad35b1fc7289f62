"""As fine a mesh and as small steps as the accuracy asked for needs, and no finer.

A steady state is solved on graded meshes of ever more elements until its estimated errors
(porolub.solve.estimate) are small enough.  Of a run in time the mesh is chosen by the steady state
it starts from, the tolerance by a trial run on a coarse mesh: what the steps do wrong hardly
depends on the mesh.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from porolub.solve.derived import scalars
from porolub.solve.estimate import Numbers, RunErrors, relative
from porolub.solve.levels import COARSEST
from porolub.solve.neighbours import Neighbour
from porolub.solve.newton import Clock
from porolub.solve.steady import Outcome, SteadySolver
from porolub.solve.transient import TransientSolver

log = logging.getLogger(__name__)
ORDER = 1.5  # of convergence that is counted on, in space
GROWS = (1.3, 2.0)  # elements from one mesh to the next, at least and at most
FEWEST = 3  # elements through the thickness and in depth
IN_TIME = 0.5  # share of the allowed error that is the steps', in a run in time
TRIALS = 4  # runs that look for a tolerance
TIGHTEST, LOOSEST = 1e-7, 1e-2  # tolerances of a step


def steady_solver(scene: Any, comm: Any, *args: Any, **options: Any
                  ) -> SteadySolver | AccurateSolver:
    """What solves a steady scene."""
    kind = SteadySolver if scene.accuracy is None else AccurateSolver
    return kind(scene, comm, *args, **options)


class AccurateSolver:
    """A SteadySolver of a scene with [accuracy], which chooses the mesh."""

    def __init__(self, scene: Any, comm: Any, *hooks: Any, neighbours: Sequence[Neighbour] = (),
                 **options: Any) -> None:
        """As SteadySolver; neighbours are not used, for their meshes may be too coarse."""
        self.scene, self.comm = scene, comm
        self._hooks, self._options = hooks, options
        self.warm = False

    def solve(self, allowed: float = 1.0) -> Outcome:
        """Solve on ever finer meshes; ``allowed``: share of the errors asked for.

        ``model.scene`` of the outcome is the scene with the mesh that was chosen.
        """
        count = min(2 * COARSEST[self.scene.dimension], self.scene.accuracy.elements)
        newton = linear = rejected = 0
        before: Clock | None = None
        while True:
            scene = _with_mesh(self.scene, count)
            outcome = SteadySolver(scene, self.comm, *self._hooks, **self._options).solve()
            newton += outcome.newton_iterations
            linear += outcome.linear_iterations
            rejected += outcome.rejected_steps
            outcome.newton_iterations, outcome.linear_iterations = newton, linear
            outcome.rejected_steps = rejected
            if before is not None:
                outcome.clock.include(before)
            before = outcome.clock
            if not outcome.converged:
                return outcome
            numbers = scalars(outcome.model, outcome.x)
            excess = _excess(self.scene, outcome.errors, numbers) / allowed
            on = f"on {count} x {scene.mesh.across} elements"
            if excess <= 1.0:
                outcome.message = f"converged: {_reached(self.scene, outcome.errors, numbers)} {on}"
                return outcome
            if count >= self.scene.accuracy.elements:
                outcome.converged, outcome.status = False, "failed"
                outcome.message = (
                    f"The accuracy asked for is not reached {on}: "
                    f"{_reached(self.scene, outcome.errors, numbers)}; raise accuracy.elements.")
                return outcome
            log.info("%s: the error is %.2g times what is allowed", on, excess)
            grows = float(np.clip(excess ** (1.0 / ORDER), *GROWS))
            count = min(int(np.ceil(count * grows)), self.scene.accuracy.elements)
            outcome.destroy()


def chosen_in_time(scene: Any, comm: Any, stop: Callable[[Any], str] = lambda comm: "") -> Any:
    """A scene with [time] and [accuracy] with its mesh and tolerance chosen. Collective.

    The scene as it is where a trial fails, for the run itself to say why.
    """
    outcome = AccurateSolver(scene, comm, stop=stop).solve(1.0 - IN_TIME)
    fine = outcome.model.scene
    outcome.destroy()
    if not outcome.converged:
        return fine
    coarse = _with_mesh(scene, COARSEST[scene.dimension])
    tolerance = float(np.clip(scene.time.tolerance, TIGHTEST, LOOSEST))
    for _ in range(TRIALS):
        trial = _with_tolerance(coarse, tolerance)
        solver = TransientSolver(trial, comm, stop=stop, give_up=stop)
        done = solver.solve()
        records = list(solver.records)
        solver.destroy()
        if not done.converged:
            return fine
        errors = RunErrors(dict.fromkeys(scene.accuracy.wanted(), 0.0)).at_end(
            records, scene.time.order)
        excess = _excess(scene, errors, records[-1].values) / IN_TIME
        log.info("tolerance %.2g: the error in time is %.2g times what is allowed", tolerance,
                 excess)
        if excess <= 1.0 or tolerance <= TIGHTEST:
            break
        order = scene.time.order
        tolerance = max(tolerance * (0.8 / excess) ** ((order + 1.0) / order), TIGHTEST)
    return _with_tolerance(fine, tolerance)


def _with_mesh(scene: Any, along: int) -> Any:
    """The scene on a graded mesh of so many elements, the others in proportion."""
    given = scene.mesh
    counts: dict[str, Any] = {"along": along, "grading": "contact"}
    for key in ("across", "deep"):
        if getattr(given, key):
            counts[key] = max(FEWEST, round(getattr(given, key) * along / given.along))
    return scene.model_copy(update={"mesh": given.model_copy(update=counts)})


def _with_tolerance(scene: Any, tolerance: float) -> Any:
    time = scene.time.model_copy(update={"tolerance": tolerance})
    return scene.model_copy(update={"time": time})


def _excess(scene: Any, errors: Numbers, numbers: Numbers) -> float:
    """The largest error over what is allowed; infinite where there is no estimate yet."""
    found = relative(errors, numbers)
    wanted = {name: share for name, share in scene.accuracy.wanted().items() if numbers.get(name)}
    return max((found.get(name, np.inf) / share for name, share in wanted.items()), default=0.0)


def _reached(scene: Any, errors: Numbers, numbers: Numbers) -> str:
    """The errors in words, as "friction_coefficient to 0.4 % (asked: 1 %)"."""
    found = relative(errors, numbers)
    return ", ".join(
        f"{name} to {100 * found[name]:.2g} % (asked: {100 * share:.2g} %)"
        for name, share in scene.accuracy.wanted().items() if name in found)
