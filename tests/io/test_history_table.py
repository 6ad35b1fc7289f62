"""What a transient run comes to, in the units of the trade."""

import io
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from porolub.io.history_table import history_table, print_history_table
from porolub.scene import Scene, scene_from_dict
from tests.io.conftest import scene_tables
from tests.io.made_up_runs import LOAD, case3, consolidation
from tests.io.test_table import cells

SPEED = {"mean": "0 rad/s", "amplitude": "1 rad/s", "frequency": "1 Hz", "shape": "cosine"}


@pytest.fixture
def case3_scene() -> Scene:
    return scene_from_dict(
        scene_tables(motion={"kind": "rotation", "speed": SPEED}, time={"end": "5 s"})
    )


def printed(history: dict[str, Any], scene: Scene, width: int = 80) -> str:
    stream = io.StringIO()
    print_history_table(Console(file=stream, width=width), history, scene)
    return stream.getvalue()


def test_the_last_period_counts(case3_scene: Scene) -> None:
    history = case3()
    table = history_table(history, case3_scene)
    assert str(table.title) == "Over period 5, 4.00 s to 5.00 s"
    rows = cells(table)
    last = history["time"] >= 4.0
    mu = history["friction_coefficient"][last]
    assert rows["friction coefficient"] == [
        "",
        f"{mu[-1]:.4f}",
        f"{mu.min():.4f}",
        "0.1870",
        f"{mu.max():.4f}",
    ]
    assert rows["load by the solid"][:2] == ["kN/m", f"{1e-3 * history['load_solid'][-1]:.4f}"]
    assert rows["total load"][1:] == 4 * ["1.500"]
    share = 100 * history["load_fluid"] / LOAD
    assert rows["fluid share"] == [
        "%", f"{share[-1]:.2f}", f"{share[last].min():.2f}", "58.45", f"{share[last].max():.2f}"
    ]  # fmt: skip
    assert rows["thinnest film"] == ["um", "0", "0", "0", "0"]
    assert rows["inflow, left"][0] == "(g/m)/s"
    for absent in ("lowest fluid pressure", "peak contact pressure"):
        assert absent not in rows


def test_means_are_over_time_not_over_steps(case3_scene: Scene) -> None:
    history = {
        "time": np.array([0.0, 0.9, 0.92, 0.94, 0.96, 0.98, 1.0]),
        "friction_coefficient": np.array([0.1, 0.1, 0.3, 0.3, 0.3, 0.3, 0.3]),
    }
    rows = cells(history_table(history, case3_scene))
    assert float(rows["friction coefficient"][3]) == pytest.approx(0.09 + 0.004 + 0.024, abs=1e-4)


def test_steps_and_periods_are_told(case3_scene: Scene) -> None:
    text = printed(case3(), case3_scene)
    assert "1,000 steps accepted, 20 rejected (2.0 %)" in text
    assert "3.25 Newton iterations a step, steps of 2.50 ms to 7.50 ms" in text
    assert "5 full periods of 1.000 s" in text
    assert "%: it repeats (to 1 %)" in text
    assert "…" not in text


def test_a_run_that_does_not_repeat_yet_says_so(case3_scene: Scene) -> None:
    history = case3()
    drift = 1 + 0.1 * history["time"] / 5
    text = printed(history | {"approach": history["approach"] * drift}, case3_scene)
    assert "the last period differs from the one before by 1.8 %: it does not repeat yet" in text
    wild = history | {"approach": np.where(history["time"] < 4.0, -1.0, 1.0)}
    assert "by 200 %: it does not repeat yet (to 1 %)" in printed(wild, case3_scene)


def test_the_start_is_no_step(case3_scene: Scene) -> None:
    """Its row tells the iterations of the steady start."""
    history = {
        "time": np.array([0.0, 0.1, 0.2]),
        "time_step": np.array([0.0, 0.1, 0.1]),
        "newton_iterations": np.array([40.0, 2.0, 3.0]),
        "rejected_steps": np.array([0.0, 1.0, 0.0]),
    }
    text = printed(history, case3_scene)
    assert "2 steps accepted, 1 rejected (33.3 %)" in text
    assert "2.50 Newton iterations a step" in text
    assert "0 full periods" in text
    assert "differs" not in text


def test_a_run_in_which_nothing_is_periodic_counts_as_a_whole(scene: Scene) -> None:
    text = printed(consolidation(), scene)
    assert text.startswith("Over the whole run, 100 us to 100 s")
    assert "full periods" not in text


def test_a_run_that_failed_at_once_has_its_start(case3_scene: Scene) -> None:
    history = {name: values[:1] for name, values in case3().items()}
    text = printed(history, case3_scene)
    assert text.startswith("Over the whole run, 0 s to 0 s")
    assert "0 full periods" in text
    assert "steps accepted" not in text


def test_rounding_is_shown_as_zero(scene: Scene) -> None:
    history = {"time": np.array([0.0, 1.0]), "inflow_left": np.array([1e-3, 1e-16])}
    assert cells(history_table(history, scene))["inflow, left"][1:3] == ["0", "0"]


def test_missing_numbers_are_left_out(scene: Scene) -> None:
    nothing = {"time": np.array([0.0, 1.0]), "load_ratio": np.full(2, np.nan)}
    assert history_table(nothing, scene).row_count == 0
    gone = {"time": np.array([0.0, 1.0]), "contact_length": np.array([1e-3, np.nan])}
    assert cells(history_table(gone, scene))["contact length"] == [
        "mm", "-", "1.000", "1.000", "1.000"
    ]  # fmt: skip


def test_it_fits_into_80_columns(scene: Scene) -> None:
    """Also with the longest names and numbers."""
    names = ("outflow_right", "pressure_min", "contact_pressure_max", "friction_coefficient")
    wild = np.array([-1.234e-7, -9.876e-6, -5.4321e-6])
    history = {"time": np.arange(3.0)} | dict.fromkeys(names, wild)
    lines = printed(history, scene).splitlines()
    assert "-1.234e-10" in "".join(lines)
    assert "…" not in "".join(lines)
    assert max(map(len, lines)) <= 80
