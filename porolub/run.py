"""The composition root of ``porolub run``: scene -> solve -> report -> files, table, comparison."""

from __future__ import annotations

import logging
import resource
import time
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI
from rich.console import Console

from porolub.errors import SceneError, SolveError
from porolub.io.directory import write_results
from porolub.io.log import close_logging, setup_logging
from porolub.io.printed import printed_for
from porolub.io.progress import Progress
from porolub.io.table import print_comparison, print_results
from porolub.scene import effects
from porolub.solve.derived import scalars
from porolub.solve.gather import gather_fields, gather_state, gather_surface
from porolub.solve.options import set_options
from porolub.solve.report import Report, StepRecord
from porolub.solve.steady import Outcome, SteadySolver
from porolub.versions import versions

log = logging.getLogger(__name__)
FIELD_NAMES = {"u": "displacement", "l": "contact_pressure", "v0": "approach", "j": "volume_change"}


def run_scene(scene: Any, out_dir: Path, petsc_options: str = "", quiet: bool = False,
              scene_path: Path | None = None) -> int:
    """Solve a scene and write its output directory. Returns 0. Collective.

    Raises SceneError for a scene that cannot be run and SolveError when the solve failed; what
    was computed is written first."""
    if scene.time is not None:
        raise SceneError("transient scenes are not supported by this version: remove [time] or "
                         "use --set time=none for the steady state at t = 0.")
    comm = MPI.COMM_WORLD
    root = comm.rank == 0
    user_options = set_options(petsc_options)
    setup_logging(Path(out_dir) if root else None)
    try:
        with Progress("quiet" if quiet or not root else "auto") as progress:
            solver = SteadySolver(scene, comm, progress.newton, progress.stage, user_options)
            outcome = solver.solve()
        report = make_report(scene, outcome)
        if report is not None:
            start = time.perf_counter()
            write_results(Path(out_dir), report, scene, _options_used())
            outcome.clock.add("output", start)
            _show(report, scene, Path(out_dir), quiet)
        if not outcome.converged:
            raise SolveError(f"{outcome.message} What was computed is in {out_dir}.")
        return 0
    finally:
        close_logging()


def _options_used() -> str:
    """Every option of porolub's solver in force, one a line, as PETSc reads them."""
    from petsc4py import PETSc

    return "\n".join(f"-{k} {v}" for k, v in sorted(PETSc.Options().getAll().items()))


def make_report(scene: Any, outcome: Outcome) -> Report | None:
    """Summary, fields and profiles of an outcome on rank 0, None elsewhere. Collective."""
    model, x = outcome.model, outcome.x
    start = time.perf_counter()
    values = scalars(model, x)
    fields = gather_fields(model, x)
    surface = gather_surface(model, x)
    state = gather_state(model, x)
    outcome.clock.add("output", start)
    counts = _counts(model)
    comm = model.mesh.comm
    memory = comm.allreduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)
    spent = {k: comm.allreduce(v, op=MPI.MAX) for k, v in outcome.clock.spent.items()}
    if fields is None:
        return None
    summary: dict[str, Any] = {
        "status": "converged" if outcome.converged else "failed", "message": outcome.message,
        **values,
        "von_mises_max": float(np.max(fields.von_mises)) if model.law is not None else None,
        "jacobian_min": model.system.lowest_jacobian if model.law is not None else None,
        "effects": effects(scene), "dofs": counts, "ranks": comm.size,
        "newton_iterations": outcome.newton_iterations,
        "linear_iterations": outcome.linear_iterations,
        "time_steps": 0, "rejected_steps": outcome.rejected_steps,
        "wall_time": {**spent, "total": outcome.clock.elapsed()},
        "peak_memory": memory, "versions": versions(),
    }
    step = {k: v for k, v in values.items() if isinstance(v, float)}
    return Report(summary, fields, surface, outcome.newton, [StepRecord(0.0, step)], state)


def _counts(model: Any) -> dict[str, int]:
    names = dict(FIELD_NAMES)
    names["p"] = "pore_pressure" if model.scene.pores is not None else "film_pressure"
    counts = {names.get(k, k): v for k, v in model.dofs.counts().items()}
    return {**counts, "total": sum(counts.values())}


def _show(report: Report, scene: Any, out_dir: Path, quiet: bool) -> None:
    if quiet:
        return
    console = Console()
    print_results(console, report.summary, scene)
    printed = printed_for(scene.title)
    if printed is not None:
        print_comparison(console, report.summary, printed, scene)
    console.print(f"Results in [bold]{out_dir}[/bold]")
