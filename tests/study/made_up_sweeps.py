"""Made-up tables of sweeps that look like the reference scene's: Stribeck curves and maps."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from porolub.study.plan.axis import Axis
from porolub.study.work.regimes import regime
from porolub.study.work.table import Table, read_table, write_table

Summary = dict[str, Any]
VISCOSITY, RADIUS, SOLID_FRICTION = 1e-3, 0.1, 0.45


@dataclass(frozen=True)
class MadeUp:
    """What a table keeps of a sweep."""

    title: str
    axes: tuple[Axis, ...]


def axis(name: str, key: str, values: Sequence[float], unit: str, scale: Any = "linear") -> Axis:
    """An axis of numbers."""
    texts = tuple((f"{v!r} {unit}",) for v in values)
    return Axis(name, (key,), texts, np.array(values), unit, scale)


def categories(name: str, key: str, values: Sequence[str]) -> Axis:
    """An axis without numbers."""
    return Axis(name, (key,), tuple((v,) for v in values))


def case(load: float, speed: float = 1.0) -> Summary:
    """Summary of a case under a load (N/m) at a speed (rad/s): contact from some load on."""
    bearing = 40.0 * speed**0.8  # N/m, what the film carries
    touching = load > bearing
    fluid = load if not touching else bearing + 0.55 * (load - bearing)
    shear = 0.1 * speed**0.7 * (1 + 0.1 * min(load, bearing) ** 0.8)  # N/m
    friction = SOLID_FRICTION * (load - fluid) + shear
    rest = 0.0 if touching else 4e-6 * speed**0.6 * (bearing / load) ** 0.3
    approach = 2e-7 * load**0.7 - rest
    return {
        "status": "converged", "message": "converged", "load_total": load,
        "load_fluid": fluid, "load_solid": load - fluid,
        "load_ratio": fluid / (load - fluid) if touching else None,
        "friction_coefficient": friction / load, "friction_fluid": shear / fluid,
        "approach": approach, "film_min": rest,
        "contact_length": 2e-4 * np.sqrt(load - bearing) if touching else 0.0,
        "penetration_length": 2 * np.sqrt(2 * RADIUS * max(approach, 0.0)),
        "inflow_left": 1e-5 * load**0.3, "inflow_right": 1e-6, "outflow_left": 0.0,
        "outflow_right": 6e-6 * load**0.3, "pressure_max": 900.0 * load**0.7,
        "contact_pressure_max": 500.0 * load**0.7 if touching else 0.0,
        "effects": ["solid", "pores", "film", "contact", "rotation", "load"],
        "dofs": {"total": 9000}, "newton_iterations": 9,
    }  # fmt: skip


def failed() -> Summary:
    """What is known of a case that failed."""
    return {"status": "failed", "message": "Newton does not converge."}


def made_up(axes: Sequence[Axis], summaries: Sequence[Summary], speeds: Sequence[float] = (),
            title: str = "Made up") -> Table:  # fmt: skip
    """The table of the first cases, in the order of the axes; speeds (rad/s): 1 if not given."""
    places = product(*(range(len(a)) for a in axes))
    rows = []
    for n, (where, summary) in enumerate(zip(places, summaries, strict=False)):
        speed, load = speeds[n] if speeds else 1.0, summary.get("load_total")
        has_number = load is not None and load > 0
        number = VISCOSITY * speed * RADIUS / load if has_number else None
        rows.append({
            "case": n, "status": summary["status"], "message": summary["message"],
            "axes": {a.name: a.label(k) for a, k in zip(axes, where, strict=True)},
            "sommerfeld_number": number, "regime": regime(summary), "start": "zero", "wall": 1.0,
            "summary": summary if summary["status"] == "converged" else {},
        })  # fmt: skip
    with TemporaryDirectory() as place:
        write_table(Path(place), MadeUp(title, tuple(axes)), rows)
        return read_table(Path(place))


LOADS = tuple(float(load) for load in np.geomspace(1.0, 3000.0, 9))
SPEEDS = (0.1, 0.4, 1.5, 6.0)


def by_load(broken: Sequence[int] = ()) -> Table:
    """A Stribeck curve by load; cases that are ``broken`` failed."""
    cases = [failed() if n in broken else case(load) for n, load in enumerate(LOADS)]
    return made_up([axis("load", "load.force", LOADS, "N/m", "log")], cases, title="By load")


def by_speed_and_load(broken: Sequence[int] = ()) -> Table:
    """A map over speed and load."""
    axes = [axis("speed", "motion.speed", SPEEDS, "rad/s", "log"),
            axis("load", "load.force", LOADS, "N/m", "log")]  # fmt: skip
    given = list(product(SPEEDS, LOADS))
    cases = [failed() if n in broken else case(load, speed)
             for n, (speed, load) in enumerate(given)]  # fmt: skip
    return made_up(axes, cases, [speed for speed, _ in given], "Speed and load")
