"""The transient scenes that ship: the paper's Section 2.3.3, Tables 3 and 4, Eqs. 23 and 24."""

from pathlib import Path

import pytest

from porolub.scene import load_scene

JOBS = Path(__file__).parents[2] / "jobs"


@pytest.mark.parametrize("number", [2, 3, 4, 5])
def test_the_paper_s_cases_differ_from_case_1_in_load_and_motion_only(number: int) -> None:
    one, case = (load_scene(JOBS / f"case{n}.toml") for n in (1, number))
    for section in ("geometry", "mesh", "solid", "pores", "film", "contact", "conventions"):
        assert getattr(case, section) == getattr(one, section)
    assert case.title.startswith(f"Case {number}: ")
    assert case.period == 1.0
    assert case.load is not None
    assert case.motion is not None
    assert case.time is not None
    assert (case.time.end, case.time.tolerance, case.time.start) == (5.0, 1e-3, "steady")
    # Table 4 with Eqs. 23 and 24, a quarter and half of a period on
    speeds = {2: (1.0, 1.0)}.get(number, (0.0, -1.0))
    assert [case.motion.at(t) for t in (0.25, 0.5)] == pytest.approx(speeds, abs=1e-12)
    loads = {2: (2250, 1500), 3: (1500, 1500), 4: (2250, 1500)}.get(number)
    if loads:
        assert [case.load.at(t) for t in (0.25, 0.5)] == pytest.approx(loads)


def test_the_bonded_gait_is_case_5_on_the_bonded_layer() -> None:
    gait, five, bonded = (
        load_scene(JOBS / f"{name}.toml") for name in ("gait_bonded", "case5", "case1_bonded")
    )
    assert (gait.load, gait.motion, gait.time) == (five.load, five.motion, five.time)
    for section in ("geometry", "mesh", "solid", "pores", "film", "contact", "conventions"):
        assert getattr(gait, section) == getattr(bonded, section)
