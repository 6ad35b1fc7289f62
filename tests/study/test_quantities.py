"""Names of quantities, their values in a summary, and those that are shown unless told."""

from typing import Any

import pytest

from porolub.errors import SceneError
from porolub.scene import Scene, scene_from_dict
from porolub.study.accuracy.quantities import (
    default_quantities,
    estimate_of,
    read_quantities,
    value_of,
)
from tests.scene.scenes import ROLLING, changed

SWINGING = {"mean": "0 rad/s", "amplitude": "1 rad/s", "frequency": "1 Hz"}
TIME = {"end": "1 s"}


def scene(**sections: Any) -> Scene:
    return scene_from_dict(changed(ROLLING, **sections))


def test_a_plain_name_is_the_mean_of_a_period_or_the_end_of_a_run() -> None:
    assert read_quantities("approach, film_min,approach", scene()) == ("approach", "film_min")
    assert read_quantities("", scene()) == ()
    assert read_quantities("approach,film_min.min", scene(time=TIME)) == (
        "approach.end", "film_min.min",
    )  # fmt: skip
    swinging = scene(time=TIME, motion={"speed": SWINGING})
    assert read_quantities("approach,approach.end", swinging) == ("approach.mean", "approach.end")
    with pytest.raises(SceneError, match="there is no such quantity; allowed: friction"):
        read_quantities("wall_time", scene())


def test_values_are_found_where_they_are() -> None:
    summary = {
        "approach": 3.0, "over_time": {"approach": {"mean": 2.0, "min": 1.0, "max": 4.0}},
        "load_ratio": None, "error_estimate": {"approach": -0.5, "load_ratio": None},
    }  # fmt: skip
    names = ("approach", "approach.end", "approach.mean", "approach.max", "load_ratio",
             "film_min.min")  # fmt: skip
    assert [value_of(summary, n) for n in names] == [3.0, 3.0, 2.0, 4.0, None, None]
    assert [estimate_of(summary, n) for n in names] == [0.5, 0.5, None, None, None, None]
    assert value_of({}, "approach.mean") is None
    assert estimate_of({}, "approach") is None


def test_what_is_prescribed_is_not_shown() -> None:
    found = [{"friction_coefficient": 0.2 + 0.01 * n, "load_fluid": 900.0 + n, "load_total": 1500.0,
              "approach": 1e-4 - 1e-6 * n, "pressure_max": n} for n in range(3)]  # fmt: skip
    usual = ("friction_coefficient", "load_fluid", "approach")
    assert default_quantities(scene(), found) == usual
    held = [{**s, "approach": 1e-4, "load_total": 1500.0 + s["pressure_max"]} for s in found]
    assert default_quantities(scene(), held)[2] == "load_total"
    without = [{**s, "friction_coefficient": None} for s in found]
    assert default_quantities(scene(), without) == ("load_fluid", "approach", "pressure_max")
    assert default_quantities(scene(), []) == ()
