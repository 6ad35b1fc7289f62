"""The effects of a scene added one at a time: from what it cannot do without to all of it."""

import copy
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from porolub.errors import SceneError
from porolub.scene import Scene, scene_from_dict

Tables = dict[str, Any]
ABSENT = "none"  # takes a section away, as after --set


@dataclass(frozen=True)
class Step:
    """A scene on the way: ``name`` of what is new in it; ``values``: its sections by name, ABSENT
    where it has none. All steps have the same keys."""

    name: str
    values: Tables


def effect_steps(scene: Scene) -> list[Step]:
    """Return the scenes, each with one effect more than the one before; the last is the scene.

    The first has the layer and what presses on it: contact, or the film where there is none. Where
    a scene would not be valid, the next effect is added with it. Raises SceneError if the scene has
    one effect only.
    """
    full = scene.resolved()
    own = {name: apply for name, apply in _EFFECTS.items() if _has(name, full)}
    presses = "contact" if "contact" in own else "film"
    waiting = [name for name in ("solid", presses) if name in own] or list(own)[:1]
    removed = [name for name in own if name not in waiting]
    found: list[tuple[str, Tables]] = []
    for number in range(len(removed) + 1):
        tables = copy.deepcopy(full)
        for name in reversed(removed[number:]):
            own[name](tables)
        _tidy(tables)
        try:
            scene_from_dict(tables)
        except SceneError:
            waiting.append(removed[number])
            continue
        found.append((", ".join(waiting), tables))
        waiting = removed[number : number + 1]
    if len(found) < 2:
        raise SceneError("--effects: the scene has one effect only, so there is none to add.")
    keys = [k for k in full if any(tables.get(k) != full[k] for _, tables in found)]
    first, *more = [Step(name, {k: t.get(k, ABSENT) for k in keys}) for name, t in found]
    return [first, *(Step(f"+ {step.name}", step.values) for step in more)]


def _without(section: str) -> Callable[[Tables], None]:
    def remove(tables: Tables) -> None:
        tables.pop(section, None)

    return remove


def _unset(section: str, key: str) -> Callable[[Tables], None]:
    def remove(tables: Tables) -> None:
        tables.get(section, {}).pop(key, None)

    return remove


_EFFECTS: dict[str, Callable[[Tables], None]] = {
    "solid": _without("solid"),
    "contact": _without("contact"),
    "pores": _without("pores"),
    "motion": _without("motion"),
    "carry": _unset("pores", "carry"),
    "film": _without("film"),
    "friction traction": _unset("contact", "friction_traction"),
    "compressibility": _unset("pores", "compressibility"),
    "time": _without("time"),
    "inertia": _unset("solid", "inertia"),
}
"""How to take an effect away, in the order they are added."""
_KEYS = {
    "carry": ("pores", "carry"),
    "friction traction": ("contact", "friction_traction"),
    "compressibility": ("pores", "compressibility"),
    "inertia": ("solid", "inertia"),
}


def _has(name: str, tables: Tables) -> bool:
    if name not in _KEYS:
        return name in tables
    section, key = _KEYS[name]
    return bool(tables.get(section, {}).get(key))


def _tidy(tables: Tables) -> None:
    """Take away what has no meaning without the effects that are gone."""
    if "pores" not in tables:
        for boundary in tables.get("boundary", {}).values():
            boundary.pop("pressure", None)
