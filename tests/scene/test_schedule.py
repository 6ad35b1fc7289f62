"""What changes with time, taken together: the common period and the times steps must end at."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.scene import Scene, scene_from_dict
from porolub.scene.schedule import common_period
from tests.scene.scenes import ROLLING, changed


def wave(unit: str, frequency: str) -> dict[str, str]:
    return {"mean": f"2 {unit}", "amplitude": f"1 {unit}", "frequency": frequency}


def corners(unit: str, *seconds: float, repeat: bool = False) -> dict[str, Any]:
    values = [f"{1 + k % 2} {unit}" for k in range(len(seconds))]
    return {"times": [f"{t!r} s" for t in seconds], "values": values, "repeat": repeat}


def scene(**sections: Any) -> Scene:
    return scene_from_dict(changed(ROLLING, time={"end": "9 s"}, **sections))


@pytest.mark.parametrize(
    ("periods", "common"),
    [
        ([], None),
        ([2.0], 2.0),
        ([1.0, 1.0], 1.0),
        ([1.0, 0.5, 0.25], 1.0),
        ([1.0, 1.5], 3.0),
        ([1 / 3, 1 / 7], 1.0),
        ([0.1, 6.0], 6.0),
        ([0.1, 6.1], None),  # 1 : 61
        ([1.0, math.sqrt(2)], None),
        ([1.0, math.inf], None),
        ([0.1, 0.3 * (1 + 1e-12)], 0.3),
        ([0.1, 0.3 * (1 + 1e-6)], None),
    ],
)
def test_periods_whose_ratio_is_a_fraction_have_a_common_one(
    periods: list[float], common: float | None
) -> None:
    assert common_period(periods) == (common if common is None else pytest.approx(common))


@given(
    st.floats(1e-3, 1e3),
    st.lists(st.tuples(st.integers(1, 7), st.integers(1, 7)), min_size=1, max_size=3),
)
def test_a_common_period_holds_whole_periods_of_all(
    base: float, ratios: list[tuple[int, int]]
) -> None:
    periods = [base * p / q for p, q in ratios]
    common = common_period(periods)
    if common is None:  # only where it would be too long
        turns = math.lcm(*(p * math.lcm(*(q for _, q in ratios)) // q for p, q in ratios))
        assert turns * base / math.lcm(*(q for _, q in ratios)) > 60 * min(periods) * (1 - 1e-9)
        return
    for period in periods:
        assert common / period == pytest.approx(round(common / period), rel=1e-8)
    assert common <= 60.001 * min(periods)


def test_a_scene_of_constants_does_not_vary() -> None:
    still = scene()
    assert not still.varies
    assert still.period is None
    assert still.kinks(0.0, 9.0) == []


def test_the_period_of_a_scene_is_common_to_load_motion_and_boundaries() -> None:
    load, speed = {"force": wave("kN/m", "1 Hz")}, {"speed": wave("rad/s", "0.5 Hz")}
    assert scene(load=load).period == 1.0
    assert scene(load=load, motion=speed).period == 2.0
    inlet = {"inlet": {"pressure": wave("kPa", "0.4 Hz")}}
    both = scene(load=load, motion=speed, boundary=inlet)
    assert both.period == pytest.approx(10.0)
    assert both.varies
    assert both.boundary["inlet"].varies


def test_what_never_repeats_leaves_a_scene_without_period_but_varying() -> None:
    ramp = scene(load={"force": corners("kN/m", 0.0, 1.0)}, motion={"speed": wave("rad/s", "1 Hz")})
    assert ramp.varies
    assert ramp.period is None


def test_every_boundary_value_counts() -> None:
    ends = corners("kPa", 1.0, 2.0)
    for inlet in (
        {"pressure": ends},
        {"traction": ends},
        {"traction": {"y": ends}},
        {"displacement": {"normal": corners("um", 1.0, 2.0)}},
        {"displacement": {"x": corners("um", 1.0, 2.0)}},
    ):
        changing = scene(boundary={"inlet": inlet})
        assert changing.varies
        assert changing.boundary["inlet"].varies
        assert changing.kinks(0.0, 9.0) == [1.0, 2.0]
    still = scene(boundary={"inlet": {"pressure": "1 kPa", "traction": {"x": "1 kPa"}}})
    assert not still.varies
    assert not still.boundary["inlet"].varies


def test_kinks_of_all_are_joined_in_order_and_counted_once() -> None:
    both = scene(
        load={"force": corners("kN/m", 0.0, 0.5, 3.0)},
        motion={"speed": corners("rad/s", 0.0, 0.4, 1.0, repeat=True) | {"values": V}},
    )
    assert both.kinks(0.0, 3.5) == pytest.approx([0.4, 0.5, 1.0, 1.4, 2.0, 2.4, 3.0, 3.4])
    assert both.kinks(0.4, 1.4) == pytest.approx([0.5, 1.0])


V = ["1 rad/s", "2 rad/s", "1 rad/s"]


def test_kinks_that_differ_by_rounding_are_one_and_none_is_left_at_the_ends() -> None:
    third = 0.1 * 3  # not 0.3
    assert third != 0.3
    both = scene(
        load={"force": corners("kN/m", 0.3, 0.7)}, motion={"speed": corners("rad/s", third, 0.7)}
    )
    assert both.kinks(0.0, 9.0) == [0.3, 0.7]
    assert both.kinks(0.3, 9.0) == [0.7]
    assert both.kinks(0.0, third) == []
