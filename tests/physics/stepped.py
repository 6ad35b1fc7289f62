"""From the tables of a scene with [time] to its steps, as `porolub run` takes them, without files.

Every step is looked at as it is accepted; times in s, all else in SI.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.scene import scene_from_dict
from porolub.solve.derived import Derived
from porolub.solve.options import set_options
from porolub.solve.transient import TransientSolver
from porolub.solve.watch import Watch

Array = NDArray[np.float64]


class Look:
    """The present state of a run."""

    def __init__(self, solver: TransientSolver) -> None:
        self.solver, self.model = solver, solver.model
        self.derived = Derived(solver.model, solver.stepper.x)

    @property
    def nodes(self) -> Array:
        """(n, dim) positions, m."""
        return self.model.mesh.coordinates * self.model.scales.length

    def displacement(self) -> Array:
        """(n, dim) at all nodes, m."""
        return self.derived.nodal("u") * self.model.scales.length

    def pressure(self) -> tuple[Array, Array]:
        """(k, dim) nodes that carry it and (k,) values, Pa."""
        at = self.model.dofs.nodes["p"]
        return self.nodes[at], self.derived.nodal("p")[at, 0] * self.model.scales.pressure


@dataclass
class Steps:
    """Columns of the history, and what was seen at the same times (one row per step)."""

    solver: TransientSolver
    message: str = ""
    seen: list[Any] = field(default_factory=list)
    rejections: list[tuple[float, float, str]] = field(default_factory=list)

    def __getitem__(self, key: str) -> Array:
        """A column of the history, (n,) SI; the row of the start is the first."""
        records = self.solver.records
        if key == "time":
            return np.array([r.time for r in records])
        return np.array([r.values[key] for r in records])

    @property
    def steps(self) -> int:
        return self.solver.totals.time_steps

    @property
    def sight(self) -> Array:
        return np.array(self.seen)

    def fluid_error(self) -> float:
        """Largest |content - gained| of all steps over the largest content or gain."""
        held, gained = self["fluid_content"], self["fluid_gained"]
        return float(np.abs(held - gained).max() / np.abs([held, gained]).max())

    def last(self) -> Look:
        return Look(self.solver)


@contextmanager
def options(text: str) -> Iterator[None]:
    """PETSc options as `--petsc` gives them, and the defaults back afterwards."""
    names = set_options(text)
    try:
        yield
    finally:
        for name in names:
            PETSc.Options().delValue(name)
        set_options("")


def stepped(tables: dict[str, Any], look: Callable[[Look], Any] = lambda look: None,
            base_dir: Path | None = None, petsc: str = "", fails: bool = False) -> Steps:
    """Run a scene; fails the test with the solver's own sentence if it does not reach its end."""
    with options(petsc):
        return _stepped(tables, look, base_dir, fails)


def fixed(tables: dict[str, Any], count: int, **others: Any) -> Steps:
    """The same in ``count`` equal steps."""
    end = float(tables["time"]["end"].split()[0])
    time = {"first_step": f"{end / count!r} s", **tables["time"]}
    run = stepped({**tables, "time": time}, petsc="-ts_adapt_type none", **others)
    assert run.steps == count
    assert not run.rejections
    return run


def _stepped(tables: dict[str, Any], look: Callable[[Look], Any], base_dir: Path | None,
             fails: bool) -> Steps:
    scene = scene_from_dict(tables, base_dir)
    steps: Steps

    def after(record: Any) -> None:
        steps.seen.append(look(Look(steps.solver)))

    watch = Watch(step=after, rejected=lambda *r: steps.rejections.append(r))
    steps = Steps(TransientSolver(scene, MPI.COMM_SELF, watch))
    outcome = steps.solver.solve()
    assert outcome.converged is not fails, outcome.message
    steps.message = outcome.message
    return steps
