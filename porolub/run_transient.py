"""The composition root of transient runs: scene or checkpoint -> steps -> files, as they come."""

from __future__ import annotations

import time as wall
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from mpi4py import MPI
from petsc4py import PETSc

from porolub.errors import SceneError
from porolub.finish import finish, options_used
from porolub.interrupt import Interrupt
from porolub.io.checkpoint import read_checkpoint, read_digest, write_checkpoint
from porolub.io.directory import CHECKPOINT, HISTORY, OPTIONS, SCENE, SUMMARY, begin_run
from porolub.io.frames import FrameWriter
from porolub.io.history import HistoryWriter, read_records
from porolub.io.log import close_logging, setup_logging
from porolub.io.progress import Progress
from porolub.io.summary import read_summary
from porolub.scene import load_scene, scene_from_dict
from porolub.scene.compare import differences
from porolub.solve.accurate import chosen_in_time
from porolub.solve.options import forget_options, set_options, users_options
from porolub.solve.report import FrameData, Resume, StepRecord
from porolub.solve.steady import Outcome
from porolub.solve.transient import TransientSolver
from porolub.solve.watch import Watch
from porolub.together import on_root

SPARINGLY = 20.0  # a checkpoint is due after so many times what the last one took


class Recorder:
    """Writes what a run tells, as it comes: history.csv, frames, checkpoint.h5."""

    def __init__(self, directory: Path, scene: Any, comm: Any, progress: Progress,
                 toml: str) -> None:
        self.directory, self.comm, self.progress = directory, comm, progress
        self.toml, self.digest = toml, on_root(comm, scene.digest)
        self._due = 0.0

    def open(self, resume: Resume | None) -> list[StepRecord]:
        """Begin the files anew, or go on with those there are from where ``resume`` stands.

        Returns the steps so far, on all ranks. Collective.
        """
        frame = 0 if resume is None else resume.frame
        records = list(on_root(self.comm, lambda: self._open_history(resume)))
        self.frames = FrameWriter(self.directory, frame, self.comm)
        return records

    def _open_history(self, resume: Resume | None) -> list[StepRecord]:
        path = self.directory / HISTORY
        if resume is None:
            self.history = HistoryWriter(path)
            return []
        self.history = HistoryWriter(path, resume.states[0].time)
        return read_records(path) if path.exists() else []

    def watch(self) -> Watch:
        """The hooks of a TransientSolver."""
        p = self.progress
        return Watch(p.newton, p.stage, p.begin, self.step, p.rejected, self.frame,
                     self.checkpoint)

    def step(self, record: StepRecord) -> None:
        on_root(self.comm, lambda: self.history.write(record))
        self.progress.step(record)

    def frame(self, frame: FrameData) -> None:
        self.frames.write(frame)

    def checkpoint(self, gather: Callable[[], Resume], now: bool = False) -> None:
        """Write a checkpoint unless the last one is too recent for what it costs. Collective."""
        start = wall.perf_counter()
        if not self.comm.bcast(now or start >= self._due, root=0):
            return
        resume = gather()
        on_root(self.comm, lambda: self.history.sync())
        write_checkpoint(self.directory / CHECKPOINT, resume, self.toml, self.digest, self.comm)
        done = wall.perf_counter()
        self._due = done + SPARINGLY * (done - start)


def run_transient(scene: Any, out_dir: Path, petsc_options: str = "", quiet: bool = False,
                  resume: Resume | None = None) -> int:
    """Run a scene with [time], from its start or from a checkpoint. Returns 0. Collective.

    Errors as in ``run_scene``.
    """
    comm, out_dir = MPI.COMM_WORLD, Path(out_dir)
    root = comm.rank == 0
    user_options = set_options(petsc_options)
    if scene.accuracy is not None and resume is None:
        with Interrupt() as interrupt:
            scene = chosen_in_time(scene, comm, interrupt.raise_if_asked)
    toml = begin(scene, out_dir, comm, resumed=resume is not None)
    setup_logging(None)
    on_root(comm, lambda: setup_logging(out_dir, resume=resume is not None))
    try:
        with Interrupt() as interrupt, Progress("quiet" if quiet or not root else "auto") as shown:
            recorder = Recorder(out_dir, scene, comm, shown, toml)
            solver, outcome = recorded(scene, recorder, user_options, interrupt, resume)
            shown.done()  # its status would get between the lines of the tables
            finish(scene, outcome, out_dir, quiet)
            solver.destroy()
        return 0
    finally:
        close_logging()
        forget_options()


