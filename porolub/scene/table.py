"""Samples from a CSV file: ``{table = "load.csv", interpolation = "linear", repeat = true}``.

The file has two columns, times and values, under a header that names their units:

    time [s], force [kN/m]
    0.00,     0.3
    0.12,     3.0

Blank lines and lines that begin with # are passed over. The table is read into ``times`` and
``values`` at once, so that a resolved scene stands alone and only the content of the file counts.
"""

import csv
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationInfo

from porolub.scene.base import beside_scene, refused
from porolub.scene.samples import first_not_increasing
from porolub.scene.units import TIME, Kind, NotAQuantity, Quantity, parse

_HEADING = re.compile(r"\s*(.*?)\s*\[\s*(.*?)\s*\]\s*")


@dataclass(frozen=True)
class Table:
    """Reads tables whose second column holds ``quantity``."""

    quantity: Quantity

    def read(self, value: Any, info: ValidationInfo) -> Any:
        """Return ``value`` with its key ``table``, if any, replaced by the samples in that file.

        Raises refused(...).
        """
        if not isinstance(value, dict) or "table" not in value:
            return value
        others = {key: v for key, v in value.items() if key != "table"}
        twice = [key for key in ("times", "values") if key in others]
        try:
            if twice:
                raise _Unreadable(f"table and {twice[0]} are both given; keep one of them")
            if not isinstance(value["table"], str):
                raise _Unreadable("the path of a CSV file is needed")
            path = beside_scene(Path(value["table"]), info)
            return others | _samples(_rows(path), self.quantity.kind_in(info.context))
        except _Unreadable as error:
            raise refused(str(error), "table") from error


class _Unreadable(ValueError):
    """Why a table cannot be taken."""


Row = tuple[int, list[str]]  # its line in the file, its cells


def _rows(path: Path) -> list[Row]:
    """Return the lines of a CSV file that hold something."""
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.reader(file, skipinitialspace=True)
            rows = [(reader.line_num, row) for row in reader]
    except FileNotFoundError:
        raise _Unreadable("there is no such table") from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise _Unreadable("the table cannot be read: a CSV file in UTF-8 is needed") from error
    return [(n, r) for n, r in rows if any(c.strip() for c in r) and not r[0].startswith("#")]


def _samples(rows: list[Row], kind: Kind) -> dict[str, list[str]]:
    """Return times and values as quantities, all of them checked."""
    kinds = (TIME, kind)
    example = f"time [s], value [{kind.example.split(' ', 1)[1]}]"
    if not rows:
        raise _Unreadable(f"the table is empty; a header is needed, such as {example}")
    for line, row in rows:
        if len(row) != 2:
            raise _Unreadable(
                f"line {line} must have two columns, separated by a comma, not {len(row)}"
            )
    (_, header), body = rows[0], rows[1:]
    units = [_unit(heading, k, example) for heading, k in zip(header, kinds, strict=True)]
    for line, row in body:
        for cell in row:
            if not _is_number(cell):
                raise _Unreadable(f'line {line}: "{cell.strip()}" is not a number')
    if len(body) < 2:
        raise _Unreadable(f"at least two rows are needed under the header, not {len(body)}")
    times, values = ([f"{row[i].strip()} {units[i]}" for _, row in body] for i in (0, 1))
    seconds = [parse(text, TIME) for text in times]
    if seconds[0] < 0:
        raise _Unreadable(f"line {body[0][0]}: a time must not be negative, a run begins at t = 0")
    later = first_not_increasing(seconds)
    if later is not None:
        raise _Unreadable(
            f"line {body[later][0]}: the times must increase, but {seconds[later]:g} s follows "
            f"{seconds[later - 1]:g} s"
        )
    return {"times": times, "values": values}


def _unit(heading: str, kind: Kind, example: str) -> str:
    """Return the unit of a column, checked."""
    match = _HEADING.fullmatch(heading)
    if match is None:
        raise _Unreadable(
            f'the column "{heading.strip()}" has no unit; a header is needed, such as {example}'
        )
    name, unit = match.groups()
    try:
        parse(f"1 {unit}", kind)
    except NotAQuantity as error:
        raise _Unreadable(f'the column "{name} [{unit}]": {error}') from error
    return unit


def _is_number(cell: str) -> bool:
    try:
        return math.isfinite(float(cell)) and "_" not in cell
    except ValueError:
        return False
