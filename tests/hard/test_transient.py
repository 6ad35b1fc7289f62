"""What is hard on the way: reversals, jumps, loss of contact, hardly any drainage, high speed.

Stable means, for all of them: the run reaches its end from zero in one go; J > 0, no node
penetrates and none pulls after any step; the load asked for is carried; no fluid appears; Newton
needs few iterations and few steps are taken back; the pressure at the end does not oscillate from
node to node.  What else it means is said with each.
"""

import numpy as np
import pytest

from tests.hard.stable import assert_smooth
from tests.physics.cases import Run, run, scene
from tests.physics.test_cases import PENETRATION

MESH = (40, 4)
BALANCE = 1e-5  # of fluid mass; the runs are short and little of it moves
TAKEN_BACK = 0.07  # share of steps
ROLLING = "motion.speed=1 rad/s"
OSCILLATING = ("load.force={mean='1.5 kN/m', amplitude='0.75 kN/m', frequency='1 Hz', "
               "shape='sine'}")
BASES = {"sliding": ("case2",), "bonded": ("gait_bonded", ROLLING, OSCILLATING)}
slow = pytest.mark.slow


def samples(times: str, values: str, unit: str) -> str:
    """Straight lines through samples, times in ms."""
    quoted = (",".join(f"'{v} {u}'" for v in text.split())
              for text, u in ((times, "ms"), (values, unit)))
    return "{{times=[{}], values=[{}]}}".format(*quoted)


def history(base: str, *overrides: str) -> Run:
    """Case 2 on either base, bonded with friction that shears it."""
    job, *others = BASES[base]
    done = run(scene(job, *MESH, *others, *overrides))
    assert_sound(done)
    return done


def assert_sound(done: Run, taken_back: float = TAKEN_BACK) -> None:
    """All that the top of this file says."""
    assert done.converged, done.message
    assert done["jacobian_min"].min() > 0.0
    assert min(done.gaps) > -PENETRATION
    assert min(done.pressures) >= 0.0
    assert done.overall.get("load_balance_error", 0.0) < 1e-9
    assert done.overall["mass_balance_error"] < BALANCE
    assert done.newton_per_step <= 4.5
    assert done.rejected_share <= taken_back, done.rejections
    assert done.surface is not None
    assert_smooth(done.surface.p[::2])  # p is linear between the vertices


@pytest.mark.parametrize("load", ["1.5 kN/m", pytest.param("3 kN/m", marks=slow)])
def test_reversal_at_full_load_with_friction_that_shears_a_bonded_layer(load: str) -> None:
    """Friction turns round within 20 ms. Each reversal costs six rejected steps at most, and the
    way back mirrors the way there."""
    done = run(scene("gait_bonded", *MESH, f"load.force={load}", "time.end=2 s"))
    assert_sound(done, taken_back=1.0)
    assert len(done.rejections) <= 6 * 4  # four reversals
    assert all(np.abs((t + size) % 0.5 - 0.25) < 0.06 for t, size, _ in done.rejections)
    friction = done.over_period("friction_coefficient")
    np.testing.assert_allclose(np.roll(friction, 200), friction, atol=0.15 * np.ptp(friction))
    for way in ("inflow", "outflow"):
        left, right = (done.over_period(f"{way}_{side}") for side in ("left", "right"))
        assert np.abs(np.roll(left, 200) - right).mean() < 0.05 * right.max()


def test_reversal_of_a_layer_that_rolls_fast() -> None:
    """Case 3 at ten times its speed: thin film, contact passed in 10 ms, and back."""
    done = run(scene("case3", *MESH, "motion.speed.amplitude=10 rad/s", "time.end=1 s"))
    assert_sound(done)
    friction = done["friction_coefficient"]
    assert 0.15 < friction.min() < friction.max() < 0.22


@pytest.mark.parametrize("base", ["bonded", pytest.param("sliding", marks=slow)])
def test_ten_times_the_load_within_a_millisecond_and_back(base: str) -> None:
    """The fluid takes the jump, the solid follows; afterwards the state is that of before."""
    load = samples("0 20 21 50 51", "0.3 0.3 3 3 0.3", "kN/m")
    done = history(base, f"load.force={load}", ROLLING, "time.end=1 s")
    times, solid, fluid = done["time"], done["load_solid"], done["load_fluid"]
    jump = [int(np.argmin(np.abs(times - t))) for t in (0.020, 0.021)]
    np.testing.assert_allclose(times[jump], (0.020, 0.021), rtol=1e-12)  # landed on
    rise = fluid[jump[1]] - fluid[jump[0]]
    assert rise > 0.9 * 2700.0
    assert solid[jump[1]] - solid[jump[0]] < 0.1 * 2700.0
    held = (times > 0.021) & (times < 0.050)
    assert solid[held][-1] > 1.2 * solid[held][0]
    for column in (solid, fluid):
        assert column[-1] == pytest.approx(column[0], abs=0.01 * 300.0)


@pytest.mark.parametrize("base", ["sliding", pytest.param("bonded", marks=slow)])
def test_a_load_that_pulls_for_a_while_opens_the_contact(base: str) -> None:
    """For 10 ms suction in the film holds the plane, which comes off; then it is pressed in again
    and all is as it was."""
    load = samples("0 50 60 100", "1.5 -0.05 -0.05 1.5", "kN/m")
    done = history(base, f"load.force={load}", ROLLING, "time.end=1 s")
    times, off = done["time"], done["load_solid"] < 1e-9
    assert off.any()
    assert np.all((times[off] > 0.05) & (times[off] < 0.1))
    assert done["contact_length"][off].max() == 0.0
    assert done["film_min"][off].max() > 1e-6
    assert done["film_min"][~off].max() == 0.0
    assert done["load_fluid"].min() <= -50.0 * (1 - 1e-9)
    for key in ("load_solid", "contact_length", "approach"):
        assert done[key][-1] == pytest.approx(done[key][0], rel=0.03), key


