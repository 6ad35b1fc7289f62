"""The [time] section: what it defaults to, what follows from it, and what it refuses."""

from typing import Any

import pytest

from porolub.errors import SceneError
from porolub.scene import Scene, scene_from_dict
from porolub.scene.transient import Time
from tests.scene.scenes import CUBE, ROLLING, changed

WAVE = {"mean": "1 kN/m", "amplitude": "0.5 kN/m", "frequency": "1 Hz"}
DEEP = WAVE | {"amplitude": "1.2 kN/m"}  # falls below zero at 3/4 of the period
RESTING: dict[str, Any] = {"motion": None, "pores": {"carry": False}}


def scene(**sections: Any) -> Scene:
    return scene_from_dict(changed(ROLLING, **({"time": {"end": "5 s"}} | sections)))


def time(**sections: Any) -> Time:
    found = scene(**sections).time
    assert found is not None
    return found


def refusal(**sections: Any) -> str:
    with pytest.raises(SceneError) as caught:
        scene(**sections)
    return str(caught.value)


def test_defaults_are_those_of_the_manual() -> None:
    plain = time()
    assert (plain.end, plain.tolerance, plain.order, plain.until) == (5.0, 1e-3, 2, "end")
    assert (plain.step_max, plain.first_step, plain.repeat_tolerance) == (None, None, None)
    assert plain.frames == 40
    assert plain.repeats_within == pytest.approx(1e-2)
    assert time(time={"end": "1 s", "repeat_tolerance": 0.3}).repeats_within == 0.3
    assert time(time={"end": "1 s", "frames": 0}).frames == 0


def test_what_moves_starts_from_the_steady_state_and_what_is_only_loaded_from_rest() -> None:
    assert (time().start, time().approach) == ("steady", None)
    resting = time(**RESTING)
    assert (resting.start, resting.approach) == ("rest", -1e-5)
    assert time(time={"end": "5 s", "start": "rest"}).approach == -1e-5
    assert time(**RESTING, film=None).approach == 0.0
    given = time(**RESTING, time={"end": "5 s", "approach": "3 um"})
    assert given.approach == 3e-6
    assert time(**RESTING, time={"end": "5 s", "start": "steady"}).approach is None


def test_a_plane_that_is_moved_or_absent_has_no_start_of_its_own() -> None:
    assert time(**RESTING, load={"force": None, "approach": "9 um"}).approach is None
    block = {
        "geometry": {"shape": "block", "width": "1 mm", "thickness": "10 mm"},
        "mesh": {"along": 1, "across": 20},
        "solid": ROLLING["solid"],
        "time": {"end": "1 s"},
    }
    consolidation = scene_from_dict(block).time
    assert consolidation is not None
    assert (consolidation.start, consolidation.approach) == ("rest", None)


def test_what_follows_is_written_out_in_the_resolved_scene() -> None:
    tables = scene(**RESTING).resolved()["time"]
    assert tables == {
        "end": "5.0 s",
        "tolerance": 1e-3,
        "order": 2,
        "start": "rest",
        "approach": "-1e-05 m",
        "until": "end",
        "frames": 40,
    }


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"end": None}, "time.end is missing: a time is needed"),
        ({"start": "moving"}, 'time.start = "moving": allowed are steady, rest'),
        ({"until": "never"}, 'time.until = "never": allowed are end, periodic'),
        ({"frames": -1}, "time.frames = -1: the value must be at least 0"),
        ({"frames": 4.0}, "time.frames = 4.0: a whole number is needed"),
        ({"repeat_tolerance": 0.0}, "time.repeat_tolerance = 0.0: the value must be greater"),
        ({"first_step": "0 s"}, 'time.first_step = "0 s": the value must be greater'),
        (
            {"first_step": "2 s", "step_max": "1 s"},
            "time.first_step = 2 s must not be greater than time.step_max = 1 s.",
        ),
        ({"first_step": "6 s"}, "time.first_step = 6 s must not be greater than time.end = 5 s."),
        ({"approach": "1 um"}, 'time.approach = 1 um needs time.start = "rest"'),
        ({"tolerence": 1e-3}, "did you mean time.tolerance?"),
    ],
)
def test_a_wrong_key_of_time_is_named(keys: dict[str, Any], sentence: str) -> None:
    text = refusal(time={"end": "5 s"} | keys)
    assert sentence in text
    assert "\n" not in text


