"""What an accuracy study varies: strategies (grading, degrees, order), each on several levels."""

import shlex
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

from porolub.errors import SceneError
from porolub.scene import Scene, scene_from_dict
from porolub.scene.geometry import MeshFile
from porolub.scene.overrides import assign
from porolub.study.accuracy.levels import LEVELS, Level, both, mesh_levels, tolerance_levels

VARIED = ("mesh", "degree", "time", "tolerance")
_GRADINGS = {"uniform": "none", "graded": "contact"}
_EDGE = "mesh.edge_size"

Option = tuple[str, dict[str, Any]]


@dataclass(frozen=True)
class Setting:
    """A strategy on a level: what a scene is changed by.

    ``size``: of elements or tolerance over the scene's own; ``values``: by key of the scene, ""
    takes a key away; ``changes``: those that differ from the scene, as after --set.
    """

    strategy: str
    level: str
    size: float
    values: dict[str, Any] = field(repr=False)
    changes: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """What the setting is called in the table of the sweep."""
        return f"{self.strategy}, {self.level}"

    @property
    def options(self) -> str:
        """The changes as options of the command line; "" for the scene as it is."""
        return as_options(self.changes)


def as_options(changes: Iterable[str]) -> str:
    """Return changes to a scene as options of the command line."""
    return " ".join(f"--set {shlex.quote(text)}" for text in changes)


def read_varied(text: str, scene: Scene) -> tuple[str, ...]:
    """Return what ``--vary`` asks for; "": mesh, or time and tolerance of a transient scene.

    Raises SceneError for what there is not, or what the scene does not have.
    """
    if not text.strip():
        return ("mesh",) if scene.time is None else ("time", "tolerance")
    names = tuple(dict.fromkeys(name.strip() for name in text.split(",")))
    for name in names:
        if name not in VARIED:
            raise SceneError(f"--vary {name}: allowed are {', '.join(VARIED)}.")
        if name in ("time", "tolerance") and scene.time is None:
            raise SceneError(
                f"--vary {name}: the scene has no [time] section; allowed there: mesh, degree."
            )
    return names


def settings_of(scene: Scene, varied: Sequence[str], count: int) -> list[Setting]:
    """Return all settings, strategy by strategy, the coarsest level of each first.

    ``count``: of levels. Strategies that are no valid scene are left out. Raises SceneError where
    there is nothing to vary.
    """
    fewest, most = LEVELS
    if not fewest <= count <= most:
        raise SceneError(f"--levels {count}: a whole number from {fewest} to {most} is needed.")
    levels = _levels(scene, varied, count)
    base = scene.resolved()
    settings: list[Setting] = []
    seen: set[str] = set()
    refusal: SceneError | None = None
    for options, level in product(_strategies(scene, varied), levels):
        values = _values(options, level, scene)
        try:
            digest = scene_from_dict(_changed(base, values)).digest()
        except SceneError as error:
            refusal = error
            continue
        if digest not in seen:
            seen.add(digest)
            strategy = ", ".join(name for name, _ in options)
            changes = tuple(_changes(base, values))
            settings.append(Setting(strategy, level.name, level.size, values, changes))
    if not settings:
        raise SceneError(f"no setting of this study is a valid scene: {refusal}")
    return settings


def _levels(scene: Scene, varied: Sequence[str], count: int) -> list[Level]:
    in_time = bool({"time", "tolerance"} & set(varied))
    if "mesh" not in varied and in_time:
        return tolerance_levels(scene, count)
    if isinstance(scene.geometry, MeshFile):
        raise SceneError(
            'geometry.shape = "file": a mesh file is used as it is, so the study cannot refine it; '
            "allowed there: --vary time,tolerance, with a [time] section."
        )
    meshes = mesh_levels(scene, count)
    return both(meshes, tolerance_levels(scene, len(meshes))) if in_time else meshes


def _strategies(scene: Scene, varied: Sequence[str]) -> Iterable[tuple[Option, ...]]:
    """Every combination of gradings, degrees and orders; each has at least one name."""
    factors: list[list[Option]] = []
    own = next(name for name, value in _GRADINGS.items() if value == scene.mesh.grading)
    if "mesh" in varied:
        factors.append([(name, {"mesh.grading": value}) for name, value in _GRADINGS.items()])
    if "degree" in varied:
        factors.append(_degrees(scene))
    if "time" in varied:
        factors.append([(f"BDF{order}", {"time.order": order}) for order in (1, 2, 3)])
    elif "tolerance" in varied and not factors and scene.time is not None:
        factors.append([(f"BDF{scene.time.order}", {"time.order": scene.time.order})])
    return product(*factors) if factors else [((own, {}),)]


def _degrees(scene: Scene) -> list[Option]:
    """Pairs of displacement and pressure. Q1/Q1 is no stable pair for a layer that has no time to
    drain, as in the steps of a transient run."""
    letter = "P" if scene.mesh.element == "triangle" else "Q"
    fluid = scene.pores is not None or scene.film is not None
    pairs = [(1, 1), (2, 1)] + [(2, 2)] * fluid
    if scene.time is not None and scene.pores is not None:
        pairs.remove((1, 1))
    return [
        (
            f"{letter}{u}/{letter}{p}" if fluid else f"{letter}{u}",
            {"mesh.degree": u, "mesh.pressure_degree": p},
        )
        for u, p in pairs
    ]


def _values(options: Iterable[Option], level: Level, scene: Scene) -> dict[str, Any]:
    values = {key: value for _, option in options for key, value in option.items()} | level.values
    if "mesh.along" in values:
        graded = values.get("mesh.grading", scene.mesh.grading) == "contact"
        values[_EDGE] = f"{level.edge_size * 1e6:.6g} um" if graded else ""
    return values


def _changed(base: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    tables = {name: dict(v) if isinstance(v, dict) else v for name, v in base.items()}
    for key, value in values.items():
        assign(tables, key, value)
    return tables


def _changes(base: Mapping[str, Any], values: Mapping[str, Any]) -> Iterable[str]:
    for key, value in values.items():
        section, _, name = key.partition(".")
        if base.get(section, {}).get(name, "") != value:
            yield f"{key}={value}"