@pytest.mark.parametrize("base", ["bonded", pytest.param("sliding", marks=slow)])
def test_a_load_that_keeps_pulling_ends_with_what_has_happened(base: str) -> None:
    """A film resists the less the thicker it is (dh/dt ~ h^1.5), so the plane is gone in finite
    time: no run can go on, and this one says so."""
    job, *others = BASES[base]
    load = samples("0 100", "1.5 -0.05", "kN/m")
    done = run(scene(job, *MESH, *others, f"load.force={load}", "time.end=1 s"))
    assert not done.converged
    assert "a load of -50 N/m has pulled the plane 1" in done.message
    assert "mm off the layer and nothing holds it: load.force must press again" in done.message
    assert 0.1 < done["time"][-1] < 0.15
    assert len(done.records) < 300
    assert min(done.gaps) > -PENETRATION
    assert done.overall["load_balance_error"] < 1e-9


@pytest.mark.parametrize(("base", "depth"), [
    ("bonded", 40.0), ("sliding", 80.0)])
def test_a_plane_that_is_lifted_off_and_pressed_in_again(base: str, depth: float) -> None:
    """10 um off for 0.1 s with the film between; afterwards the load is that of before."""
    path = samples("0 100 200 300", f"{depth} -10 -10 {depth}", "um")
    job, *others = BASES[base]
    others = [o for o in others if not o.startswith("load")]
    done = run(scene(job, *MESH, *others, f"load={{approach={path}}}", "time.end=0.8 s",
                     "time.step_max=10 ms"))
    assert_sound(done)
    times = done["time"]
    np.testing.assert_allclose(done["approach"], np.interp(
        times, (0.0, 0.1, 0.2, 0.3), np.array([depth, -10.0, -10.0, depth]) * 1e-6), atol=1e-15)
    off = (times > 0.13) & (times < 0.199)
    assert off.sum() > 3
    assert done["contact_length"][off].max() == 0.0
    assert np.abs(done["load_total"][off]).max() < 0.02 * done["load_total"][0]
    for key, share in (("load_total", 0.02), ("load_solid", 0.05), ("contact_length", 1e-9)):
        assert done[key][-1] == pytest.approx(done[key][0], rel=share), key


@pytest.mark.parametrize(("base", "start"), [
    ("bonded", "steady"), pytest.param("sliding", "rest", marks=slow),
    pytest.param("bonded", "rest", marks=slow), pytest.param("sliding", "steady", marks=slow)])
def test_a_layer_that_hardly_drains(base: str, start: str) -> None:
    """Permeability a ten thousandth of Case 2's: c = 1e-10 m^2/s, where equal-order elements
    would oscillate.  Less fluid crosses the surface, and what the solid carries does not jump."""
    done = history(base, "pores.permeability=1e-19 m^2", f"time.start={start}", "time.end=1 s")
    usual = history(base, f"time.start={start}", "time.end=1 s")
    assert done.moved() < 0.75 * usual.moved()
    assert np.abs(np.diff(done["load_solid"][done["time"] > 0.1])).max() < 100.0  # no jumps


@slow
@pytest.mark.parametrize("base", ["bonded", "sliding"])
def test_what_crosses_the_surface_of_such_a_layer_falls_with_refinement(base: str) -> None:
    """It is an error of the mesh: in truth next to nothing does."""
    job, *others = BASES[base]
    moved = []
    for mesh in (MESH, (80, 8)):
        done = run(scene(job, *mesh, *others, "pores.permeability=1e-19 m^2", "time.start=rest",
                         "time.end=0.5 s"))
        assert_sound(done)
        moved.append(done.moved())
    assert moved[1] < 0.75 * moved[0]


@pytest.mark.parametrize("base", ["sliding", pytest.param("bonded", marks=slow)])
def test_ten_times_the_speed(base: str) -> None:
    """1 m/s: the layer is through the contact in 10 ms, and the fluid carries more than at 0.1."""
    done = history(base, "motion.speed=10 rad/s", "time.end=1 s")
    share = done["load_fluid"] / done["load_total"]
    assert share.min() > {"sliding": 0.6, "bonded": 0.9}[base]
    assert np.ptp(share) < 0.25


def test_orders_agree_and_the_lowest_takes_most_steps() -> None:
    runs = [history("sliding", f"time.order={k}", "time.end=1 s") for k in (1, 2, 3)]
    assert [r["order"].max() for r in runs] == [1.0, 2.0, 3.0]
    first, second, third = (r.over_period("friction_coefficient") for r in runs)
    assert np.abs(first - second).max() < 0.02 * second.max()
    assert np.abs(third - second).max() < 0.02 * second.max()


def test_first_and_longest_step_are_those_asked_for() -> None:
    done = history("sliding", "time.first_step=2 ms", "time.step_max=5 ms", "time.end=0.1 s")
    sizes = done["time_step"][1:]
    assert sizes[0] == pytest.approx(2e-3, rel=1e-12)
    assert sizes.max() <= 5e-3 * (1 + 1e-12)
    assert sizes.max() > 0.99 * 5e-3