def test_where_the_plane_starts_is_asked_only_of_a_plane_under_load() -> None:
    moved = {"load": {"force": None, "approach": "9 um"}}
    text = refusal(**RESTING, **moved, time={"end": "5 s", "approach": "1 um"})
    assert text.startswith("time.approach = 1 um needs load.force")


def test_a_load_below_zero_is_refused_with_the_time_it_falls_there() -> None:
    text = refusal(film=None, load={"force": DEEP})
    assert text.startswith("load.force falls to -200 N/m at t = 0.75 s; it must stay above 0")
    assert "\n" not in text


def test_a_falling_load_is_named_in_newtons_in_three_dimensions() -> None:
    cube = {"mean": "1 N", "amplitude": "3 N", "frequency": "1 Hz"}
    tables = changed(CUBE, load={"force": cube}, time={"end": "1 s", "start": "rest"})
    with pytest.raises(SceneError, match="falls to -2 N at t = 0.75 s"):
        scene_from_dict(tables)


def test_a_load_that_touches_zero_is_refused_too() -> None:
    ramp = {"times": ["0 s", "1 s", "2 s"], "values": ["1 kN/m", "0 kN/m", "1 kN/m"]}
    assert "falls to 0 N/m at t = 1 s" in refusal(film=None, load={"force": ramp})


def test_the_suction_of_a_film_can_hold_the_plane() -> None:
    assert scene(load={"force": DEEP}).load is not None


def test_a_steady_start_needs_a_load_that_presses() -> None:
    begins = DEEP | {"shape": "cosine", "phase": "180 deg"}
    text = refusal(load={"force": begins})
    assert text == (
        "load.force is -200 N/m at t = 0; a steady state needs a load above 0; "
        'or set time.start = "rest".'
    )
    assert scene(load={"force": begins}, time={"end": "5 s", "start": "rest"}).load
    steady = refusal(load={"force": begins}, time=None)
    assert steady == "load.force is -200 N/m at t = 0; a steady state needs a load above 0."


def test_a_steady_run_takes_the_load_at_the_start_whatever_follows() -> None:
    assert scene(film=None, load={"force": DEEP}, time=None).load is not None


def test_a_constant_load_presses_with_or_without_film() -> None:
    assert "greater than 0" in refusal(load={"force": "0 N/m"})


PERIODIC: dict[str, Any] = {"end": "2 s", "until": "periodic"}


def test_two_periods_are_enough_to_repeat() -> None:
    assert time(load={"force": WAVE}, time=PERIODIC).until == "periodic"


def test_fewer_than_two_periods_cannot_repeat() -> None:
    text = refusal(load={"force": WAVE}, time=PERIODIC | {"end": "1.9 s"})
    assert text == (
        'time.until = "periodic" needs at least two periods of 1 s, but time.end = 1.9 s.'
    )


def test_until_periodic_needs_something_that_repeats() -> None:
    assert "nothing changes here" in refusal(time=PERIODIC)
    ramp = {"times": ["0 s", "1 s"], "values": ["1 kN/m", "2 kN/m"]}
    text = refusal(load={"force": ramp}, time=PERIODIC)
    assert text == ('time.until = "periodic" needs a common period, but load.force never repeats.')


def test_until_periodic_needs_a_common_period() -> None:
    speed = {"mean": "1 rad/s", "amplitude": "1 rad/s", "frequency": "1.618033989 Hz"}
    text = refusal(load={"force": WAVE}, motion={"speed": speed}, time=PERIODIC)
    assert "there is none of load.force every 1 s, motion.speed every 618 ms" in text
