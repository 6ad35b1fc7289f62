"""What a sweep is: a base scene, the axes along which it changes, how its cases are computed."""

import copy
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from porolub.scene.overrides import assign
from porolub.study.plan.axis import Axis

Tables = dict[str, Any]


@dataclass(frozen=True, eq=False)
class Sweep:
    """``base``: the tables of the base scene with all changes but those of the axes made.

    Mesh files and tables in it have absolute paths. ``scene`` is the file it came from, None if it
    stood in the sweep file itself; ``set`` the changes made to it. ``ranks_per_case``, ``start``
    and ``keep`` as in the sweep file.
    """

    title: str
    base: Tables = field(repr=False)
    axes: tuple[Axis, ...]
    scene: Path | None = None
    set: tuple[str, ...] = ()
    ranks_per_case: int = 1
    start: Literal["neighbour", "zero"] = "neighbour"
    keep: Literal["rows", "results"] = "rows"

    def tables(self, values: Mapping[str, Any]) -> Tables:
        """Return the tables of the scene that has these values, by key.

        A section set to true stays as it is in the base scene. Raises SceneError where a key
        cannot be set because it leads through a value that is no table.
        """
        tables = copy.deepcopy(self.base)
        for key, value in values.items():
            if not (value is True and isinstance(tables.get(key), dict)):
                assign(tables, key, copy.deepcopy(value))
        return tables

    def resolved(self) -> Tables:
        """Return the sweep as the tables of a sweep file that needs no other file but meshes."""
        header = {
            "title": self.title,
            "ranks_per_case": self.ranks_per_case,
            "start": self.start,
            "keep": self.keep,
        }
        axes = [_axis_table(axis) for axis in self.axes]
        return {"sweep": header, "axis": axes, "base": copy.deepcopy(self.base)}


def _axis_table(axis: Axis) -> Tables:
    one = len(axis.keys) == 1
    values = [v[0] if one else list(v) for v in axis.texts]
    table = {"key": axis.keys[0] if one else list(axis.keys), "name": axis.name, "values": values}
    return table if axis.numbers is None else {**table, "scale": axis.scale}
