"""The hard cases in time, on 30 x 3 elements: jumps, reversals, contact that comes and goes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.hard.case import Bounds, Case
from tests.hard.histories import History

MESH = (30, 3)
ROLLING = "motion.speed=1 rad/s"
FULL_LOAD = "load.force=3 kN/m"
JOBS = {"sliding": "case2", "bonded": "gait_bonded"}
QUIET = "time.frames=0"
IN_TIME = Bounds(load=1e-8, fluid=1e-5, contact=1e-5, oscillation=5e-3)
"""Fluid: of what moves, and in short runs little of it does. Oscillation: 5e-3, as contact edges
pass from node to node and each is smooth only from the next step on. Contact: as exactly as Newton
stops in time."""
CLOSING = replace(IN_TIME, oscillation=0.05)
"""A contact of a few nodes that comes or goes has its peak at the inlet and its trough at the
outlet within three of them, which looks like an oscillation of some per cent."""
JUMP = replace(IN_TIME, oscillation=0.1)
"""In the first steps after the kink fluid drains from 10 um; on the sliding base this leaves 6 % of
ripple for 1 ms, on 60 x 6 elements 7 % for the first 0.1 ms and 4 % after."""
UNDRAINED = replace(IN_TIME, oscillation=0.02, across=0.1)
"""Steps are below h^2/(6 c), where even a stable pair rings at a surface that drains."""
SUDDEN = replace(IN_TIME, oscillation=0.05, fluid=1e-3)
"""In 20 steps of 1 us fluid drains from 5 um below the surface, where the mesh has 333 um: up to
2 % of ripple. What flows in steps of 10 ns is hardly more than the rounding of what the layer
holds."""


def transient_cases() -> list[Case]:
    return [*zero_loads(), *reversals(), *jumps(), *films(), *steps(), *undrained()]


def both(group: str, name: str, stable: str, *overrides: str, fast: tuple[str, ...] = (),
         restart: tuple[float, float] | None = None, restarted: tuple[str, ...] = (),
         **rest: Any) -> Iterator[Case]:
    """A case on either base; ``fast``: bases in the fast suite, ``restarted``: also restarted."""
    for base, job in JOBS.items():
        case = Case(group, f"{name}, {base}", stable, job, (QUIET, *overrides), MESH, IN_TIME,
                    slow=base not in fast, restart=restart if base in restarted else None)
        yield replace(case, **rest)


def samples(times: str, values: str, unit: str, of_time: str = "ms") -> str:
    """Straight lines through samples."""
    quoted = (",".join(f"'{v} {u}'" for v in text.split())
              for text, u in ((times, of_time), (values, unit)))
    return "{{times=[{}], values=[{}]}}".format(*quoted)


# -- load crossing zero ----------------------------------------------------------------------


def zero_loads() -> Iterator[Case]:
    pull = samples("0 50 60 100", "1.5 -0.05 -0.05 1.5", "kN/m")
    yield from both(
        "load through zero", "pulled for 10 ms",
        "Contact is lost and found again, and the state comes back to that of before.",
        ROLLING, f"load.force={pull}", "time.end=0.4 s",
        restarted=("sliding", "bonded"), restart=(0.056, 0.065), also=comes_off_and_back,
        bounds=CLOSING)
    onset = samples("0 50", "-0.02 1.5", "kN/m")
    yield from both(
        "load through zero", "onset from rest",
        "A layer at rest under a pull meets its plane, and carries the load it is given.",
        ROLLING, f"load.force={onset}", "time.start=rest", "time.end=0.1 s", restarted=("bonded",),
        restart=(0.01, 0.015), also=lands, bounds=CLOSING)
    yield from both(
        "load through zero", "pulled for good",
        "The plane is gone in finite time, and the run says so.",
        ROLLING, f"load.force={samples('0 100', '1.5 -0.05', 'kN/m')}", "time.end=1 s",
        fails="has pulled the plane")


def comes_off_and_back(run: History) -> str:
    off = run["load_solid"] < 1e-9
    assert off.any(), "contact is never lost"
    assert run["contact_length"][off].max() == 0.0, "open, with a contact length"
    back = max(abs(run[k][-1] / run[k][0] - 1.0) for k in ("load_solid", "approach"))
    assert back < 0.05, f"comes back to {back:.1%}"
    return f"off in {off.sum()} steps, back to {back:.1%}"


def lands(run: History) -> str:
    solid, fluid = run["load_solid"], run["load_fluid"]
    assert solid[0] < 1e-9, "in contact from the start"
    assert solid[-1] > 0.0, "no onset of contact"
    assert solid[-1] + fluid[-1] == pytest.approx(1500.0, rel=1e-8)
    return f"first contact at {1e3 * run['time'][np.argmax(solid > 1e-9)]:.0f} ms"


# -- reversal at full load -------------------------------------------------------------------


def reversals() -> Iterator[Case]:
    for speed, end in ((1, 0.3), (20, 0.3)):
        swing = (f"motion.speed={{mean='0 rad/s', amplitude='{speed} rad/s', frequency='1 Hz', "
                 "shape='cosine'}")
        yield from both(
            "reversal", f"{speed} rad/s under 3 kN/m",
            "Friction keeps its size and the layer turns round within a tenth of a period.",
            swing, FULL_LOAD, f"time.end={end} s", fast=("bonded",) if speed == 1 else (),
            restarted=("sliding", "bonded") if speed == 1 else (), restart=(0.25, 0.27),
            also=turns_round)
    turn = samples("0 20 21 100", "1 1 -1 -1", "rad/s")
    yield from both(
        "reversal", "within 1 ms under 3 kN/m",
        "A jerk from 1 to -1 rad/s is passed, and the layer follows.",
        f"motion.speed={turn}", FULL_LOAD, "time.end=0.1 s", also=turns_round)


def turns_round(run: History) -> str:
    speed, friction = run["speed"], run["friction_coefficient"]
    assert speed[0] > 0.0 > speed[-1], "no reversal"
    assert np.ptp(friction) < friction.max(), "friction is lost on the way"
    return f"mu {friction.min():.3g} to {friction.max():.3g}"


# -- tenfold load in 1 ms --------------------------------------------------------------------


def jumps() -> Iterator[Case]:
    load = samples("0 20 21 60", "0.3 0.3 3 3", "kN/m")
    yield from both(
        "jump of load", "0.3 to 3 kN/m in 1 ms",
        "The fluid takes nine tenths of the jump, and hands it on slowly.",
        ROLLING, f"load.force={load}", "time.end=60 ms", fast=("bonded",),
        restarted=("sliding", "bonded"), restart=(0.0205, 0.025), also=fluid_takes,
        bounds=JUMP)


def fluid_takes(run: History) -> str:
    first, last = (int(np.argmin(np.abs(run["time"] - t))) for t in (0.020, 0.021))
    np.testing.assert_allclose(run["time"][[first, last]], (0.020, 0.021), rtol=1e-9)
    share = float(np.diff(run["load_fluid"][[first, last]])[0]
                  / np.diff(run["load_total"][[first, last]])[0])
    assert share > 0.9, f"the fluid takes {share:.2f} of it"
    return f"fluid takes {share:.2f}"


# -- a film that vanishes and re-forms -------------------------------------------------------


def films() -> Iterator[Case]:
    for depth, base in ((40, "bonded"), (80, "sliding")):
        path = samples("0 100 200 300", f"{depth} -10 -10 {depth}", "um")
        yield Case(
            "film", f"lifted off and pressed in again, {base}",
            "The film opens, carries nothing, closes, and the load is that of before.",
            "case1_bonded" if base == "bonded" else "case1",
            (QUIET, f"load={{approach={path}}}", "time.end=0.8 s", "time.step_max=10 ms"), MESH,
            CLOSING, also=lifts_off, slow=True, restart=(0.15, 0.2))
    halt = samples("0 50 60 200 210 500", "1 1 0 0 1 1", "rad/s")
    yield from both(
        "film", "1 Pa s, motion stops for 0.14 s",
        "What carries the load alone thins when the motion stops, and is back when it goes on.",
        "film.viscosity=1 Pa*s", "load.force=0.3 kN/m", f"motion.speed={halt}", "time.end=0.5 s",
        restarted=("bonded",), restart=(0.055, 0.07), also=film_comes_back)


def lifts_off(run: History) -> str:
    off = (run["time"] > 0.13) & (run["time"] < 0.199)
    assert off.sum() > 3
    assert run["contact_length"][off].max() == 0.0, "in contact though lifted off"
    assert run["film_min"][off].min() > 1e-6, "no film though lifted off"
    back = abs(run["load_total"][-1] / run["load_total"][0] - 1.0)
    assert back < 0.05, f"the load comes back to {back:.1%}"
    return f"load back to {back:.1%}"


def film_comes_back(run: History) -> str:
    t, h = run["time"], run["film_min"]
    before, still, after = (h[(t > a) & (t <= b)] for a, b in ((-1, 0.05), (0.15, 0.2), (0.45, 1)))
    assert still.min() < 0.9 * before[-1], "the film does not thin"
    assert after[-1] == pytest.approx(before[-1], rel=0.1), "the film does not come back"
    return f"h_min {1e6 * before[-1]:.3g}, {1e6 * still.min():.3g}, {1e6 * after[-1]:.3g} um"


# -- time steps ------------------------------------------------------------------------------


def steps() -> Iterator[Case]:
    for size in ("1e-8", "1e-6", "1e-4", "1e-2", "1", "10"):
        end = 20.0 * float(size)
        load = samples(f"0 {end}", "1.5 1.65", "kN/m", "s")
        yield from both(
            "time step", f"20 of {size} s", "Steps of the size asked for, none taken back.",
            ROLLING, f"load.force={load}", f"time.end={end} s", f"time.first_step={size} s",
            f"time.step_max={size} s", petsc="-ts_adapt_type none",
            fast=("sliding", "bonded") if size in ("1e-8", "1e-2", "10") else (),
            also=steps_asked_for, bounds=SUDDEN if float(size) < 1e-5 else IN_TIME)


def steps_asked_for(run: History) -> str:
    sizes = run["time_step"][1:]
    assert not run.rejections, run.rejections[0][2]
    asked = run.scene.time.first_step
    assert sizes.max() == pytest.approx(asked, rel=1e-9), f"steps up to {sizes.max():.3g} s"
    return f"{sizes.min():.2g} to {sizes.max():.2g} s"


# -- hardly drained --------------------------------------------------------------------------


def undrained() -> Iterator[Case]:
    load = ("load.force={mean='1.5 kN/m', amplitude='0.75 kN/m', frequency='1 Hz', "
            "shape='sine'}")
    for power in (13, 17, 20):
        for start, end in (("rest", 0.03), ("steady", 0.1)):
            if (power, start) == (20, "steady"):
                continue  # see the steady case
            hardest = power == 20
            yield from both(
                "permeability in time", f"1e-{power} m2 from {start}",
                "The load is carried from the first moment, without a ripple over the surface.",
                ROLLING, load, f"pores.permeability=1e-{power} m^2", f"time.start={start}",
                f"time.end={end} s", fast=("bonded",) if hardest else (),
                restarted=("bonded",) if hardest else (), restart=(0.002, 0.004),
                bounds=UNDRAINED)
    yield Case("permeability in time", "1e-20 m2 from steady, bonded",
               "The load is carried from the first moment, without a ripple over the surface.",
               JOBS["bonded"], (QUIET, ROLLING, load, "pores.permeability=1e-20 m^2",
                                "time.start=steady", "time.end=0.1 s"), MESH, UNDRAINED,
               slow=True)
