"""The animation of a body: its surface and a cut through it, frame by frame on the same axes."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import TriMesh
from matplotlib.figure import Figure
from PIL import Image

from porolub.io.animation import animate, draw
from porolub.io.map_panel import MapPanel
from porolub.io.section import Chart
from porolub.io.time_axis import Course
from porolub.scene import Scene, scene_from_dict
from porolub.solve.report import FrameData
from tests.io.body import HALF_Z, body, body_surface
from tests.io.made_up_runs import case3
from tests.scene.scenes import changed
from tests.terms.case1 import BARREL

SPEED = {"mean": "0 rad/s", "amplitude": "1 rad/s", "frequency": "1 Hz", "shape": "cosine"}


class Bodies:
    """Frames of a body, four a period."""

    times = np.arange(9) / 4

    def load(self, k: int) -> FrameData:
        time = float(self.times[k])
        return FrameData(k, time, body(), body_surface(time))


@pytest.fixture(scope="module")
def scene() -> Scene:
    motion = {"kind": "rotation", "speed": SPEED}
    return scene_from_dict(changed(BARREL, motion=motion, time={"end": "5 s", "frames": 4}))


@pytest.fixture(scope="module")
def course(scene: Scene) -> Course:
    return Course.of(case3(2.5), scene)


def test_a_period_of_maps_is_animated(tmp_path: Path, course: Course, scene: Scene) -> None:
    animate(tmp_path / "a.gif", Bodies(), course, scene, "rolling")
    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.n_frames == 4
        assert picture.size == (900, 820)


def test_frames_differ_and_axes_stay(course: Course, scene: Scene) -> None:
    shown = [np.asarray(p, dtype=int) for p in draw(Bodies(), [4, 6], course, scene, "rolling")]
    assert np.abs(shown[0] - shown[1]).max() > 50
    np.testing.assert_array_equal(shown[0][:, :40], shown[1][:, :40])


def test_the_map_keeps_its_colours_and_follows_the_pressure() -> None:
    surfaces = [body_surface(0.0), body_surface(0.5)]
    figure = Figure()
    ax = figure.subplots()
    panel = MapPanel(figure, ax, Chart.of(surfaces[0]), surfaces, (-5e-3, 5e-3), 0.0)
    assert ax.get_xlim() == (-5.0, 5.0)
    assert ax.get_ylim()[1] > 1e3 * HALF_Z
    for surface in surfaces:
        panel.show(surface)
        (mesh,) = (c for c in ax.collections if isinstance(c, TriMesh))
        np.testing.assert_allclose(mesh.get_array(), 1e-3 * surface.p)
        assert mesh.norm.vmax == pytest.approx(1e-3 * max(s.p.max() for s in surfaces))
