"""Where steps must end and how long they may be."""

import math

import numpy as np
import pytest

from porolub.scene import Scene, scene_from_dict
from porolub.scene.harmonic import Harmonic
from porolub.solve.lookback import Entry, derivative_weights
from porolub.solve.pacing import (
    RATE_ERROR,
    STEPS_OF_A_PERIOD,
    GivenRate,
    ease,
    given_rate,
    landing,
    longest,
    next_picture,
    stops,
)

UNIT = 0.25  # s


def scene(force: object, end: str = "1 s", **time: object) -> Scene:
    return scene_from_dict({
        "geometry": {"shape": "sector", "outer_radius": "100 mm", "thickness": "1 mm",
                     "half_angle": "5 deg"},
        "mesh": {"along": 8, "across": 2},
        "solid": {"law": "linear", "shear_modulus": "1 MPa", "bulk_modulus": "2 MPa"},
        "contact": {}, "load": {"force": force}, "time": {"end": end, **time}})


def samples(*times: str, repeat: bool = False) -> dict[str, object]:
    values = [f"{1 + k % 2} kN/m" for k in range(len(times))]
    if repeat:
        values[-1] = values[0]
    return {"times": list(times), "values": values, "repeat": repeat}


def harmonic(frequency: str) -> dict[str, str]:
    return {"mean": "1 kN/m", "amplitude": "0.5 kN/m", "frequency": frequency, "shape": "sine"}


def test_a_constant_scene_stops_at_its_end() -> None:
    assert stops(scene("1 kN/m"), UNIT) == [(4.0, False)]


def test_every_period_is_a_stop_and_the_last_one_is_the_end() -> None:
    found = stops(scene(harmonic("10 Hz"), "0.3 s"), 1.0)
    assert [t for t, _ in found] == [0.1, 0.2, 0.3]  # 3 * 0.1 is not 0.3
    assert not any(kink for _, kink in found)


def test_kinks_are_told_from_periods() -> None:
    force = samples("0 s", "0.2 s", "0.3 s", "0.5 s", repeat=True)
    found = stops(scene(force), 1.0)
    assert [t for t, _ in found] == pytest.approx([0.2, 0.3, 0.5, 0.7, 0.8, 1.0])
    kinks = [kink for _, kink in found]
    assert kinks[:5] == [True] * 5  # a kink at the end of a period stays one


def test_both_ends_of_a_jump_are_stops() -> None:
    found = stops(scene(samples("0 s", "0.1 s", "100.0000001 ms", "2 s")), 1.0)
    assert found == [(0.1, True), (0.1000000001, True), (1.0, False)]


def test_a_step_that_nearly_reaches_a_stop_leaves_no_crumb() -> None:
    assert landing(1.0, 0.9) == 0.9
    assert landing(1.0 - 1e-12, 1.0) == 1.0
    assert landing(0.9, 1.0) == 0.5
    assert landing(0.4, 1.0) == 0.4


def test_the_longest_step_sees_each_cycle() -> None:
    assert longest(scene("1 kN/m"), UNIT) == math.inf
    assert longest(scene("1 kN/m", step_max="0.1 s"), UNIT) == pytest.approx(0.4)
    assert longest(scene(harmonic("2 Hz")), UNIT) == pytest.approx(2.0 / STEPS_OF_A_PERIOD)
    assert longest(scene(harmonic("2 Hz"), step_max="1 ms"), UNIT) == pytest.approx(4e-3)


def test_easy_steps_grow_and_hard_ones_shrink_within_bounds() -> None:
    found = [ease(iterations) for iterations in (0, 1, 3, 4, 12)]
    assert found[0] == found[1] == 2.0
    assert sorted(found, reverse=True) == found
    assert found[2] > 1.0 > found[3]
    assert found[4] == 0.5


def test_pictures_are_due_by_the_clock() -> None:
    of_a_period, of_the_run = scene(harmonic("2 Hz"), frames=5), scene("1 kN/m", frames=5)
    for now, due in ((0.0, 0.1), (0.05, 0.1), (0.1 - 1e-16, 0.2), (0.1, 0.2), (0.31, 0.4)):
        assert next_picture(of_a_period, now) == pytest.approx(due)
        assert next_picture(of_the_run, 2 * now) == pytest.approx(2 * due)


class Looking:
    """A lookback on steps of one size, of order 2."""

    steps = 5

    def __init__(self, size: float) -> None:
        self.entries = [Entry(math.tau - n * size, np.empty(0), {}, 0.0, 2) for n in range(3)]

    def nodes(self, half: bool) -> list[Entry]:
        return self.entries[:2]

    def weights(self, t: float, half: bool) -> np.ndarray:
        return derivative_weights(np.array([t, *(e.time for e in self.nodes(half))]))


def wave() -> Harmonic:
    """An approach that turns with 1 rad/s and 1 m."""
    return Harmonic.model_construct(mean=0.0, amplitude=1.0, frequency=0.5 / math.pi)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_a_given_approach_is_differenced_well_enough(tolerance: float) -> None:
    """BDF2 with even steps is wrong by h^2/3 where all of the wave's third derivative is."""
    given = GivenRate(wave(), 1.0, 1.0, tolerance)
    allowed = math.sqrt(3.0 * RATE_ERROR * tolerance)
    assert given.limit(0.9 * allowed, Looking(0.9 * allowed)) == 0.9 * allowed
    assert 0.5 * allowed < given.limit(1.3 * allowed, Looking(allowed)) < 1.3 * allowed


def test_a_straight_approach_allows_any_step() -> None:
    table = scene_from_dict({
        "geometry": {"shape": "block", "width": "10 mm", "thickness": "1 mm"},
        "mesh": {"along": 8, "across": 1}, "film": {"viscosity": "1 Pa*s"}, "time": {"end": "1 s"},
        "load": {"approach": {"times": ["0 s", "10 s"], "values": ["-20 um", "-10 um"]}}})
    given = given_rate(table, UNIT)
    assert given is not None
    assert given.limit(0.3, Looking(0.01)) == 0.3
    assert given_rate(scene("1 kN/m"), UNIT) is None
