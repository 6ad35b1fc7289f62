"""The output directory as a whole."""

import os
from pathlib import Path

from porolub.errors import SceneError
from porolub.io.atomic import replacing, write_text
from porolub.io.checkpoint import write_checkpoint
from porolub.io.fields import write_fields
from porolub.io.history import write_history
from porolub.io.summary import write_summary
from porolub.io.surface import write_surface
from porolub.scene import Scene, write_resolved
from porolub.solve.report import Report

PLOTS = ("von_mises.png", "pressure.png", "surface.png", "flow.png")


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


def write_results(
    directory: Path, report: Report, scene: Scene, petsc_options: str = "", *, plots: bool = True
) -> None:
    """Write all results of a run but log.txt, which grows as the run goes (setup_logging).

    ``petsc_options``: text of petsc.options, as PETSc reads it. Each file is replaced as a whole.
    An earlier run's summary.json and what the new run has no data for are taken away first and
    summary.json comes after all data, so a directory that has one is complete. Raises SceneError
    where the directory cannot be written.
    """
    prepare_directory(directory)
    try:
        stale = ["summary.json", *PLOTS] + ["surface.csv"] * (report.surface is None)
        for name in stale:
            (directory / name).unlink(missing_ok=True)
        with replacing(directory / "scene.resolved.toml") as (temporary,):
            write_resolved(scene, temporary)
        write_text(directory / "petsc.options", petsc_options.rstrip("\n") + "\n")
        write_fields(directory, report.fields, report.history[-1].time if report.history else 0.0)
        if report.surface is not None:
            write_surface(directory / "surface.csv", report.surface)
        if report.state is not None:
            text = (directory / "scene.resolved.toml").read_text(encoding="utf-8")
            write_checkpoint(directory / "checkpoint.h5", report.state, scene, text)
        write_history(directory / "history.csv", report.history)
        write_summary(directory / "summary.json", report.summary)
        if plots:
            from porolub.io.plots import plot_directory  # matplotlib takes a while to import

            plot_directory(directory)
    except OSError as error:
        reason = error.strerror or error
        raise SceneError(f"{directory}: the results cannot be written ({reason}).") from error
