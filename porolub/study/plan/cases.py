"""The cases of a sweep: every combination of the positions on its axes, each a scene of its own."""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import product
from typing import Any

from pydantic import ValidationError

from porolub.errors import SceneError
from porolub.scene import Scene, scene_from_dict
from porolub.scene.resolved import LENGTH_OF_RUN
from porolub.study.plan.definition import Sweep, Tables
from porolub.study.plan.neighbours import with_neighbours


@dataclass(frozen=True)
class Case:
    """One scene of a sweep.

    ``position``: on each axis; ``values``: by key, as a scene file has them; ``axes``: by name, SI
    numbers or texts. ``scene`` is None where it was refused; ``refusal`` then says why. ``key``
    tells scenes apart whose answers differ, the same in every run. ``coordinates``: where the case
    lies along each axis for its neighbours, None where it has none there. ``parents``: (index,
    weight) of the cases whose states, weighted, it starts from; empty: from zero. ``order``: its
    place in the order of work, in which parents come first.
    """

    index: int
    position: tuple[int, ...]
    values: dict[str, Any]
    axes: dict[str, float | str]
    scene: Scene | None
    refusal: str
    key: str
    coordinates: tuple[float | None, ...] = ()
    parents: tuple[tuple[int, float], ...] = ()
    order: int = 0


def cases_of(sweep: Sweep) -> list[Case]:
    """Return all cases in the order of the axes, the last one fastest.

    A refused value makes a case without a scene. Raises SceneError for a key that no case knows,
    and where two cases are the same scene.
    """
    positions = product(*(range(len(axis)) for axis in sweep.axes))
    unknown: list[set[tuple[int | str, ...]]] = []
    cases: list[Case] = []
    for index, position in enumerate(positions):
        case, not_known = _case(sweep, index, position)
        cases.append(case)
        unknown.append(not_known)
    if reduce(set.__and__, unknown):  # the same key is refused in every case
        raise SceneError(cases[0].refusal)
    _refuse_same(cases)
    return with_neighbours(cases)


def _case(
    sweep: Sweep, index: int, position: tuple[int, ...]
) -> tuple[Case, set[tuple[int | str, ...]]]:
    """Return a case, its neighbours not yet found, and where it has keys that do not exist."""
    values: dict[str, Any] = {}
    axes: dict[str, float | str] = {}
    for axis, place in zip(sweep.axes, position, strict=True):
        values |= axis.values(place)
        axes[axis.name] = axis.label(place)
    tables = sweep.tables(values)
    unknown: set[tuple[int | str, ...]] = set()
    scene, refusal = None, ""
    try:
        scene = scene_from_dict(tables)
    except SceneError as error:
        refusal = str(error)
        if isinstance(error.__cause__, ValidationError):
            details = error.__cause__.errors(include_url=False)
            unknown = {d["loc"] for d in details if d["type"] == "extra_forbidden"}
    key = _digest(tables) if scene is None else _key(scene, values)
    coordinates = _coordinates(sweep, position, tables)
    case = Case(index, position, values, axes, scene, refusal, key, coordinates)
    return case, unknown


def _coordinates(
    sweep: Sweep, position: tuple[int, ...], tables: Tables
) -> tuple[float | None, ...]:
    """Return where a case lies; nowhere if it starts from zero, for it is asked to, runs through
    time, or has a mesh from a file (only structured meshes hand on their solutions)."""
    geometry = tables.get("geometry")
    of_file = isinstance(geometry, dict) and geometry.get("shape") == "file"
    if sweep.start == "zero" or "time" in tables or of_file:
        return (None,) * len(position)
    places = [axis.coordinates for axis in sweep.axes]
    return tuple(
        None if xs is None else float(xs[i]) for xs, i in zip(places, position, strict=True)
    )


def _key(scene: Scene, values: dict[str, Any]) -> str:
    """Return the digest of a scene and, where they matter to a sweep, what that leaves out.

    How long a run in time is followed changes its row; the solver does only if an axis asks for it.
    """
    more: Tables = {k: v for k, v in values.items() if k.startswith(("scene.title", "solver."))}
    if scene.time is not None:
        time = scene.resolved()["time"]
        more |= {key: time[key] for key in LENGTH_OF_RUN if key in time}
    return _digest([scene.digest(), more]) if more else scene.digest()


def _digest(content: Any) -> str:
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def _refuse_same(cases: Sequence[Case]) -> None:
    first: dict[str, Case] = {}
    for case in cases:
        same = first.setdefault(case.key, case)
        if same is not case:
            where = " and ".join(str(c.axes) for c in (same, case))
            raise SceneError(f"cases {same.index} and {case.index} are the same scene: {where}.")
