"""Runs of transient scenes for the hard cases: what is seen after every step, and restarts."""

from __future__ import annotations

from dataclasses import astuple
from pathlib import Path
from unittest.mock import patch

import numpy as np
from mpi4py import MPI

from porolub.errors import PorolubError
from porolub.io.history import read_history
from porolub.run_transient import restart
from porolub.scene import Scene
from porolub.solve.options import forget_options, set_options
from porolub.solve.report import StepRecord
from porolub.solve.transient import TransientSolver
from porolub.solve.watch import Watch
from tests.hard.measures import Measures, measured
from tests.physics.cases import Run
from tests.run.transient import ROW, run, stopped

COMPARED = ("load_solid", "load_fluid", "approach", "friction_coefficient", "contact_length")


class History(Run):
    """A run that has ended, with what was measured after each step."""

    seen: list[Measures]

    @property
    def worst(self) -> Measures:
        """The largest of each measure over all steps."""
        return Measures(*map(max, zip(*map(astuple, self.seen), strict=True)))


def history_of(scene: Scene, petsc: str = "") -> History:
    """From zero in one go. Raises SceneError for a scene that is refused."""
    done = History(scene)
    done.seen = []

    def after(record: StepRecord) -> None:
        done.seen.append(measured(solver.model, solver.stepper.x))

    watch = Watch(step=after, rejected=lambda *what: done.rejections.append(what))
    try:
        set_options(petsc)
        solver = TransientSolver(scene, MPI.COMM_SELF, watch)
        outcome = solver.solve()
        done.converged, done.message = outcome.converged, outcome.message
        done.overall, done.records = outcome.overall, solver.records
        solver.destroy()
    finally:
        forget_options()
    return done


def difference_after_restart(scene: Scene, directory: Path, stop_at: float) -> float:
    """Stop a run at a time (s), restart it from its checkpoint, compare with one not stopped.

    Returns the largest difference of COMPARED over the steps after the stop, of their largest
    values. Raises AssertionError if there was nothing to restart or it did not end.
    """
    whole, parted = directory / "whole", directory / "parted"
    with patch("porolub.io.plots.plot_directory", lambda directory: []):
        run(whole, scene)
        one = read_history(whole / "history.csv")
        rows = int(np.searchsorted(one["time"], stop_at)) + 1
        assert 1 < rows < len(one["time"]), f"nothing to restart: steps end at {one['time']}"
        stopped(parted, scene, ROW, rows)
        try:
            assert restart(parted, quiet=True) == 0
        except PorolubError as error:
            raise AssertionError(f"after the restart: {error}") from error
    other = read_history(parted / "history.csv")
    assert len(other["time"]) > rows, "no steps after the restart"
    after = one["time"][rows:]
    return max(float(np.abs(np.interp(after, other["time"], other[key]) - one[key][rows:]).max()
                     / max(np.abs(one[key]).max(), 1e-300)) for key in COMPARED)
