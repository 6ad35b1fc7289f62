"""history.csv: one row for each accepted step."""

import csv
import errno
import io
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.io.atomic import reported, to_disk, write_text
from porolub.io.summary import ORDER
from porolub.solve.report import StepRecord

_SAME_TIME = 1e-12  # relative: steps nearer than this are one


def write_history(path: Path, records: Sequence[StepRecord]) -> None:
    """Write time (s) and every scalar of the steps, SI; empty where a step has no such value.

    Columns are those any step has: first the summary's keys in its order, then others as they
    first appear. Raises OSError.
    """
    columns = ["time", *_in_order(key for record in records for key in record.values)]
    write_text(path, _text(columns, (_cells(columns, record) for record in records)))


def read_history(path: Path) -> dict[str, NDArray[np.float64]]:
    """Read the columns by name: (rows,) floats in SI, NaN where a cell is empty.

    A last line that was not written to its end is left out. Raises SceneError where the file is
    missing or damaged.
    """
    columns, rows = _read(path)
    table = np.array([[_value(cell) for cell in row] for row in rows], dtype=float)
    table = table.reshape(len(rows), len(columns))
    return {name: table[:, k].copy() for k, name in enumerate(columns)}


def read_records(path: Path) -> list[StepRecord]:
    """Read the steps as they were written, without values they did not have. Raises as above."""
    columns, rows = _read(path)
    return [
        StepRecord(
            float(row[0]), {c: float(v) for c, v in zip(columns[1:], row[1:], strict=True) if v}
        )
        for row in rows
    ]


class HistoryWriter:
    """Adds a row to history.csv for each accepted step, as soon as it is accepted.

    The first row sets the columns, in the order of write_history. What only a later step has
    (the place of a contact that was not there before) is put behind them: the file is written
    anew, with empty cells so far. A value that is NaN is written as such, one that is missing
    leaves its cell empty. Methods raise SolveError where the file cannot be written.
    """

    def __init__(self, path: Path, resume_at: float | None = None) -> None:
        """Begin a new file with the first row or, from ``resume_at`` (s), go on with the old one.

        Then rows of later times are taken away, as is a last line that was not finished; a
        missing file is begun anew. Raises SceneError where the old one is damaged.
        """
        self._path = path
        self._columns: list[str] = []
        self._unproven = False  # whether the columns are those of this run
        if resume_at is not None and path.exists():
            columns, rows = _read(path)
            last = resume_at + _SAME_TIME * abs(resume_at)
            self._replace(columns, [row for row in rows if float(row[0]) <= last])
            self._unproven = True

    def write(self, record: StepRecord) -> None:
        """Add a row: in one piece, so that others can read along, and kept if we are killed."""
        self._prove(record)
        new = _in_order(key for key in record.values if key not in self._columns)
        if not self._columns:
            self._replace(["time", *new], [])
        elif new:
            columns, rows = _read(self._path)
            self._replace([*columns, *new], [[*row, *([""] * len(new))] for row in rows])
        with reported(self._path):
            _append(self._path, _line(_cells(self._columns, record)).encode())

    def sync(self) -> None:
        """Make the rows survive a loss of power: before a checkpoint that counts on them."""
        if self._columns:
            with reported(self._path):
                to_disk(self._path)

    def _prove(self, record: StepRecord) -> None:
        if self._unproven and record.values and not record.values.keys() & set(self._columns):
            raise SceneError(
                f"{self._path}: this file has none of the columns {', '.join(record.values)}; "
                "it belongs to another run: move it away."
            )
        self._unproven = False

    def _replace(self, columns: list[str], rows: list[list[str]]) -> None:
        with reported(self._path):
            write_text(self._path, _text(columns, rows))
        self._columns = columns


def _in_order(keys: Iterable[str]) -> list[str]:
    """Each key once: those of the summary in its order, then the others as they come."""
    seen: Mapping[str, None] = dict.fromkeys(keys)
    return [key for key in ORDER if key in seen] + [key for key in seen if key not in ORDER]


def _cells(columns: Sequence[str], record: StepRecord) -> list[str]:
    values = {**record.values, "time": record.time}
    return [_cell(values.get(column)) for column in columns]


def _cell(value: float | None) -> str:
    # float() first: repr of a NumPy number is no number
    return "" if value is None else repr(float(value))


def _value(cell: str) -> float:
    return float(cell) if cell else np.nan


def _text(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    return "".join(_line(cells) for cells in [columns, *rows])


def _line(cells: Sequence[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(cells)
    return text.getvalue()


def _append(path: Path, line: bytes) -> None:
    """Add a line or nothing."""
    file = os.open(path, os.O_WRONLY | os.O_APPEND)
    try:
        size = os.fstat(file).st_size
        if os.write(file, line) < len(line):
            os.ftruncate(file, size)
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    finally:
        os.close(file)


def _read(path: Path) -> tuple[list[str], list[list[str]]]:
    """Columns and rows of cells that are numbers or empty, without a torn last line."""
    try:
        text = path.read_bytes().decode()
        columns, *rows = csv.reader(text[: text.rfind("\n") + 1].splitlines())
        if columns[:1] != ["time"] or len(set(columns)) < len(columns):
            raise ValueError("other columns")
        if rows and not _is_row(rows[-1], columns):
            del rows[-1]
        if not all(_is_row(row, columns) for row in rows):
            raise ValueError("a row that is none")
    except FileNotFoundError:
        raise SceneError(f"{path}: there is no history of a run here.") from None
    except (OSError, ValueError, csv.Error) as error:
        raise SceneError(f"{path}: this file is damaged or was not written by porolub.") from error
    return columns, rows


def _is_row(row: list[str], columns: list[str]) -> bool:
    try:
        numbers = [_value(cell) for cell in row]
    except ValueError:
        return False
    return len(numbers) == len(columns) and not np.isnan(numbers[0])
