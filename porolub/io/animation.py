"""animation.gif: pressure in the layer, profiles along its surface and loads, as time goes by."""

from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import shorten
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from porolub.errors import SceneError
from porolub.io.atomic import replacing
from porolub.io.directory import ANIMATION
from porolub.io.draw_fields import can_draw
from porolub.io.frames import read_frames
from porolub.io.map_panel import MapPanel
from porolub.io.panels import CoursePanel, FieldPanel, Limits, SurfacePanel
from porolub.io.plots import history_of, plane_height, read_scene
from porolub.io.section import Chart, middle
from porolub.io.time_axis import Course
from porolub.scene import Scene
from porolub.solve.report import Array, FrameData, SurfaceData, SurfaceMap

MOST_FRAMES = 60
LARGEST = 10_000_000
"""Bytes; of a larger file every second frame is left out."""

_LASTS = 4.0  # s, from beginning to end
_PAUSES = (0.04, 0.4)  # s, shortest and longest; the format counts in 0.01 s


class Frames(Protocol):
    """Frames of a run as porolub.io.frames reads them."""

    times: Array

    def load(self, k: int) -> FrameData:
        """Return frame k."""


def animate_directory(directory: Path, period: int | None = None) -> Path:
    """Write animation.gif of a period (from 1; the last full one if not given), return its path.

    Where nothing is periodic it shows the whole run. Raises SceneError where the directory is
    missing, damaged or not writable, has no pictures to show or not that period.
    """
    if not directory.is_dir():
        raise SceneError(f"{directory}: there is no such directory.")
    history = history_of(directory)
    if history is None:
        raise SceneError(f"{directory}: this is not the output of a transient run: there is "
                         "nothing to animate.")  # fmt: skip
    scene = read_scene(directory)
    title = scene.title if scene else directory.name
    path = directory / ANIMATION
    try:
        animate(path, read_frames(directory), Course.of(history, scene, period), scene, title)
    except OSError as error:
        reason = error.strerror or error
        raise SceneError(f"{path}: the animation cannot be written ({reason}).") from error
    return path


def animate(path: Path, frames: Frames, course: Course, scene: Scene | None, title: str) -> None:
    """Write the frames within the course's span as a GIF that goes on for ever.

    Raises SceneError where there are fewer than two frames or they are of a body without a
    lubricated surface, and OSError.
    """
    numbers = chosen(np.asarray(frames.times), course)
    if len(numbers) < 2:
        raise SceneError(
            f"an animation needs two pictures or more from {course.span.start:g} to "
            f"{course.span.end:g} s and the run kept {len(numbers)}; time.frames says how many."
        )
    first = frames.load(numbers[0])
    if not (can_draw(first.fields) or isinstance(first.surface, SurfaceMap)):
        raise SceneError(
            "an animation of a body shows its lubricated surface, and this scene has none; open "
            "series.xdmf in ParaView."
        )
    pictures = list(draw(frames, numbers, course, scene, title))
    write_gif(path, pictures, pauses(np.asarray(frames.times)[numbers], course))


