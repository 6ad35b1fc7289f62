"""The output directory as a whole: what lies where, and what goes when a new run begins.

A run of many steps begins with begin_run, adds to history.csv, frames and checkpoint.h5 as it goes
(HistoryWriter, FrameWriter, write_checkpoint) and ends with write_results; a steady run needs the
last only.

All that is written is collective: what grows with the volume each rank writes its part of, the rest
rank 0.
"""

import os
from pathlib import Path
from typing import Any

from porolub.errors import SceneError
from porolub.io.atomic import replacing, reported, write_text
from porolub.io.checkpoint import write_checkpoint
from porolub.io.fields import write_fields
from porolub.io.frames import remove_frames
from porolub.io.history import write_history
from porolub.io.summary import write_summary
from porolub.io.surface import write_surface
from porolub.io.surface_map import DATA as MAP
from porolub.io.surface_map import INDEX as MAP_INDEX
from porolub.io.surface_map import write_surface_map
from porolub.scene import Scene, write_resolved
from porolub.solve.report import Report, Resume, SurfaceMap
from porolub.together import ALONE, on_root

SUMMARY = "summary.json"
HISTORY = "history.csv"
CHECKPOINT = "checkpoint.h5"
SURFACE = "surface.csv"
SCENE = "scene.resolved.toml"
OPTIONS = "petsc.options"
PLOTS = ("von_mises.png", "pressure.png", "surface.png", "flow.png")
"""Pictures of the last state."""
MAP_PLOTS = ("profile_s.png", "profile_z.png")
"""Further ones of a body, whose surface.png and flow.png are maps."""
HISTORY_PLOTS = ("loads.png", "flows.png", "friction.png", "lengths.png")
"""Pictures of how it came about."""
ANIMATION = "animation.gif"

_PICTURES = (*PLOTS, *MAP_PLOTS, *HISTORY_PLOTS, ANIMATION)
_SURFACES = (SURFACE, MAP_INDEX, MAP)
_FIELDS = ("fields.xdmf", "fields.h5")  # the description goes before what it describes


def prepare_directory(directory: Path) -> None:
    """Make the directory. Raises SceneError where that is impossible or it is not writable."""
    if directory.exists() and not directory.is_dir():
        raise SceneError(f"{directory}: this is a file; a directory is needed for the results.")
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SceneError(
            f"{directory}: the directory for the results cannot be made ({error.strerror})."
        ) from error
    if not os.access(directory, os.W_OK | os.X_OK):
        raise SceneError(f"{directory}: you may not write into this directory.")


def begin_run(
    directory: Path, scene: Scene, petsc_options: str = "", *, resume: bool = False
) -> str:
    """Make the directory ready for a run of many steps and return the resolved scene as TOML.

    What restart needs but a checkpoint is there from now on: scene.resolved.toml and petsc.options
    (``petsc_options`` as PETSc reads them). All of an earlier run is taken away; with ``resume``
    only its summary and pictures, for that run goes on. Raises SceneError where the directory
    cannot be written.
    """
    prepare_directory(directory)
    try:
        _remove(directory, SUMMARY, *_PICTURES)
        if not resume:
            _remove(directory, CHECKPOINT, HISTORY, *_SURFACES, *_FIELDS)
            remove_frames(directory)
        return _write_input(directory, scene, petsc_options)
    except OSError as error:
        reason = error.strerror or error
        raise SceneError(f"{directory}: a run cannot write its files here ({reason}).") from error


def write_results(
    directory: Path,
    report: Report,
    scene: Scene,
    petsc_options: str = "",
    *,
    plots: bool = True,
    history_written: bool = False,
    comm: Any = ALONE,
) -> None:
    """Write all results of a run but log.txt, which grows as the run goes (setup_logging).

    ``petsc_options``: text of petsc.options, as PETSc reads it. ``history_written``: history.csv,
    checkpoint.h5 and frames were written as the run went and stay as they are. Each file is
    replaced as a whole. An earlier run's summary.json and what the new run has no data for are
    taken away first and summary.json comes after all data, so a directory that has one is
    complete. Raises SceneError where there can be no such directory and SolveError where a file
    cannot be written, on all ranks.
    """

    def begin() -> str:
        prepare_directory(directory)
        with reported(directory, "the results"):
            _remove(directory, SUMMARY, *_PICTURES)
            if report.surface is None:
                _remove(directory, *_SURFACES)
            elif not isinstance(report.surface, SurfaceMap):
                _remove(directory, MAP_INDEX, MAP)
            return _write_input(directory, scene, petsc_options)

    def end() -> None:
        with reported(directory, "the results"):
            _write_surface(directory, report)
            if not history_written:
                write_history(directory / HISTORY, report.history)
            write_summary(directory / SUMMARY, report.summary)
            if plots:
                from porolub.io.plots import plot_directory  # matplotlib takes a while to import

                plot_directory(directory)

    toml = on_root(comm, begin)
    with reported(directory, "the results"):
        write_fields(directory, report.fields, _time(report), comm)
        if not history_written:
            _write_only_state(directory, report, scene, toml, comm)
    on_root(comm, end)


def _write_surface(directory: Path, report: Report) -> None:
    if report.surface is not None:
        write_surface(directory / SURFACE, report.surface)
    if isinstance(report.surface, SurfaceMap):
        write_surface_map(directory, report.surface, _time(report))


def _write_input(directory: Path, scene: Scene, petsc_options: str) -> str:
    with replacing(directory / SCENE) as (temporary,):
        write_resolved(scene, temporary)
    write_text(directory / OPTIONS, petsc_options.rstrip("\n") + "\n")
    return (directory / SCENE).read_text(encoding="utf-8")


def _write_only_state(
    directory: Path, report: Report, scene: Scene, toml: str, comm: Any
) -> None:
    """Checkpoint of a steady run, whose state no time step led to."""

    def clear() -> None:
        remove_frames(directory)
        _remove(directory, CHECKPOINT)

    on_root(comm, clear)
    if report.state is not None:
        resume = Resume(states=(report.state,), orders=(0,), step=0.0)
        digest = on_root(comm, scene.digest)
        write_checkpoint(directory / CHECKPOINT, resume, toml, digest, comm)


def _time(report: Report) -> float:
    if report.state is not None:
        return report.state.time
    return report.history[-1].time if report.history else 0.0


def _remove(directory: Path, *names: str) -> None:
    """Take away what there is of these files, and what a killed write left of them."""
    for name in names:
        (directory / name).unlink(missing_ok=True)
        (directory / f".{name}.tmp").unlink(missing_ok=True)
