"""The composition root of ``porolub run``: scene -> solve -> files, table, comparison."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mpi4py import MPI

from porolub.finish import finish
from porolub.interrupt import Interrupt
from porolub.io.log import close_logging, setup_logging
from porolub.io.progress import Progress
from porolub.run_transient import run_transient
from porolub.solve.accurate import steady_solver
from porolub.solve.options import forget_options, set_options
from porolub.together import on_root


def run_scene(scene: Any, out_dir: Path, petsc_options: str = "", quiet: bool = False) -> int:
    """Solve a scene and write its output directory. Returns 0. Collective.

    Raises SceneError for a scene that cannot be run, SolveError when the solve failed and
    Interrupted when it was told to stop; what was computed is written first."""
    if scene.time is not None:
        return run_transient(scene, out_dir, petsc_options, quiet)
    comm = MPI.COMM_WORLD
    root = comm.rank == 0
    user_options = set_options(petsc_options)
    setup_logging(None)
    on_root(comm, lambda: setup_logging(Path(out_dir)))
    try:
        with Interrupt() as interrupt, Progress("quiet" if quiet or not root else "auto") as shown:
            solver = steady_solver(scene, comm, shown.newton, shown.stage, user_options,
                                   interrupt.raise_if_asked)
            outcome = solver.solve()
        finish(outcome.model.scene, outcome, Path(out_dir), quiet)
        outcome.destroy()
        return 0
    finally:
        close_logging()
        forget_options()
