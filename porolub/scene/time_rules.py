"""Rules about what changes with time, and about what only a transient run can have."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from porolub.scene.describe import readable
from porolub.scene.history import History, lowest_of
from porolub.scene.schedule import common_period, varying

if TYPE_CHECKING:
    from porolub.scene.scene import Scene

ROUNDING = 1e-12


def time_violations(scene: "Scene") -> Iterator[str]:
    """Yield one sentence per broken rule."""
    yield from _load(scene)
    yield from _start(scene)
    yield from _until(scene)
    yield from _inertia(scene)


def _load(scene: "Scene") -> Iterator[str]:
    """A load holds the plane down; below zero only the suction of a film can hold it at all."""
    force = scene.load.force if scene.load is not None else None
    if not isinstance(force, History):
        return
    unit = "N/m" if scene.dimension == 2 else "N"
    begin = force.at(0.0)
    steady = scene.time is None or scene.time.start == "steady"
    if steady and begin <= 0:
        remedy = "" if scene.time is None else '; or set time.start = "rest"'
        yield (
            f"load.force is {readable(begin, unit)} at t = 0; "
            f"a steady state needs a load above 0{remedy}."
        )
        return
    lowest = lowest_of(force)
    if scene.time is not None and scene.film is None and lowest.value <= 0:
        yield (
            f"load.force falls to {readable(lowest.value, unit)} at t = {lowest.time:.4g} s; "
            "it must stay above 0 (unless there is a [film], whose suction can hold the plane)."
        )


def _start(scene: "Scene") -> Iterator[str]:
    time = scene.time
    if time is None or time.approach is None:
        return
    given = f"time.approach = {readable(time.approach, 'm')}"
    if time.start == "steady":
        yield f'{given} needs time.start = "rest": a steady start finds the approach itself.'
    elif scene.load is None or scene.load.force is None:
        yield f"{given} needs load.force: otherwise the approach is not free."


def _until(scene: "Scene") -> Iterator[str]:
    if scene.time is None or scene.time.until != "periodic":
        return
    given = 'time.until = "periodic"'
    periods = varying(scene)
    period = common_period(periods.values())
    if not periods:
        yield f"{given} needs a load, motion or boundary value that repeats; nothing changes here."
    elif period is None:
        never = [key for key, p in periods.items() if p == math.inf]
        each = ", ".join(f"{key} every {readable(p, 's')}" for key, p in periods.items())
        why = f"{never[0]} never repeats" if never else f"there is none of {each}"
        yield f"{given} needs a common period, but {why}."
    elif scene.time.end < 2 * period * (1 - ROUNDING):
        yield (
            f"{given} needs at least two periods of {readable(period, 's')}, but time.end = "
            f"{readable(scene.time.end, 's')}."
        )


def _inertia(scene: "Scene") -> Iterator[str]:
    solid = scene.solid
    if solid is None or not solid.inertia:
        return
    if solid.density is None:
        yield 'solid.inertia = true needs solid.density, such as "1100 kg/m^3".'
    if scene.time is None:
        yield "solid.inertia = true needs a [time] section: in a steady state nothing accelerates."
    elif scene.time.order == 3:
        yield (
            "time.order = 3 with solid.inertia = true lets vibrations grow that nothing damps; "
            "allowed there: 1 and 2."
        )