def begin(scene: Any, out_dir: Path, comm: Any, resumed: bool = False) -> str:
    """Make the output directory ready; returns the resolved scene as TOML. Collective."""
    return str(on_root(comm, lambda: begin_run(out_dir, scene, options_used(scene),
                                               resume=resumed)))


def recorded(scene: Any, recorder: Recorder, user_options: Sequence[str], interrupt: Interrupt,
             resume: Resume | None = None) -> tuple[TransientSolver, Outcome]:
    """Take the steps; files are written as they come, the results are still to write. Collective.

    The outcome is the solver's until that is destroyed.
    """
    records = recorder.open(resume)
    solver = TransientSolver(scene, recorder.comm, recorder.watch(), user_options,
                             interrupt.asked, interrupt.raise_if_asked)
    outcome = solver.solve(resume, records)
    if solver.records:
        recorder.checkpoint(solver.resume, now=True)
    return solver, outcome


def restart(directory: Path, overrides: Any = (), petsc_options: str = "",
            quiet: bool = False) -> int:
    """Go on with the run in an output directory from its checkpoint. Returns 0. Collective.

    ``overrides`` may change how far and how finely (porolub.scene.compare.MAY_CHANGE); PETSc
    options are those of the run so far, ``petsc_options`` on top. Raises SceneError for a
    directory without a checkpoint, or one of another scene (naming the keys).
    """
    comm, directory = MPI.COMM_WORLD, Path(directory)
    resume, before = read_checkpoint(directory / CHECKPOINT, comm)

    def read() -> tuple[dict[str, Any], str, str]:
        scene = load_scene(directory / SCENE, overrides)
        _refuse_other_scene(directory / CHECKPOINT, before, scene)
        options = directory / OPTIONS
        return (scene.resolved(), options.read_text() if options.exists() else "",
                _ended(directory, before, scene, resume.states[0].time))

    tables, options, ended = on_root(comm, read)
    if ended:
        if comm.rank == 0 and not quiet:
            print(f"{directory}: {ended}")
        return 0
    PETSc.Options().insertString(users_options(options))
    return run_transient(scene_from_dict(tables), directory, petsc_options, quiet, resume)


def _refuse_other_scene(checkpoint: Path, before: dict[str, Any], scene: Any) -> None:
    """Raise SceneError unless the checkpoint is one of this scene, but for how far it goes."""
    if "time" not in before:
        raise SceneError(f"{checkpoint.parent}: this is a steady run, there is nothing to go on "
                         "with.")
    keys = differences(before, scene.resolved())
    if not keys and scene_from_dict(before).digest() != read_digest(checkpoint):
        keys = ["the content of geometry.path"]  # the only thing a digest knows beside the tables
    if keys:
        raise SceneError(f"{checkpoint} belongs to a scene that differs in {', '.join(keys)}; only "
                         "how far and how finely a run goes may change (such as time.end): run "
                         "the scene anew.")


def _ended(directory: Path, before: dict[str, Any], scene: Any, reached: float) -> str:
    """Say why there is nothing left to do; empty where there is, be it the results to write."""
    path = directory / SUMMARY
    summary = read_summary(path) if path.exists() else {}
    if summary.get("status") != "converged":
        return ""
    if reached >= scene.time.end * (1 - 1e-12):
        return (f"the run has reached its end at t = {reached:g} s; --set time.end=... takes it "
                "further.")
    if scene.resolved()["time"] == before["time"]:
        return f"{summary['message']}; --set time.until=end takes the run further."
    return ""
