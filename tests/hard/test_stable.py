"""The checks see what they are there for."""

import numpy as np
import pytest

from tests.hard import stable


@pytest.fixture(scope="module")
def outcome():
    return stable.solve(stable.scene_of("sliding", 1.0, 1.5, False, 30, 3))


def test_a_good_state_passes(outcome) -> None:
    stable.assert_stable(outcome)


def test_a_state_off_the_steady_one_does_not(outcome) -> None:
    outcome.x.scale(1.0 + 1e-6)
    with pytest.raises(AssertionError):
        stable.assert_steady(outcome)
    outcome.x.scale(1.0 / (1.0 + 1e-6))


def test_a_sawtooth_is_seen_and_a_sharp_peak_is_none() -> None:
    s = np.linspace(-1, 1, 81)
    smooth = np.exp(-20 * s**2) - 0.2 * np.exp(-200 * (s - 0.5) ** 2)
    smooth -= smooth[0]
    peak = smooth.copy()
    peak[60] -= 0.3
    stable.assert_smooth(peak)
    assert stable.sawtooth(peak) == 0.0
    zigzag = smooth + 0.03 * (-1.0) ** np.arange(81) * (np.abs(s - 0.5) < 0.06)
    with pytest.raises(AssertionError):
        stable.assert_smooth(zigzag)


def test_waves_longer_than_two_elements_count_as_variation() -> None:
    s = np.linspace(0, np.pi, 81)
    waves = np.sin(s) + 0.1 * np.sin(20 * s) * np.sin(s)
    assert stable.sawtooth(waves) == 0.0
    with pytest.raises(AssertionError):
        stable.assert_smooth(waves)
