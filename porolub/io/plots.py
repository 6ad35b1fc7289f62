"""The figures of a run, drawn from its output directory alone."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from porolub.errors import SceneError
from porolub.io.atomic import reported
from porolub.io.directory import HISTORY, HISTORY_PLOTS, MAP_PLOTS, PLOTS, SUMMARY, SURFACE
from porolub.io.draw_fields import draw_field
from porolub.io.draw_history import draw_history
from porolub.io.draw_map import draw_maps
from porolub.io.draw_surface import draw_flows, draw_pressures
from porolub.io.fields import is_flat, read_fields
from porolub.io.figure import save
from porolub.io.history import read_history
from porolub.io.period import History
from porolub.io.summary import number, read_summary
from porolub.io.surface import read_surface
from porolub.io.surface_map import DATA as MAP
from porolub.io.surface_map import read_surface_map
from porolub.io.time_axis import Course
from porolub.scene import Scene, load_scene
from porolub.scene.geometry import Arc, Block


def plot_directory(directory: Path, period: int | None = None) -> list[Path]:
    """Draw what the run has data for and return the pictures' paths.

    von_mises.png, pressure.png, surface.png, flow.png: Figures 4, 5, 6a and 6b of the paper; of a
    body the latter two are maps, and profile_s.png and profile_z.png cut through them. loads.png,
    flows.png, friction.png, lengths.png: Figures 8a to 8d, over a period (from 1; the last full one
    if not given) or the whole run where nothing is periodic. A transient run that has not finished
    has the latter. Pictures there is no data for are taken away. Raises SceneError where the
    directory is missing, damaged or not the output of a run, or does not have that period, and
    SolveError where a picture cannot be written.
    """
    if not directory.is_dir():
        raise SceneError(f"{directory}: there is no such directory.")
    scene = read_scene(directory)
    title = scene.title if scene else directory.name
    history = history_of(directory)
    figures = {}
    if history is None or (directory / SUMMARY).exists():
        moment = "" if history is None else f", t = {history['time'][-1]:.6g} s"
        figures = _figures_at_the_end(directory, scene, title + moment)
    if history is not None:
        figures |= draw_history(Course.of(history, scene, period), title)
    elif period is not None:
        raise SceneError(f"--period: {directory} has no history of several steps to choose from.")
    with reported(directory, "the figures"):
        for name in (*PLOTS, *MAP_PLOTS, *HISTORY_PLOTS):
            if name not in figures:
                (directory / name).unlink(missing_ok=True)
        return [save(figure, directory / name) for name, figure in figures.items()]


def history_of(directory: Path) -> History | None:
    """Return the columns of history.csv; None where there are not two steps or more."""
    path = directory / HISTORY
    history = read_history(path) if path.exists() else {}
    return history if len(history.get("time", ())) > 1 else None


def _figures_at_the_end(directory: Path, scene: Scene | None, title: str) -> dict[str, Figure]:
    """The figures of the last state by file name."""
    summary = read_summary(directory / SUMMARY)
    if (directory / MAP).exists():
        return draw_maps(read_surface_map(directory), title, scene)
    if not is_flat(directory):  # bodies are looked at with ParaView
        return {}
    figures, fields = {}, read_fields(directory)
    plane = plane_height(scene, number(summary, "approach"))
    drawn = {"von_mises.png": ("von Mises stress", fields.von_mises)}
    if fields.pressure is not None:
        drawn["pressure.png"] = ("fluid pressure", fields.pressure)
    for name, (words, values) in drawn.items():
        if np.any(values):
            figures[name] = draw_field(fields, values, words, title, plane)
    if (directory / SURFACE).exists():
        surface = read_surface(directory / SURFACE)
        figures["surface.png"] = draw_pressures(surface, title)
        if surface.Q.any() or surface.V.any():
            figures["flow.png"] = draw_flows(surface, title)
    return figures


def read_scene(directory: Path) -> Scene | None:
    """Return the scene of a run; None where it cannot be read (a mesh file may be gone)."""
    try:
        return load_scene(directory / "scene.resolved.toml")
    except SceneError:
        return None


def plane_height(scene: Scene | None, approach: float | None) -> float | None:
    """Return the height of the rigid plane in m, where the shape says on which side it is."""
    if scene is None or approach is None:
        return None
    if isinstance(scene.geometry, Arc):
        return approach
    if isinstance(scene.geometry, Block):
        return scene.geometry.thickness - approach
    return None
