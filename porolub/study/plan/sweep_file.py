"""From a sweep file to a checked sweep, and back to a file that stands alone."""

from collections.abc import Sequence
from dataclasses import replace
from math import prod
from pathlib import Path
from typing import Any

import tomli_w
from pydantic import ValidationError

from porolub.errors import SceneError
from porolub.scene.overrides import apply_overrides, path_of
from porolub.scene.read import read_tables
from porolub.study.plan.axis import Axis, axis_of
from porolub.study.plan.definition import Sweep, Tables
from porolub.study.plan.sweep_schema import MOST_CASES, AxisTable, SweepFile
from porolub.study.plan.sweep_sentences import sweep_sentences

__all__ = ["Sweep", "is_sweep", "load_sweep", "read_resolved_sweep", "write_resolved_sweep"]

_FILES = ("path", "table")  # keys of a scene that name a file


def is_sweep(path: str | Path) -> bool:
    """Return whether a file is a TOML file with a [sweep] table."""
    try:
        return "sweep" in read_tables(Path(path))
    except SceneError:
        return False


def load_sweep(path: str | Path, overrides: Sequence[str] = ()) -> Sweep:
    """Read and check a sweep file and its base scene; the cases are not checked yet.

    ``overrides`` are changes to the scene, made after those in the file; such as begin with
    ``sweep.`` change the table [sweep] itself. Raises SceneError: one sentence per mistake.
    """
    path = Path(path)
    own = [text for text in overrides if path_of(text).startswith("sweep.")]
    changes = [text for text in overrides if text not in own]
    file = _checked(apply_overrides(read_tables(path, "sweep file"), own))
    header, scene = file.sweep, None
    if header.scene is not None:
        scene = (path.parent / Path(header.scene).expanduser()).resolve()
    directory = (scene or path).parent
    axes = tuple(_axis(number, table, directory) for number, table in enumerate(file.axis, 1))
    _fit_together(axes, changes)
    tables = file.base if scene is None else _base_tables(scene)
    base = apply_overrides(tables or {}, [*header.set, *changes])
    return Sweep(
        header.title,
        _absolute("", base, directory),
        axes,
        scene,
        (*header.set, *changes),
        header.ranks_per_case,
        header.start,
        header.keep,
    )


def write_resolved_sweep(path: str | Path, sweep: Sweep) -> None:
    """Write a sweep as TOML; read again it has the same cases."""
    Path(path).write_text(tomli_w.dumps(sweep.resolved()), encoding="utf-8")


def read_resolved_sweep(path: str | Path) -> Sweep:
    """Return the sweep that write_resolved_sweep wrote. Raises SceneError."""
    return load_sweep(path)


def _checked(tables: Tables) -> SweepFile:
    if "sweep" not in tables:
        raise SceneError("[sweep] is missing: this is no sweep file.")
    try:
        return SweepFile.model_validate(tables)
    except ValidationError as error:
        raise SceneError(sweep_sentences(error)) from error


def _base_tables(scene: Path) -> Tables:
    tables = read_tables(scene)
    if "sweep" in tables:
        raise SceneError(f'sweep.scene = "{scene}": this is a sweep file; a scene is needed.')
    return tables


def _axis(number: int, table: AxisTable, directory: Path) -> Axis:
    try:
        axis = axis_of(table)
    except SceneError as error:
        raise SceneError(f"axis {number} ({table.called}): {error}.") from error
    last = [key.rpartition(".")[2] for key in axis.keys]
    texts = tuple(
        tuple(_absolute(key, value, directory) for key, value in zip(last, values, strict=True))
        for values in axis.texts
    )
    return replace(axis, texts=texts)


def _fit_together(axes: Sequence[Axis], changes: Sequence[str]) -> None:
    """Refuse axes, and changes from the command line, that get into each other's way."""
    where: dict[str, int] = {}
    for number, axis in enumerate(axes, 1):
        for other in range(number - 1):
            if axes[other].name == axis.name:
                raise SceneError(
                    f'axes {other + 1} and {number} are both called "{axis.name}": '
                    "give one of them another name."
                )
        for key in axis.keys:
            for before, its in where.items():
                if _overlap(before, key):
                    raise SceneError(f"axes {its} and {number} both change {max(before, key)}.")
            where[key] = number
    for text in changes:
        for key, number in where.items():
            if path_of(text) == key or path_of(text).startswith(f"{key}."):
                raise SceneError(
                    f'the override "{text}" has no effect: axis {number} of the sweep sets {key}.'
                )
    cases = prod(map(len, axes))
    if cases > MOST_CASES:
        counts = " x ".join(str(len(axis)) for axis in axes)
        raise SceneError(
            f"the axes give {counts} = {cases} cases: at most {MOST_CASES} are allowed."
        )


def _overlap(one: str, other: str) -> bool:
    return f"{one}.".startswith(f"{other}.") or f"{other}.".startswith(f"{one}.")


def _absolute(key: str, value: Any, directory: Path) -> Any:
    """Return a value with all names of files in it made absolute, so that it can move."""
    if isinstance(value, dict):
        return {k: _absolute(k, v, directory) for k, v in value.items()}
    if key in _FILES and isinstance(value, str):
        return str((directory / Path(value).expanduser()).resolve())
    return value
