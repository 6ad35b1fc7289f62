"""The quantities whose error an accuracy study tells, by name: ``load_fluid``, or
``friction_coefficient.mean`` of a transient run."""

import difflib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from porolub.errors import SceneError
from porolub.io.summary import IN_SPACE, number
from porolub.scene import Scene
from porolub.study.work.over_time import STATISTICS

MEASURED = (
    "friction_coefficient", "load_fluid", "load_solid", "load_total", "load_ratio",
    "friction_fluid", "approach", "film_min", "contact_length", "contact_left", "contact_right",
    *IN_SPACE, "penetration_length", "inflow_left", "inflow_right", "outflow_left",
    "outflow_right", "pressure_max", "pressure_min", "contact_pressure_max", "von_mises_max",
    "jacobian_min",
)  # fmt: skip
END = "end"
SHOWN = 3  # quantities, unless told
_STEADY = ("friction_coefficient", "load_fluid", "approach", "load_total", "pressure_max",
           "contact_pressure_max", "von_mises_max")  # fmt: skip
_PERIODIC = ("friction_coefficient.mean", "friction_coefficient.max", "load_fluid.mean",
             "approach.mean", "load_total.mean", "pressure_max.max")  # fmt: skip
_SAME = 1e-9  # relative: what changes less is prescribed

Summary = Mapping[str, Any]


def read_quantities(text: str, scene: Scene) -> tuple[str, ...]:
    """Return the names ``--quantity`` has, in full; "": none. Raises SceneError.

    A plain name means, in a transient scene, the mean over the last period, or the end of the run
    where nothing has a period.
    """
    return tuple(dict.fromkeys(_full(part.strip(), scene) for part in text.split(",") if part))


def _full(text: str, scene: Scene) -> str:
    name, dot, which = text.partition(".")
    if name not in MEASURED:
        near = difflib.get_close_matches(name, MEASURED, 1)
        hint = f" (did you mean {near[0]}?)" if near else ""
        raise SceneError(
            f"--quantity {text}: there is no such quantity{hint}; allowed: {', '.join(MEASURED)}."
        )
    if scene.time is None:
        if dot:
            raise SceneError(f"--quantity {text}: the scene has no [time] section; write {name}.")
        return name
    allowed = (*STATISTICS, END)
    if dot and which not in allowed:
        raise SceneError(
            f"--quantity {text}: behind the point is needed one of {', '.join(allowed)}."
        )
    return text if dot else f"{name}.{_usual(scene)}"


def _usual(scene: Scene) -> str:
    return END if scene.period is None else "mean"


def default_quantities(scene: Scene, summaries: Sequence[Summary]) -> tuple[str, ...]:
    """Return the main quantities that all the summaries have and that are not prescribed."""
    candidates: Iterable[str] = _STEADY
    if scene.time is not None:
        candidates = _PERIODIC if scene.period is not None else [f"{n}.{END}" for n in _STEADY]
    found = [name for name in candidates if _free([value_of(s, name) for s in summaries])]
    return tuple(found[:SHOWN])


def _free(values: Sequence[float | None]) -> bool:
    known = [value for value in values if value is not None]
    if not values or len(known) < len(values):
        return False
    return max(known) - min(known) > _SAME * max(map(abs, known)) or len(known) == 1


def value_of(summary: Summary, quantity: str) -> float | None:
    """Return a quantity, SI; None where the summary does not have it."""
    name, _, which = quantity.partition(".")
    if which in STATISTICS:
        return number((summary.get("over_time") or {}).get(name) or {}, which)
    return number(dict(summary), name)


def estimate_of(summary: Summary, quantity: str) -> float | None:
    """Return the absolute error a run estimated of itself, SI; None where it did not, as of means
    and extremes over time."""
    name, _, which = quantity.partition(".")
    if which in STATISTICS:
        return None
    estimate = number(summary.get("error_estimate") or {}, name)
    return None if estimate is None else abs(estimate)
