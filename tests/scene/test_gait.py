"""The gait cycle: its printed points, a continuous slope, and constant in swing."""

import itertools
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.errors import SceneError
from porolub.scene import load_scene, scene_from_dict
from porolub.scene.gait import Gait
from tests.scene.scenes import CUBE, ROLLING, changed

WALK: dict[str, Any] = {"profile": "gait", "scale": "0.3 kN/m", "frequency": "1 Hz"}


def gait(**keys: Any) -> Gait:
    return Gait.model_validate(WALK | keys)


@pytest.mark.parametrize(
    ("phase", "kilonewton"),
    [(0, 0.3), (0.12, 3.0), (0.32, 1.5), (0.5, 3.0), (0.6, 0.3), (0.62, 0.3), (0.8, 0.3), (1, 0.3)],
)
def test_it_runs_through_the_points_of_the_hip_simulator_standard(
    phase: float, kilonewton: float
) -> None:
    assert gait().at(phase) == pytest.approx(1e3 * kilonewton)
    assert gait(frequency="2 Hz").at(3 + phase / 2) == pytest.approx(1e3 * kilonewton)


def test_it_rises_from_heel_strike_on_and_falls_until_toe_off() -> None:
    load = gait()
    assert load.at(0.001) > load.at(0.0)
    assert load.at(0.599) > load.at(0.6)


def test_peak_and_trough_are_multiples_of_the_load_in_swing() -> None:
    steep = gait(peak=4, trough=0.5)
    values = [steep.at(t) for t in (0.0, 0.12, 0.32, 0.5, 0.7)]
    assert values == pytest.approx([300, 1200, 150, 1200, 300])
    assert (steep.lowest.value, steep.lowest.time) == (150, 0.32)
    assert (steep.highest.value, steep.highest.time) == (1200, 0.12)
    assert steep.period == 1.0
    assert steep.kinks(0.0, 5.0) == []


@pytest.mark.parametrize(("peak", "trough"), [(10, 5.0), (5.5, 3.0), (1.9, 1.4)])
def test_the_trough_keeps_the_standard_s_proportion(peak: float, trough: float) -> None:
    """Of the rise of the peaks above the load in swing the trough keeps (1.5 - 0.3)/(3 - 0.3)."""
    assert gait(peak=peak).trough == pytest.approx(trough)


@given(st.floats(1.1, 20), st.floats(0.05, 0.95), st.floats(0.2, 5))
def test_it_rises_and_falls_only_between_its_points(
    peak: float, share: float, frequency: float
) -> None:
    """Two rises and two falls a cycle, none elsewhere."""
    trough = peak * share
    load = gait(peak=peak, trough=trough, frequency=f"{frequency!r} Hz")
    signs = []
    for begin, end in itertools.pairwise((0.0, 0.12, 0.32, 0.5, 0.6, 1.0)):
        times = [(begin + (end - begin) * k / 20) / frequency for k in range(1, 20)]
        steps = [load.at(b) - load.at(a) for a, b in itertools.pairwise(times)]
        assert min(steps) >= 0 or max(steps) <= 0
        signs.append((steps[9] > 0) - (steps[9] < 0))
    assert signs == [1, -1, 1, -1, 0]


def test_its_slope_is_continuous_all_round_the_cycle() -> None:
    load, d = gait(), 1e-5
    slopes = [(load.at(k * d + d) - load.at(k * d)) / d for k in range(120_000)]
    steepest = max(abs(s) for s in slopes)
    assert max(abs(b - a) for a, b in itertools.pairwise(slopes)) < 1e-3 * steepest


def test_the_paper_s_case_5_is_a_gait_of_a_third_of_a_kilonewton() -> None:
    scene = load_scene(Path(__file__).parents[2] / "jobs" / "case5.toml")
    assert scene.load is not None
    assert scene.load.force == gait()
    assert scene.period == 1.0


def test_it_is_a_load_in_both_dimensions() -> None:
    load = scene_from_dict(changed(CUBE, load={"force": WALK | {"scale": "300 N"}})).load
    assert load is not None
    assert load.at(0.12) == pytest.approx(3000.0)


@pytest.mark.parametrize(
    ("sections", "sentence"),
    [
        ({"load": {"force": WALK | {"profile": "run"}}}, 'load.force.profile = "run": allowed are'),
        ({"load": {"force": WALK | {"scale": "0 N/m"}}}, "load.force.scale = "),
        ({"load": {"force": WALK | {"peak": 1}}}, "load.force.peak = 1: the value must be greater"),
        ({"load": {"force": WALK | {"peak": "3 N"}}}, "load.force.peak = "),
        (
            {"load": {"force": WALK | {"peak": 3, "trough": 3}}},
            "load.force.trough = 3 must be less than load.force.peak = 3.",
        ),
        ({"load": {"force": WALK | {"trouhg": 3}}}, "did you mean load.force.trough?"),
        (
            {"load": {"force": {k: v for k, v in WALK.items() if k != "profile"}}},
            "load.force.profile is missing: allowed are gait",
        ),
        (
            {"motion": {"speed": WALK | {"scale": "1 rad/s"}}},
            'motion.speed.profile = "gait": named profiles are loads',
        ),
    ],
)
def test_what_it_cannot_be_is_refused(sections: dict[str, Any], sentence: str) -> None:
    with pytest.raises(SceneError) as caught:
        scene_from_dict(changed(ROLLING, **sections))
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)
