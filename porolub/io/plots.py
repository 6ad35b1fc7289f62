"""The figures of a finished run, drawn from its output directory alone."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from porolub.errors import SceneError
from porolub.io.directory import PLOTS
from porolub.io.draw_fields import can_draw, draw_field
from porolub.io.draw_surface import draw_flows, draw_pressures
from porolub.io.fields import read_fields
from porolub.io.figure import save
from porolub.io.summary import number, read_summary
from porolub.io.surface import read_surface
from porolub.scene import Scene, load_scene
from porolub.scene.geometry import Arc, Block


def plot_directory(directory: Path) -> list[Path]:
    """Draw what the run has data for and return the pictures' paths.

    von_mises.png, pressure.png (two dimensions), surface.png, flow.png: Figures 4, 5, 6a and 6b
    of the paper. Pictures there is no data for are taken away. Raises SceneError where the
    directory is missing, damaged, not writable or not the output of a finished run.
    """
    if not directory.is_dir():
        raise SceneError(f"{directory}: there is no such directory.")
    figures = _figures(directory)
    try:
        for name in PLOTS:
            if name not in figures:
                (directory / name).unlink(missing_ok=True)
        return [save(figure, directory / name) for name, figure in figures.items()]
    except OSError as error:
        reason = error.strerror or error
        raise SceneError(f"{directory}: the figures cannot be written ({reason}).") from error


def _figures(directory: Path) -> dict[str, Figure]:
    """The figures by file name."""
    summary, fields = read_summary(directory / "summary.json"), read_fields(directory)
    scene = _scene(directory)
    title = scene.title if scene else directory.name
    plane = _plane(scene, number(summary, "approach"))
    figures = {}
    if can_draw(fields):
        drawn = {"von_mises.png": ("von Mises stress", fields.von_mises)}
        if fields.pressure is not None:
            drawn["pressure.png"] = ("fluid pressure", fields.pressure)
        for name, (words, values) in drawn.items():
            if np.any(values):
                figures[name] = draw_field(fields, values, words, title, plane)
    if (directory / "surface.csv").exists():
        surface = read_surface(directory / "surface.csv")
        figures["surface.png"] = draw_pressures(surface, title)
        if surface.Q.any() or surface.V.any():
            figures["flow.png"] = draw_flows(surface, title)
    return figures


def _scene(directory: Path) -> Scene | None:
    """The scene of the run; None where it cannot be read any more (a mesh file may be gone)."""
    try:
        return load_scene(directory / "scene.resolved.toml")
    except SceneError:
        return None


def _plane(scene: Scene | None, approach: float | None) -> float | None:
    """Height of the rigid plane in m, where the shape says on which side it is."""
    if scene is None or approach is None:
        return None
    if isinstance(scene.geometry, Arc):
        return approach
    if isinstance(scene.geometry, Block):
        return scene.geometry.thickness - approach
    return None
