"""One case of a sweep: its scene solved, its row made; what goes wrong with it stays in its row."""

from __future__ import annotations

import logging
import sys
import time
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mpi4py import MPI
from petsc4py import PETSc

from porolub.errors import Interrupted, PorolubError, SceneError, SolveError
from porolub.finish import make_report, options_used
from porolub.interrupt import Interrupt
from porolub.io.directory import write_results
from porolub.io.progress import Progress
from porolub.io.solution import read_solution, write_solution
from porolub.run_transient import Recorder, begin, recorded
from porolub.solve.accurate import chosen_in_time, steady_solver
from porolub.solve.neighbours import Neighbour, solution_of
from porolub.solve.options import UnusedOption
from porolub.solve.steady import Outcome
from porolub.solve.transient import TransientSolver
from porolub.study.work.case_directories import case_directory, claim
from porolub.study.work.outcome import in_words
from porolub.study.work.over_time import over_time
from porolub.study.work.regimes import regime, sommerfeld_number
from porolub.study.work.tasks import Row, Starts, Task

log = logging.getLogger(__name__)
STATES = "states"
PATIENCE = 10.0  # s that a rank in error waits for the others of its group to get there too


class Trouble(PorolubError):
    """Not the case is at fault: the sweep as a whole cannot go on."""

    exit_code = 3


@dataclass(frozen=True)
class Cases:
    """How the cases of a sweep are run by one group of ranks.

    directory: of the sweep; results: whether each case has an output directory of its own;
    user_options: names of PETSc options that some solver must read.
    """

    directory: Path
    comm: Any
    results: bool
    user_options: Sequence[str]
    interrupt: Interrupt

    def row(self, task: Task) -> Row:
        """Compute a case; the same row on all ranks of the group. Collective.

        Raises Interrupted, UnusedOption, and Trouble where files cannot be written.
        """
        case, began = task.case, time.perf_counter()
        assert case.scene is not None
        row: dict[str, Any] = {
            "key": case.key, "case": case.index, "status": "failed", "message": "",
            "axes": case.axes, "values": case.values, "sommerfeld_number": None, "regime": "",
            "start": "zero", "starts": [], "wall": 0.0, "summary": {},
        }
        try:
            self.interrupt.raise_if_asked(self.comm)
            with _together(self.comm):
                summary, starts = self._solve(task)
            row |= {"start": in_words([i for i, *_ in starts]), "starts": [k for _, k, _ in starts]}
            row |= {"status": summary["status"], "message": summary["message"]}
            if summary["status"] == "converged":
                row |= {"summary": summary, "regime": regime(summary),
                        "sommerfeld_number": sommerfeld_number(case.scene, summary)}
        except Interrupted as error:  # a case has no state of its own to keep
            raise Interrupted(f"{self.interrupt.asked(self.comm)}.") from error
        except (UnusedOption, Trouble):
            raise
        except SceneError as error:  # what only the mesh or the model could know
            row |= {"status": "refused", "message": str(error)}
        except Exception as error:
            row["message"] = _failure(error)
        row["wall"] = time.perf_counter() - began
        return row

    def _neighbours(self, task: Task) -> list[Neighbour]:
        """What to start from; nothing if a state is not there."""
        try:
            return [Neighbour(read_solution(self._state(key), self.comm), weight)
                    for _, key, weight in task.starts]
        except SceneError as error:  # taken away by hand: costs iterations, no more
            log.warning("%s", error)
            return []

    def _state(self, key: str) -> Path:
        return self.directory / STATES / f"{key}.h5"

    def _solve(self, task: Task) -> tuple[dict[str, Any], Starts]:
        """Summary of a scene and what it was found from, if not zero; files are written, PETSc's
        memory freed."""
        scene: Any = task.case.scene
        comm, directory = self.comm, case_directory(self.directory, task.case)
        if self.results:
            with _in_trouble():
                claim(directory, task.case, comm)
        if scene.time is None:
            steady = steady_solver(scene, comm, user_options=self.user_options,
                                   stop=self.interrupt.raise_if_asked,
                                   neighbours=self._neighbours(task))
            outcome = steady.solve()
            with _in_trouble():
                summary = self._finish(outcome.model.scene, outcome, directory)
                if task.wanted and outcome.converged and outcome.model.mesh.shape is not None:
                    state = solution_of(outcome.model, outcome.x)
                    write_solution(self._state(task.case.key), state, comm)
            outcome.destroy()
            return summary, task.starts if steady.warm else ()
        if scene.accuracy is not None:
            scene = chosen_in_time(scene, comm, self.interrupt.raise_if_asked)
        if self.results:
            with _in_trouble():
                recorder = Recorder(directory, scene, comm, Progress("quiet"),
                                    begin(scene, directory, comm))
            solver, outcome = recorded(scene, recorder, self.user_options, self.interrupt)
        else:
            solver = TransientSolver(scene, comm, user_options=self.user_options,
                                     stop=self.interrupt.asked,
                                     give_up=self.interrupt.raise_if_asked)
            outcome = solver.solve()
        if outcome.status == "interrupted":
            raise Interrupted(f"{outcome.message}.")
        with _in_trouble():
            summary = self._finish(scene, outcome, directory)
        summary["over_time"] = over_time(solver.records, scene.period)
        solver.destroy()
        return summary, ()

    def _finish(self, scene: Any, outcome: Outcome, directory: Path) -> dict[str, Any]:
        report = make_report(scene, outcome)
        if self.results:
            options = options_used(scene) if self.comm.rank == 0 else ""
            write_results(directory, report, scene, options,
                          history_written=scene.time is not None, comm=self.comm)
        return report.summary


@contextmanager
def _in_trouble() -> Iterator[None]:
    """Where files are written: an error is no fault of the case."""
    try:
        yield
    except SolveError as error:
        raise Trouble(str(error)) from error


@contextmanager
def _together(comm: Any) -> Iterator[None]:
    """Let an error pass if all ranks of the group have one; end the job where one is alone."""
    try:
        yield
    except Exception:
        request, deadline = comm.Ibarrier(), time.monotonic() + PATIENCE
        while not request.Test():
            if time.monotonic() > deadline:
                traceback.print_exc()
                sys.stderr.flush()
                MPI.COMM_WORLD.Abort(1)
            time.sleep(0.01)
        raise


def _failure(error: Exception) -> str:
    """What went wrong, for the row of the case."""
    if isinstance(error, SolveError):
        return str(error)
    log.exception("a case failed")
    if isinstance(error, PETSc.Error):
        return f"PETSc failed with error code {error.ierr}; log.txt or stderr says where."
    return f"{type(error).__name__}: {error}; log.txt says where."
