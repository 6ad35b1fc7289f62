"""The rows of a sweep as columns: one cell a case, by name, and the SI units of the columns.

Columns are: case, the axes, what the sweep says of a case (FACTS), then the keys of the summaries
in their order with nested ones flattened (``wall_time.total``). A cell is a number, a text or None
where the case has no such value.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from porolub.io.summary import IN_SPACE, ORDER

Cell = float | int | str | None
Row = Mapping[str, Any]

FACTS = ("status", "message", "regime", "sommerfeld_number", "start", "wall")
"""What a row says beside its axes and the summary; the summary's own status is the row's."""
NESTED = ("dofs", "wall_time", "versions")
"""Keys of the summary that hold further keys."""
_OF_RUNS = ("time", "periods")  # further keys of transient runs
_READY = frozenset((float, int, type(None)))
_TEXTS = (*FACTS[:3], "start", "effects", "warnings")

_UNITS = {
    "load_total": ("N/m", "N"),
    "load_solid": ("N/m", "N"),
    "load_fluid": ("N/m", "N"),
    "approach": "m",
    "film_min": "m",
    "contact_length": "m",
    "contact_left": "m",
    "contact_right": "m",
    "contact_area": "m^2",
    "contact_width": "m",
    "penetration_length": "m",
    "inflow_left": ("kg/(m*s)", "kg/s"),
    "inflow_right": ("kg/(m*s)", "kg/s"),
    "outflow_left": ("kg/(m*s)", "kg/s"),
    "outflow_right": ("kg/(m*s)", "kg/s"),
    "pressure_max": "Pa",
    "pressure_min": "Pa",
    "contact_pressure_max": "Pa",
    "von_mises_max": "Pa",
    "wall": "s",
    "wall_time": "s",
    "peak_memory": "B",
    "time": "s",
}
"""SI units by key; two where they are those of a two- and of a three-dimensional scene."""

LIKE = ("error_estimate",)
"""Keys whose parts have the units of the numbers they are named after."""


class Axis(Protocol):
    """What is asked of an axis of a sweep: porolub.study.plan.axis, or a stand-in."""

    @property
    def name(self) -> str: ...
    @property
    def keys(self) -> Sequence[str]: ...
    @property
    def unit(self) -> str: ...


def headings(axes: Sequence[Axis]) -> list[str]:
    """Return the name of each axis's column: the axis's own or, where a column of the sweep or of
    the summary has that (approach) or HDF5 has no place for it, the scene key (load.approach)."""
    taken = {"case", "axes", "", ".", *FACTS, *ORDER, *_OF_RUNS}
    return [a.keys[0] if a.name in taken or "/" in a.name else a.name for a in axes]


def columns_of(axes: Sequence[Axis], rows: Iterable[Row]) -> dict[str, list[Cell]]:
    """Return the cells of all columns, in the order of case index; the last row of a case counts.

    All keys a summary always has are there, if no case has a value too.
    """
    by_case = {row["case"]: row for row in rows}
    chosen = [by_case[case] for case in sorted(by_case)]
    columns: dict[str, list[Cell]] = {"case": [row["case"] for row in chosen]}
    for axis, heading in zip(axes, headings(axes), strict=True):
        columns[heading] = [_cell(row["axes"].get(axis.name)) for row in chosen]
    for key in FACTS:
        columns[key] = [_cell(row.get(key)) for row in chosen]
    flat = [_flat(row.get("summary") or {}) for row in chosen]
    for key in _summary_names(flat):
        columns.setdefault(key, [cells.get(key) for cells in flat])
    return columns


def units_of(columns: Iterable[str], axes: Sequence[Axis]) -> dict[str, str]:
    """Return the SI unit of each column that has one."""
    names = list(columns)
    in_space = not set(IN_SPACE).isdisjoint(names)
    units = {}
    for name in names:
        key, _, rest = name.partition(".")
        unit = _UNITS.get(rest if key in LIKE else key, "")
        units[name] = unit if isinstance(unit, str) else unit[in_space]
    units |= {heading: a.unit for heading, a in zip(headings(axes), axes, strict=True)}
    return {name: unit for name, unit in units.items() if unit}


def as_array(name: str, cells: Sequence[Cell]) -> NDArray[Any]:
    """Return a column as int64 if all of it are whole numbers, as float64 (NaN where there is no
    value) if they are numbers, else as texts ("" where there is none): (cases,)."""
    given = [cell for cell in cells if cell is not None]
    if _is_text(name) or any(isinstance(cell, str) for cell in given):
        return np.array(["" if c is None else str(c) for c in cells], dtype=object)
    if given and len(given) == len(cells) and all(isinstance(cell, int) for cell in given):
        return np.array(cells, dtype=np.int64)
    return np.array([np.nan if cell is None else cell for cell in cells], dtype=np.float64)


def _is_text(name: str) -> bool:
    """Whether a column has texts even if all its cells are empty."""
    return name in _TEXTS or name.startswith("versions.")


def _flat(summary: Mapping[str, Any], prefix: str = "") -> dict[str, Cell]:
    cells: dict[str, Cell] = {}
    for key, value in summary.items():
        if isinstance(value, dict):
            cells |= _flat(value, f"{prefix}{key}.")
        else:
            cells[f"{prefix}{key}"] = _cell(value)
    return cells


def _summary_names(flat: Iterable[Mapping[str, Cell]]) -> list[str]:
    """Names of the summaries' columns: keys in the summary's order, others as they first appear."""
    seen: dict[str, dict[str, None]] = {key: {} for key in ORDER}
    for cells in flat:
        for name in cells:
            seen.setdefault(name.split(".", 1)[0], {})[name] = None
    names = []
    for key, found in seen.items():
        if key in FACTS:
            continue
        if len(found) > 1:
            found.pop(key, None)  # null in one case, a table in another
        if not found and key not in (*NESTED, *IN_SPACE):
            found[key] = None
        names += [name for name in found if name not in NESTED]
    return names


def _cell(value: Any) -> Cell:
    if type(value) in _READY:  # most, and there are millions
        return value
    if isinstance(value, np.ndarray | np.generic):
        return _cell(value.tolist())
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return " ".join(str(item) for item in value)
    text = str(value)
    # what is no text (names of files in another encoding) can be in neither table
    return text if text.isascii() else text.encode("utf-8", "replace").decode()
