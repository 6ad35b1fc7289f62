"""How a run ends: report, files, table, comparison, and the error it ends with."""

from __future__ import annotations

import resource
import time
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI

from porolub.errors import Interrupted, SolveError
from porolub.io.directory import HISTORY, write_results
from porolub.io.history import read_history
from porolub.io.history_table import print_history_table
from porolub.io.printed import printed_for
from porolub.io.table import print_comparison, print_results
from porolub.io.terminal import new_console
from porolub.scene import effects
from porolub.solve.derived import scalars
from porolub.solve.doubts import doubts
from porolub.solve.gather import gather_fields, gather_state, gather_surface
from porolub.solve.linear import final_preset
from porolub.solve.options import text_of_options
from porolub.solve.report import Report, StepRecord
from porolub.solve.steady import Outcome
from porolub.versions import versions

FIELD_NAMES = {"u": "displacement", "l": "contact_pressure", "v0": "approach", "j": "volume_change",
               "w": "velocity"}


def finish(scene: Any, outcome: Outcome, out_dir: Path, quiet: bool) -> None:
    """Write and show the results. Collective. Raises SolveError if the solve failed, Interrupted
    if it was interrupted."""
    report, comm = make_report(scene, outcome), outcome.model.mesh.comm
    transient = scene.time is not None
    interrupted = outcome.status == "interrupted"
    start = time.perf_counter()

    options = options_used(scene) if comm.rank == 0 else ""  # may count a mesh file
    write_results(out_dir, report, scene, options, plots=not interrupted,
                  history_written=transient, comm=comm)
    outcome.clock.add("output", start)
    if comm.rank == 0 and not quiet and not interrupted:
        _show(report, scene, out_dir)
    if interrupted:
        raise Interrupted(f"{outcome.message} at t = {outcome.overall['time']:.6g} s; porolub "
                          f"restart {out_dir} goes on from there.")
    if not outcome.converged:
        raise SolveError(f"{outcome.message} What was computed is in {out_dir}.")


def options_used(scene: Any) -> str:
    """Every option of the solver on the scene's own mesh, one a line, as PETSc reads them."""
    return text_of_options(final_preset(scene))


def make_report(scene: Any, outcome: Outcome) -> Report:
    """Summary, fields, profiles and state of an outcome. Collective."""
    model, x = outcome.model, outcome.x
    start = time.perf_counter()
    values = scalars(model, x)
    fields = gather_fields(model, x)
    surface = gather_surface(model, x)
    reached = outcome.overall.get("time", 0.0)
    state = gather_state(model, x, reached)
    outcome.clock.add("output", start)
    counts = _counts(model)
    comm = model.mesh.comm
    memory = comm.allreduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)
    spent = {k: comm.allreduce(v, op=MPI.MAX) for k, v in outcome.clock.spent.items()}
    stress = comm.allreduce(fields.von_mises.max(initial=-np.inf), op=MPI.MAX)
    summary: dict[str, Any] = {
        "status": outcome.status, "message": outcome.message,
        **values, "error_estimate": dict(outcome.errors),
        "warnings": doubts(scene, values, outcome.errors) if outcome.converged else [],
        "von_mises_max": float(stress) if model.law is not None else None,
        "jacobian_min": model.system.lowest_jacobian if model.law is not None else None,
        "effects": effects(scene), "dofs": counts, "ranks": comm.size,
        "newton_iterations": outcome.newton_iterations,
        "linear_iterations": outcome.linear_iterations,
        "time_steps": outcome.time_steps, "rejected_steps": outcome.rejected_steps,
        "wall_time": {**spent, "total": outcome.clock.elapsed()},
        "peak_memory": memory, "versions": versions(), **outcome.overall,
    }
    step = {k: v for k, v in values.items() if isinstance(v, float)}
    return Report(summary, fields, surface, outcome.newton, [StepRecord(reached, step)], state)


def _counts(model: Any) -> dict[str, int]:
    names = dict(FIELD_NAMES)
    names["p"] = "pore_pressure" if model.scene.pores is not None else "film_pressure"
    counts = {names.get(k, k): v for k, v in model.dofs.counts().items()}
    return {**counts, "total": sum(counts.values())}


def _show(report: Report, scene: Any, out_dir: Path) -> None:
    console = new_console()
    print_results(console, report.summary, scene)
    if scene.time is not None and (out_dir / HISTORY).exists():  # not if the start failed
        print_history_table(console, read_history(out_dir / HISTORY), scene)
    printed = printed_for(scene.title)
    if printed is not None:
        print_comparison(console, report.summary, printed, scene)
    console.print(f"Results in [bold]{out_dir}[/bold]")
