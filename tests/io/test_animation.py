"""animation.gif shows a period: its frames, each for its time, on axes that stay as they are."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from porolub.cli import app
from porolub.errors import SceneError
from porolub.io import animation
from porolub.io.animation import animate, animate_directory, chosen, draw, pauses, write_gif
from porolub.io.directory import begin_run
from porolub.io.figure import new_figure
from porolub.io.frames import FrameWriter
from porolub.io.panels import CoursePanel, FieldPanel, Limits, SurfacePanel
from porolub.io.period import Span
from porolub.io.time_axis import Course
from porolub.scene import Scene, scene_from_dict
from porolub.solve.report import FrameData
from tests.io.conftest import scene_tables
from tests.io.made_up_runs import MadeUpFrames, case3, consolidation, write

SPEED = {"mean": "0 rad/s", "amplitude": "1 rad/s", "frequency": "1 Hz", "shape": "cosine"}
FRAMES = MadeUpFrames(np.arange(21) / 8, along=20, across=2)  # 2.5 periods, 8 frames each


@pytest.fixture(scope="module")
def scene() -> Scene:
    """Case 3 on a small mesh."""
    motion = {"kind": "rotation", "speed": SPEED}
    return scene_from_dict(scene_tables(motion=motion, time={"end": "5 s", "frames": 8}))


@pytest.fixture(scope="module")
def course(scene: Scene) -> Course:
    return Course.of(case3(2.5), scene)


@pytest.fixture(scope="module")
def limits() -> Limits:
    found = Limits()
    for k in range(8, 16):
        found.add(FRAMES.load(k))
    return found


class Without:
    """Frames of a scene that lacks something."""

    def __init__(self, **parts: None) -> None:
        self.times = FRAMES.times
        self._parts = parts

    def load(self, k: int) -> FrameData:
        frame = FRAMES.load(k)
        fields = replace(frame.fields, **{k: v for k, v in self._parts.items() if k != "surface"})
        surface = None if "surface" in self._parts else frame.surface
        return replace(frame, fields=fields, surface=surface)


def test_the_frames_of_the_last_full_period_are_shown(course: Course) -> None:
    assert course.span == Span(1.0, 2.0, 2)
    assert chosen(FRAMES.times, course) == list(range(8, 16))  # the end is the beginning again
    first = replace(course, span=Span(0.0, 1.0, 1))
    assert chosen(FRAMES.times * (1 + 1e-12), first) == list(range(8))
    whole = replace(course, span=Span(0.0, 2.5))
    assert chosen(FRAMES.times, whole) == list(range(21))


def test_many_frames_are_thinned(course: Course) -> None:
    numbers = chosen(np.linspace(0, 2.5, 1001), course)
    assert len(numbers) <= animation.MOST_FRAMES
    assert set(np.diff(numbers)) == {7}


def test_each_frame_lasts_as_long_as_it_stands_for(course: Course) -> None:
    times = np.array([1.0, 1.1, 1.2, 1.4, 1.5, 1.6, 1.7, 1.8, 1.85, 1.9, 1.95])
    lasting = pauses(times, course)
    np.testing.assert_allclose(lasting, 4.0 * np.diff(times, append=2.0).clip(0.01, 0.1))
    settling = Course.of(consolidation(), None)
    assert settling.logarithmic
    np.testing.assert_allclose(pauses(np.array([1e-3, 0.1, 1.0, 99.0]), settling), 0.4)


def test_the_gif_goes_on_for_ever(tmp_path: Path, course: Course, scene: Scene) -> None:
    path = tmp_path / "animation.gif"
    animate(path, FRAMES, course, scene, "test")
    with Image.open(path) as picture:
        assert picture.n_frames == 8
        assert picture.info["loop"] == 0
        assert picture.info["duration"] == 400
        assert picture.size == (900, 820)
        shown = []
        for k in range(8):
            picture.seek(k)
            shown.append(np.asarray(picture.convert("RGB"), dtype=int))
    assert all(np.abs(a - b).max() > 50 for a, b in pairwise(shown))
    assert (shown[0][0, 0] == 255).all()
    title_and_axes = [s[:, :70] for s in shown]  # nothing jumps: labels of the y axes
    assert all((part == title_and_axes[0]).mean() > 0.99 for part in title_and_axes)


def test_a_large_file_is_thinned(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    noise = np.random.default_rng(1).integers(0, 255, (16, 50, 50, 3), dtype=np.uint8)
    pictures = [Image.fromarray(values) for values in noise]
    path = tmp_path / "a.gif"
    write_gif(path, pictures, np.full(16, 0.1))
    whole = path.stat().st_size
    monkeypatch.setattr(animation, "LARGEST", 0.6 * whole)
    write_gif(path, pictures, np.full(16, 0.1))
    with Image.open(path) as picture:
        assert picture.n_frames == 8
        assert picture.info["duration"] == 200
    assert path.stat().st_size < 0.6 * whole


def test_the_field_keeps_its_colours_and_its_place(course: Course, limits: Limits) -> None:
    figure, (ax,) = new_figure("")
    panel = FieldPanel(figure, ax, FRAMES.load(8), limits, (115e-6, 117e-6), "body")
    seen = []
    for k in (8, 10):
        frame = FRAMES.load(k)
        panel.show(frame, 115e-6, np.cos(np.pi / 4 * k))
        (contours,) = (c for c in ax.collections if hasattr(c, "levels"))
        seen.append((tuple(contours.levels), ax.get_xlim(), ax.get_ylim()))
        levels = 1e-3 * frame.fields.pressure
        assert contours.levels[0] <= levels.min()
        assert contours.levels[-1] >= levels.max()
    assert seen[0] == seen[1]
    assert not np.isclose(contours.levels, 0.0).any()  # far away p is 0: no band may end there
    assert ax.get_ylabel() == "y [μm]"
    assert [line.get_ydata()[0] for line in ax.lines] == pytest.approx([115.0])


def test_the_picture_is_cropped_to_where_things_happen(limits: Limits) -> None:
    left, right, bottom, top = limits.box()
    contact = FRAMES.load(8).surface.x[FRAMES.load(8).surface.p_c > 0]
    assert -8.7e-3 < left < contact.min() - 5e-4
    assert contact.max() + 5e-4 < right < 8.7e-3
    assert bottom < 116e-6
    assert 1e-3 < top < 1.5e-3


def test_the_profiles_are_those_of_the_frame(limits: Limits) -> None:
    _, (ax,) = new_figure("")
    panel = SurfacePanel(ax, limits)
    film = next(other for other in ax.figure.axes if other is not ax)
    for k in (8, 11):
        surface = FRAMES.load(k).surface
        panel.show(surface)
        lines = {str(line.get_label()): line for line in (*ax.lines, *film.lines)}
        np.testing.assert_allclose(lines["fluid pressure p"].get_ydata(), 1e-3 * surface.p)
        np.testing.assert_allclose(lines["contact pressure $p_c$"].get_ydata(), 1e-3 * surface.p_c)
        shown = lines["film thickness h"].get_ydata()
        np.testing.assert_allclose(shown[surface.h > 0], 1e6 * surface.h[surface.h > 0])
        assert np.isnan(shown[surface.h == 0]).all()
        assert len(ax.patches) == 1  # one contact zone, not one per frame shown


def test_without_fluid_the_gap_is_no_film() -> None:
    surface = FRAMES.load(8).surface
    zero = 0 * surface.s
    dry = Limits()
    dry.add(replace(FRAMES.load(8), surface=replace(surface, p=zero, Q=zero, V=zero)))
    _, (ax,) = new_figure("")
    SurfacePanel(ax, dry)
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names == ["contact pressure $p_c$", "gap h"]


def test_the_marker_is_where_the_frame_is(course: Course) -> None:
    _, (ax,) = new_figure("")
    panel = CoursePanel(ax, course)
    panel.show(1.3)
    friction = next(other for other in ax.figure.axes if other is not ax)
    dots = [line for axes in (ax, friction) for line in axes.lines if line.get_marker() == "o"]
    at = {round(float(dot.get_xdata()[0]), 9) for dot in dots}
    assert at == {0.3}
    data = course.data
    expected = [1e-3 * np.interp(1.3, data["time"], data[key])
                for key in ("load_fluid", "load_solid")]  # fmt: skip
    expected.append(np.interp(1.3, data["time"], data["friction_coefficient"]))
    assert [float(dot.get_ydata()[0]) for dot in dots] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("lacks", "height"),
    [
        ({"surface": None}, 530),
        ({"pressure": None, "flux": None}, 820),
        ({}, 820),
    ],
)
def test_what_the_scene_lacks_has_no_panel(
    course: Course, scene: Scene, lacks: dict[str, None], height: int
) -> None:
    picture = next(draw(Without(**lacks), [8, 9], course, scene, "test"))
    assert picture.size == (900, height)


def test_without_loads_time_is_in_the_title_only(scene: Scene) -> None:
    bare = Course.of({"time": np.linspace(0, 1, 5)}, None)
    picture = next(draw(FRAMES, [0, 1], bare, None, "test"))
    assert picture.size == (900, 530)


def test_too_few_frames_are_refused(tmp_path: Path, course: Course, scene: Scene) -> None:
    few = MadeUpFrames(np.array([0.5, 1.5]), along=4, across=2)
    with pytest.raises(SceneError, match="from 1 to 2 s and the run kept 1; time.frames says how"):
        animate(tmp_path / "a.gif", few, course, scene, "test")


def test_bodies_are_for_paraview(tmp_path: Path, course: Course, scene: Scene) -> None:
    body = Without(cell_type="hex")  # type: ignore[arg-type]
    with pytest.raises(SceneError, match=r"open series\.xdmf in ParaView"):
        animate(tmp_path / "a.gif", body, course, scene, "test")


def run_directory(directory: Path, scene: Scene, frames: bool = True) -> Path:
    """What a transient run leaves on its way."""
    begin_run(directory, scene)
    write(directory / "history.csv", case3(2.5))
    if frames:
        writer = FrameWriter(directory)
        for k in range(len(FRAMES.times)):
            writer.write(FRAMES.load(k))
    return directory


def test_a_period_is_animated_from_the_command_line(tmp_path: Path, scene: Scene) -> None:
    run_directory(tmp_path, scene)
    done = CliRunner().invoke(app, ["plot", str(tmp_path), "--animate", "--period", "1"])
    assert done.exit_code == 0, done.output
    names = [Path(line).name for line in done.output.split()]
    assert names == ["loads.png", "flows.png", "friction.png", "lengths.png", "animation.gif"]
    with Image.open(tmp_path / "animation.gif") as picture:
        assert picture.n_frames == 8


def test_a_period_that_is_not_there_is_bad_input(tmp_path: Path, scene: Scene) -> None:
    run_directory(tmp_path, scene)
    done = CliRunner().invoke(app, ["plot", str(tmp_path), "--period", "3"])
    assert done.exit_code == 2
    assert "--period 3: the run has periods 1 to 2 of 1 s." in done.output
    assert CliRunner().invoke(app, ["plot", str(tmp_path), "--period", "0"]).exit_code == 2


def test_directories_that_cannot_be_animated_are_refused(tmp_path: Path, scene: Scene) -> None:
    with pytest.raises(SceneError, match="nowhere: there is no such directory"):
        animate_directory(tmp_path / "nowhere")
    with pytest.raises(SceneError, match="this is not the output of a transient run"):
        animate_directory(tmp_path)
    with pytest.raises(SceneError, match="there are no frames of a transient run here"):
        animate_directory(run_directory(tmp_path, scene, frames=False))
