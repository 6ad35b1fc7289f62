"""Figures 8a to 8d show the history's numbers over the period that was asked for."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.image import imread

from porolub.errors import SceneError
from porolub.io import plots
from porolub.io.directory import HISTORY_PLOTS, PLOTS, begin_run, write_results
from porolub.io.draw_history import draw_history
from porolub.io.plots import plot_directory
from porolub.io.time_axis import REVERSED, Course
from porolub.scene import Scene, scene_from_dict
from porolub.solve.report import Report
from tests.io.conftest import scene_tables
from tests.io.made_up_runs import case3, case4, consolidation, write

SPEED = {"mean": "0 rad/s", "amplitude": "1 rad/s", "frequency": "1 Hz", "shape": "cosine"}
LOAD = {"mean": "1.5 kN/m", "amplitude": "0.75 kN/m", "frequency": "1 Hz"}


@pytest.fixture
def moving() -> Scene:
    """Case 3."""
    motion = {"kind": "rotation", "speed": SPEED}
    title = {"title": "Case 3: constant load, oscillating rotation"}
    return scene_from_dict(scene_tables(scene=title, motion=motion, time={"end": "5 s"}))


def figures(history: dict[str, np.ndarray], scene: Scene | None, number: int | None = None
            ) -> dict[str, Figure]:  # fmt: skip
    return draw_history(Course.of(history, scene, number), "test")


def curves(*axes: Axes) -> dict[str, np.ndarray]:
    """Points (n, 2) of the curves with a name."""
    lines = [line for ax in axes for line in ax.lines]
    return {str(line.get_label()): line.get_xydata() for line in lines
            if not str(line.get_label()).startswith("_")}  # fmt: skip


def shaded(ax: Axes) -> list[tuple[float, float]]:
    """From where to where the background tells of reversal."""
    found = [p for p in ax.patches if p.get_facecolor()[:3] == to_rgb(REVERSED)]
    boxes = [p.get_patch_transform().transform(p.get_path().vertices) for p in found]
    return [(float(b[:, 0].min()), float(b[:, 0].max())) for b in boxes]


def test_loads_of_the_last_period(moving: Scene) -> None:
    history = case3()
    figure = figures(history, moving)["loads.png"]
    ax, strip = figure.axes
    found = curves(ax)
    last = history["time"] > 4.0
    for name, key in (("total L", "load_total"), ("fluid $L_f$", "load_fluid"),
                      ("solid $L_s$", "load_solid")):  # fmt: skip
        np.testing.assert_allclose(found[name][1:, 0], history["time"][last] - 4.0)
        np.testing.assert_allclose(found[name][1:, 1], 1e-3 * history[key][last])
    assert ax.get_ylabel() == "load [kN/m]"
    assert strip.get_xlabel() == "time in period 5 (from t = 4 s) [s]"
    assert strip.get_xlim() == (0.0, 1.0)
    assert strip.get_ylabel() == "Ω [rad/s]"
    assert ax.get_title(loc="left") == "Load shares (test)"


def test_another_period_on_request(moving: Scene) -> None:
    figure = figures(case3(), moving, 2)["loads.png"]
    assert figure.axes[-1].get_xlabel() == "time in period 2 (from t = 1 s) [s]"
    with pytest.raises(SceneError, match=r"--period 6: the run has periods 1 to 5 of 1 s\."):
        figures(case3(), moving, 6)


def test_reversal_is_shaded_in_figure_and_strip(moving: Scene) -> None:
    for figure in figures(case3(), moving).values():
        for ax in figure.axes[:2]:
            ((start, end),) = shaded(ax)
            assert (start, end) == pytest.approx((0.25, 0.75), abs=1e-4)
        assert "clockwise" in [t.get_text() for t in figure.axes[0].get_legend().get_texts()]


def test_a_period_that_begins_and_ends_reversed_is_shaded_at_both_ends(moving: Scene) -> None:
    history = case3()
    history["speed"] = -history["speed"]
    ax = figures(history, moving)["loads.png"].axes[0]
    assert np.ravel(sorted(shaded(ax))) == pytest.approx([0, 0.25, 0.75, 1], abs=1e-4)


def test_flows_by_side_and_direction(moving: Scene) -> None:
    history = case3()
    ax = figures(history, moving)["flows.png"].axes[0]
    found = curves(ax)
    last = history["time"] > 4.0
    for way in ("in", "out"):
        for side in ("left", "right"):
            (name,) = (n for n in found if n.startswith(f"{way}, {side}"))
            values = 1e3 * history[f"{way}flow_{side}"][last]
            np.testing.assert_allclose(found[name][1:, 1], values)
    assert ax.get_ylabel() == "mass flow [(g/m)/s]"
    assert ax.get_yscale() == "linear"


def test_two_equal_curves_are_both_seen() -> None:
    ax = figures(consolidation(), None)["flows.png"].axes[0]
    widths = {str(line.get_label())[:9]: line.get_linewidth() for line in ax.lines}
    assert widths["out, left"] > 2 * widths["out, righ"]


def test_friction_and_ratio_have_an_axis_each(moving: Scene) -> None:
    history = case3()
    figure = figures(history, moving)["friction.png"]
    ax, _, right = figure.axes
    last = history["time"] > 4.0
    friction = curves(ax)["friction coefficient μ"]
    np.testing.assert_allclose(friction[1:, 1], history["friction_coefficient"][last])
    ratio = curves(right)["load ratio $L_f/L_s$"]
    np.testing.assert_allclose(ratio[1:, 1], history["load_ratio"][last])
    assert right.get_yscale() == "linear"


def test_a_ratio_that_shoots_up_does_not_flatten_the_rest() -> None:
    ratio = figures(consolidation(), None)["friction.png"].axes[-1]
    assert ratio.get_yscale() == "asinh"


def test_lengths_and_what_drives_them() -> None:
    both = scene_from_dict(scene_tables(motion={"kind": "rotation", "speed": SPEED},
                                        load={"force": LOAD}, time={"end": "5 s"}))  # fmt: skip
    history = case4()
    ax, strip, load = figures(history, both)["lengths.png"].axes
    last = history["time"] > 4.0
    found = curves(ax)
    for name, key in (("contact length b", "contact_length"),
                      ("penetration length $b_0$", "penetration_length")):  # fmt: skip
        np.testing.assert_allclose(found[name][1:, 1], 1e3 * history[key][last])
    np.testing.assert_allclose(load.lines[0].get_ydata()[1:], 1e-3 * history["load_applied"][last])
    assert (strip.get_ylabel(), load.get_ylabel()) == ("Ω [rad/s]", "L [kN/m]")
    assert len(figures(history, both)["loads.png"].axes) == 2  # the load is above already


def test_under_constant_load_and_speed_there_is_no_strip() -> None:
    assert len(figures(consolidation(), None)["lengths.png"].axes) == 1


def test_settling_from_rest_is_told_over_decades() -> None:
    history = consolidation()
    ax = figures(history, None)["loads.png"].axes[0]
    assert ax.get_xscale() == "log"
    assert ax.get_xlim() == pytest.approx((1e-4, 100.0))
    assert ax.get_xlabel() == "time [s]"
    flows = figures(history, None)["flows.png"].axes[0]
    assert flows.get_yscale() == "log"


@pytest.mark.parametrize("key", ["speed", "load_applied"])
def test_what_is_driven_is_told_over_plain_time(key: str) -> None:
    history = consolidation()
    ramp = {key: np.linspace(1.0, 2.0, len(history["time"]))}
    ax = figures(history | ramp, None)["loads.png"].axes[0]
    assert ax.get_xscale() == "linear"


def test_a_sliding_plane_has_a_speed_in_metres_per_second() -> None:
    speed = {"mean": "0 m/s", "amplitude": "0.1 m/s", "frequency": "1 Hz", "shape": "cosine"}
    pores = {"biot": 0.9, "permeability": "1 um^3/mm", "viscosity": "1 mPa*s", "carry": False}
    motion = {"kind": "sliding", "speed": speed}
    sliding = scene_from_dict(scene_tables(motion=motion, pores=pores, time={"end": "5 s"}))
    figure = figures(case3(), sliding)["loads.png"]
    assert figure.axes[1].get_ylabel() == "U [m/s]"
    names = [t.get_text() for t in figure.axes[0].get_legend().get_texts()]
    assert "speed negative" in names


def test_a_short_run_is_in_milliseconds() -> None:
    history = consolidation()
    history["time"] = np.linspace(0.0, 0.02, len(history["time"]))
    figure = figures(history, None)["loads.png"]
    assert figure.axes[0].get_xlabel() == "time [ms]"
    assert figure.axes[0].get_xlim() == (0.0, 20.0)


def test_only_what_there_is_is_drawn() -> None:
    time = np.linspace(0, 1, 5)
    assert figures({"time": time, "load_solid": 0 * time}, None) == {}
    dry = {"time": time, "load_solid": 1 + time, "load_total": 1 + time, "inflow_left": 0 * time,
           "load_ratio": np.full(5, np.nan)}  # fmt: skip
    assert list(figures(dry, None)) == ["loads.png"]


def test_a_finished_run_has_all_pictures(tmp_path: Path, report: Report, moving: Scene) -> None:
    begin_run(tmp_path, moving)
    write(tmp_path / "history.csv", case3())
    write_results(tmp_path, report, moving, history_written=True)
    for name in (*PLOTS, *HISTORY_PLOTS):
        assert imread(tmp_path / name).shape[:2] == (700, 1200)


def test_pictures_of_the_last_state_tell_its_time(
    tmp_path: Path, report: Report, moving: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    titles = {}
    monkeypatch.setattr(plots, "save", lambda figure, path: titles.update(
        {path.name: figure.axes[0].get_title(loc="left")}))  # fmt: skip
    begin_run(tmp_path, moving)
    write(tmp_path / "history.csv", case3())
    write_results(tmp_path, report, moving, history_written=True)
    at_the_end = {name for name, title in titles.items() if title.endswith(", t = 5 s)")}
    assert at_the_end == set(PLOTS)


def test_a_run_under_way_has_its_history(tmp_path: Path, moving: Scene) -> None:
    begin_run(tmp_path, moving)
    write(tmp_path / "history.csv", case3(2.4))
    (tmp_path / "pressure.png").write_text("of an earlier run")
    assert [path.name for path in plot_directory(tmp_path, 2)] == list(HISTORY_PLOTS)
    assert not (tmp_path / "pressure.png").exists()


def test_a_steady_run_has_no_period(tmp_path: Path, report: Report, scene: Scene) -> None:
    write_results(tmp_path, report, scene, plots=False)
    with pytest.raises(SceneError, match="has no history of several steps to choose from"):
        plot_directory(tmp_path, 1)
