"""table.csv and table.h5: all cases of a sweep, one row each, in SI units.

The columns and their order are those of porolub.study.work.columns. In table.h5 each is a dataset
of (cases,) with the attribute ``unit`` where it has one; the root's attributes are ``title``,
``axes`` (names) and ``columns`` (names in order); the group ``axes`` holds the positions of each
axis, numbers or texts, with the attributes ``name``, ``keys``, ``scale`` and ``unit``.
"""

import csv
import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import h5py
import numpy as np
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.io.atomic import replacing, reported, write_text
from porolub.io.hdf5 import NewFile, new_hdf5
from porolub.study.work import columns as cells_of
from porolub.study.work.columns import Cell, Row, as_array, columns_of, headings, units_of

CSV = "table.csv"
HDF5 = "table.h5"
_MANY = 1000  # cases from which on it pays to compress a column


class Axis(cells_of.Axis, Protocol):
    """What the table keeps of an axis: positions as numbers (SI) or, where they are none, texts."""

    def __len__(self) -> int: ...
    def label(self, position: int) -> float | str: ...
    @property
    def numbers(self) -> Any: ...
    @property
    def scale(self) -> str: ...


class Sweep(Protocol):
    """What the table keeps of a sweep."""

    @property
    def title(self) -> str: ...
    @property
    def axes(self) -> Sequence[Axis]: ...


@dataclass(frozen=True)
class TableAxis:
    """An axis as the table has it.

    column: its column in the table; numbers: (positions,) SI, or None and texts: (positions,);
    scale: linear | log, "" without numbers.
    """

    name: str
    column: str
    keys: tuple[str, ...]
    numbers: NDArray[np.float64] | None
    texts: tuple[str, ...]
    unit: str
    scale: str


@dataclass(frozen=True)
class Table:
    """A sweep's results: columns by name, each (cases,) of int64, float64 or texts (dtype object),
    in the order of ``names``; units: SI units of those that have one."""

    title: str
    names: tuple[str, ...]
    columns: dict[str, NDArray[Any]]
    units: dict[str, str]
    axes: tuple[TableAxis, ...]

    def __len__(self) -> int:
        return len(self.columns["case"])


def write_table(directory: Path, sweep: Sweep, rows: Iterable[Row]) -> None:
    """Write both files, each as a whole, from rows of the journal in any order.

    Raises SolveError where they cannot be written.
    """
    columns = columns_of(sweep.axes, rows)
    with reported(directory, "the table of the sweep"):
        write_text(directory / CSV, _csv(columns))
        with replacing(directory / HDF5) as (temporary,), new_hdf5(temporary) as file:
            _fill(file, sweep, columns)


def read_table(directory: Path) -> Table:
    """Read table.h5. Raises SceneError where it is missing or damaged."""
    path = directory / HDF5
    if not path.exists():
        raise SceneError(f"{directory}: there is no {HDF5}, so this is no output of a sweep.")
    try:
        with h5py.File(path, "r") as file:
            names = tuple(file.attrs["columns"])
            columns = {name: _values(file[name]) for name in names}
            units = {n: file[n].attrs["unit"] for n in names if "unit" in file[n].attrs}
            axes = tuple(_axis(file["axes"], heading) for heading in file["axes"].attrs["columns"])
            return Table(file.attrs["title"], names, columns, units, axes)
    except (OSError, KeyError, ValueError) as error:
        raise SceneError(f"{path}: this file is damaged or was not written by porolub.") from error


def comparable(table: Table) -> dict[str, NDArray[Any]]:
    """Return the columns that depend neither on the clock nor on the machine nor on its ranks."""
    other = ("wall", "wall_time", "peak_memory", "versions", "ranks")
    return {name: table.columns[name] for name in table.names if name.split(".")[0] not in other}


def _csv(columns: dict[str, list[Cell]]) -> str:
    """Text of table.csv, quoted as in RFC 4180; floats read back to the same."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*(_unreturned(cells) for cells in columns.values()), strict=True))
    return text.getvalue()


def _unreturned(cells: list[Cell]) -> list[Cell]:
    """Carriage returns are line ends to readers, and the writer does not quote them."""
    return [
        cell.replace("\r\n", "\n").replace("\r", "\n") if isinstance(cell, str) else cell
        for cell in cells
    ]


def _fill(file: NewFile, sweep: Sweep, columns: dict[str, list[Cell]]) -> None:
    units = units_of(columns, sweep.axes)
    for name, cells in columns.items():
        unit = {"unit": units[name]} if name in units else {}
        values = _stored(as_array(name, cells))
        file.whole(name, values, packed=len(values) >= _MANY, **unit)
    names = headings(sweep.axes)
    file.attrs = {
        "title": sweep.title,
        "axes": _texts([axis.name for axis in sweep.axes]),
        "columns": _texts(columns),
    }
    file.groups["axes"] = {"columns": _texts(names)}
    for heading, axis in zip(names, sweep.axes, strict=True):
        numeric = axis.numbers is not None
        texts = _texts(str(axis.label(position)) for position in range(len(axis)))
        file.whole(f"axes/{heading}", axis.numbers if numeric else texts)
        file[f"axes/{heading}"].attrs = {
            "name": axis.name,
            "keys": _texts(axis.keys),
            "scale": axis.scale if numeric else "",
            "unit": axis.unit,
        }


def _stored(values: NDArray[Any]) -> NDArray[Any]:
    """Texts of a fixed length, which can be compressed: most of a column are the same."""
    if values.dtype != object:
        return values
    encoded = [text.encode() for text in values]
    length = max(map(len, encoded), default=0)
    return np.array(encoded, dtype=h5py.string_dtype("utf-8", max(length, 1)))


def _texts(values: Iterable[str]) -> NDArray[Any]:
    return np.array(list(values), dtype=h5py.string_dtype("utf-8"))


def _values(data: h5py.Dataset) -> NDArray[Any]:
    values = data[:]
    if values.dtype.kind not in "SO":
        return values
    return np.array([text.decode() for text in values.tolist()], dtype=object)


def _axis(group: h5py.Group, heading: str) -> TableAxis:
    data = group[heading]
    about = data.attrs
    values = _values(data)
    numeric = values.dtype != object
    return TableAxis(
        name=about["name"],
        column=heading,
        keys=tuple(about["keys"]),
        numbers=values.astype(np.float64) if numeric else None,
        texts=() if numeric else tuple(values),
        unit=about["unit"],
        scale=about["scale"],
    )
