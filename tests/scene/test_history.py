"""Constants and harmonics: Eqs. 23 and 24 of the reference paper."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.scene import scene_from_dict, value_at
from porolub.scene.harmonic import Harmonic, harmonic
from porolub.scene.history import highest_of, kinks_of, lowest_of, period_of
from porolub.scene.units import Pressure
from tests.scene.scenes import CUBE, ROLLING, changed


def test_a_constant_stays() -> None:
    scene = scene_from_dict(ROLLING)
    assert scene.motion is not None
    assert scene.load is not None
    assert (scene.motion.at(0.0), scene.motion.at(7.3)) == (1.0, 1.0)
    assert (scene.load.at(0.0), scene.load.at(7.3)) == (1500.0, 1500.0)


@pytest.mark.parametrize("t", [0.0, 0.1, 0.25, 0.9, 3.3])
def test_the_paper_s_load_and_speed(t: float) -> None:
    load = {"mean": "1.5 kN/m", "amplitude": "750 N/m", "frequency": "1 Hz", "shape": "sine"}
    speed = {"mean": "0 rad/s", "amplitude": "1 rad/s", "frequency": "1 Hz", "shape": "cosine"}
    scene = scene_from_dict(changed(ROLLING, load={"force": load}, motion={"speed": speed}))
    assert scene.motion is not None
    assert scene.load is not None
    assert scene.load.at(t) == pytest.approx(1500 * (1 + math.sin(2 * math.pi * t) / 2))
    assert scene.motion.at(t) == pytest.approx(math.cos(2 * math.pi * t), abs=1e-12)


def test_approach_and_sliding_have_histories_too() -> None:
    wave = {"mean": "50 um", "amplitude": "10 um", "frequency": "2 Hz", "phase": "90 deg"}
    slide = {"mean": "0.1 m/s", "amplitude": "0.1 m/s", "frequency": "2 Hz"}
    tables = changed(CUBE, load={"force": None, "approach": wave})
    scene = scene_from_dict(tables | {"motion": {"kind": "sliding", "speed": slide}})
    assert scene.motion is not None
    assert scene.load is not None
    assert scene.load.at(0.0) == pytest.approx(6e-5)
    assert scene.motion.at(0.0) == pytest.approx(0.1)


@given(
    st.floats(-10, 10), st.floats(0.1, 10), st.floats(0, 100), st.sampled_from(["sine", "cosine"])
)
def test_a_harmonic_repeats_and_stays_within_its_amplitude(
    mean: float, frequency: float, t: float, shape: str
) -> None:
    value = harmonic(t, mean, 2.0, frequency, shape, 0.3)
    assert abs(value - mean) <= 2.0 + 1e-12
    assert harmonic(t + 1 / frequency, mean, 2.0, frequency, shape, 0.3) == pytest.approx(
        value, abs=1e-9
    )


@given(
    st.floats(-10, 10),
    st.floats(-10, 10).filter(lambda a: abs(a) > 0.01),
    st.floats(0.1, 10),
    st.floats(-720, 720),
    st.sampled_from(["sine", "cosine"]),
)
def test_a_harmonic_reaches_its_extremes_when_it_says(
    mean: float, amplitude: float, frequency: float, phase: float, shape: str
) -> None:
    wave: Harmonic[float] = Harmonic[Pressure].model_validate(
        {
            "mean": f"{mean!r} Pa",
            "amplitude": f"{amplitude!r} Pa",
            "frequency": f"{frequency!r} Hz",
            "phase": f"{phase!r} deg",
            "shape": shape,
        }
    )
    assert wave.period == pytest.approx(1 / frequency)
    assert wave.kinks(0.0, 100.0) == []
    for extreme, value in ((wave.lowest, -abs(amplitude)), (wave.highest, abs(amplitude))):
        assert extreme.value == pytest.approx(mean + value)
        assert wave.at(extreme.time) == pytest.approx(extreme.value)
        assert 0 <= extreme.time <= 1 / frequency


def test_a_harmonic_without_amplitude_is_a_constant() -> None:
    flat = Harmonic[Pressure].model_validate(
        {"mean": "3 Pa", "amplitude": "0 Pa", "frequency": "1 Hz"}
    )
    assert flat.period is None
    assert (flat.lowest.value, flat.highest.value, flat.at(0.3)) == (3.0, 3.0, 3.0)


def test_plain_numbers_answer_as_histories_do() -> None:
    assert value_at(3.0, 17.0) == 3.0
    assert period_of(3.0) is None
    assert kinks_of(3.0, 0.0, 9.0) == []
    assert lowest_of(3.0) == highest_of(3.0)
    assert lowest_of(3.0).value == 3.0