def chosen(times: Array, course: Course) -> list[int]:
    """Return the frames within the span, MOST_FRAMES of them at most.

    The end of a period is left out: it is the beginning, where the picture starts again.
    """
    span = course.span
    rounding = 1e-6 * (span.end - span.start)
    end = span.end + (rounding if span.period is None else -rounding)
    found = np.flatnonzero((times >= span.start - rounding) & (times < end))
    stride = max(-(-len(found) // MOST_FRAMES), 1)
    return [int(k) for k in found[::stride]]


def draw(frames: Frames, numbers: list[int], course: Course, scene: Scene | None, title: str
         ) -> Iterator[Image.Image]:  # fmt: skip
    """Draw the frames of these numbers, one after the other."""
    surface = frames.load(numbers[0]).surface
    loads = course.has("load_solid", "load_fluid")
    count = 1 + (surface is not None) + loads
    figure = Figure(figsize=(9.0, 2.4 + 2.9 * (count - 1)), dpi=100, layout="constrained")
    canvas = FigureCanvasAgg(figure)
    axes = list(figure.subplots(count, 1, squeeze=False)[:, 0])
    setup = _layer if surface is None or isinstance(surface, SurfaceData) else _surface
    show = setup(figure, axes, frames, numbers, course, scene)
    marker = CoursePanel(axes[-1], course) if loads else None
    axes[0].set_title(shorten(title, 80, placeholder=" ..."), loc="left", fontsize=13,
                      parse_math=False)  # fmt: skip
    for k in numbers:
        frame = frames.load(k)
        show(frame)
        if marker is not None:
            marker.show(frame.time)
        axes[0].set_title(_now(course, frame.time), loc="right", fontsize=12)
        canvas.draw()
        figure.set_layout_engine("none")  # as laid out for the first frame: nothing may jump
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _layer(figure: Figure, axes: list[Axes], frames: Frames, numbers: list[int], course: Course,
           scene: Scene | None) -> Callable[[FrameData], None]:  # fmt: skip
    """Set up the panels of a two-dimensional layer; return what shows a frame in them."""
    limits = Limits()
    for k in numbers:
        limits.add(frames.load(k))

    def height(time: float) -> float | None:
        return plane_height(scene, _at(course, "approach", time))

    heights = [plane for k in numbers if (plane := height(frames.times[k])) is not None]
    reach = (min(heights), max(heights)) if heights else None
    first = frames.load(numbers[0])
    field = FieldPanel(figure, axes[0], first, limits, reach, "body" if course.rotates else "plane")
    profiles = SurfacePanel(axes[1], limits) if first.surface is not None else None

    def show(frame: FrameData) -> None:
        field.show(frame, height(frame.time), _motion(course, frame.time))
        if profiles is not None and isinstance(frame.surface, SurfaceData):
            profiles.show(frame.surface)

    return show


def _surface(figure: Figure, axes: list[Axes], frames: Frames, numbers: list[int], course: Course,
             scene: Scene | None) -> Callable[[FrameData], None]:  # fmt: skip
    """As ``_layer`` of a body: its surface from below, and the profiles along a line on it."""
    surfaces = [s for k in numbers if isinstance(s := frames.load(k).surface, SurfaceMap)]
    chart = Chart.of(surfaces[0])
    aside = middle(chart, scene)[0]
    limits = Limits()
    for surface in surfaces:
        limits.add_surface(chart.showing(surface).profile(aside=aside))
    panel = MapPanel(figure, axes[0], chart, surfaces, limits.stretch(), aside)
    profiles = SurfacePanel(axes[1], limits)

    def show(frame: FrameData) -> None:
        assert isinstance(frame.surface, SurfaceMap)
        panel.show(frame.surface)
        profiles.show(chart.showing(frame.surface).profile(aside=aside))

    return show


def pauses(times: Array, course: Course) -> Array:
    """Return how long each picture stays, s: as the time to the next one, _LASTS in all.

    Pictures of a run over log time, which tells decades alike, stay equally long.
    """
    gaps = np.diff(times, append=course.span.end)
    if course.span.period is None:
        gaps[-1] = gaps[:-1].mean()
    if course.logarithmic:
        gaps = np.ones(len(times))
    return np.clip(_LASTS * gaps / gaps.sum(), *_PAUSES)


def write_gif(path: Path, pictures: list[Image.Image], lasting: Array) -> None:
    """Write pictures (RGB), each ``lasting`` some s; one palette for all, so nothing flickers."""
    samples = pictures[:: max(len(pictures) // 4, 1)]
    width, height = samples[0].size
    sheet = Image.new("RGB", (width, height * len(samples)))
    for i, picture in enumerate(samples):
        sheet.paste(picture, (0, i * height))
    palette = sheet.quantize(256, method=Image.Quantize.MEDIANCUT)
    colours = np.array(palette.getpalette(), dtype=int).reshape(-1, 3)
    colours[colours.min(axis=1) > 240] = 255  # a white page, not nearly white
    palette.putpalette(colours.ravel().tolist())
    images = [p.quantize(palette=palette, dither=Image.Dither.NONE) for p in pictures]
    with replacing(path) as (temporary,):
        while True:
            images[0].save(temporary, format="GIF", save_all=True, append_images=images[1:],
                           duration=[10 * round(100 * t) for t in lasting], loop=0)  # fmt: skip
            if temporary.stat().st_size < LARGEST or len(images) < 8:
                return
            images = images[::2]
            lasting = np.add.reduceat(lasting, np.arange(0, len(lasting), 2))


def _at(course: Course, name: str, time: float) -> float | None:
    """Value of a column at a time in s; None where it has none."""
    value = float(np.interp(time, course.data["time"], course.column(name)))
    return value if np.isfinite(value) else None


def _motion(course: Course, time: float) -> float:
    """Speed at a time in s as a part of its largest over the span; 0 at rest."""
    largest = np.abs(np.nan_to_num(course.column("speed"))).max()
    return (_at(course, "speed", time) or 0.0) / largest if largest > 0 else 0.0


def _now(course: Course, time: float) -> str:
    """Time and speed for the title."""
    speed = _at(course, "speed", time)
    name, unit = ("Ω", "rad/s") if course.rotates else ("U", "m/s")
    known = "" if speed is None else f"{name} = {speed:+.2f} {unit}    "
    return f"{known}t = {time / course.unit.size:.3f} {course.unit.name}"
