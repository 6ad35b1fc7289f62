"""journal.jsonl: what became of each case of a sweep, one line of JSON each, in order of time.

The file only grows. A line is written in one piece and on disk before ``append`` returns, so that
a job that is killed loses the cases in flight and no other. JSON has no number for them, so NaN
and infinities stand there as ``NaN``, ``Infinity``, ``-Infinity``, which Python writes and reads.
"""

import errno
import json
import mmap
import os
from pathlib import Path
from typing import Any

import numpy as np

from porolub.errors import SceneError, SolveError
from porolub.io.atomic import to_disk

JOURNAL = "journal.jsonl"
PARTS = "part-*-of-*"
"""Directories of the parts of a sweep that several jobs share, within the sweep's own."""

Row = dict[str, Any]


class Journal:
    """Adds lines to a journal, which one process does at a time (porolub.study.work.lock)."""

    def __init__(self, path: Path) -> None:
        """Nothing is written yet; the first line makes the file."""
        self.path = Path(path)
        self._sound = False  # whether the end of the file is known to be that of a line

    def append(self, row: Row) -> None:
        """Add a row; it is on disk when this returns. A torn last line is cut off before.

        Raises SolveError where it cannot be written, the journal being as it was, and TypeError
        for a value that is no number, text, list or dict of those.
        """
        line = json.dumps(row, default=_plain).encode() + b"\n"
        try:
            if self._sound:
                self._write(line)
            else:
                self._begin(line)
        except OSError as error:
            self._sound = False
            raise SolveError(
                f"{self.path}: this case cannot be noted ({error.strerror or error}). All cases "
                f"noted before are kept: make room in {self.path.parent} and run the same "
                "command again."
            ) from error

    def _begin(self, line: bytes) -> None:
        """Write the first line of this process."""
        new = not self.path.exists()
        file = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        try:
            os.ftruncate(file, _sound_length(file))
        finally:
            os.close(file)
        self._write(line)
        if new:
            to_disk(self.path.parent)
        self._sound = True

    def _write(self, line: bytes) -> None:
        """Write a line and wait for the disk, or leave the file as it was."""
        file = os.open(self.path, os.O_WRONLY | os.O_APPEND | os.O_CLOEXEC)
        try:
            size = os.fstat(file).st_size
            try:
                if os.write(file, line) < len(line):
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
                os.fsync(file)
            except BaseException:  # also an interrupt between the two
                os.ftruncate(file, size)
                raise
        finally:
            os.close(file)


def read_rows(path: Path) -> dict[str, Row]:
    """Return the newest row of each key; nothing where there is no file.

    What a killed job left of a last line is passed over. Raises SceneError, which names the line,
    where any other is damaged.
    """
    try:
        lines = path.read_bytes().split(b"\n")
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise SceneError(f"{path}: this file cannot be read ({error.strerror}).") from error
    del lines[-1]  # empty, or torn
    rows: dict[str, Row] = {}
    for number, line in enumerate(lines, 1):
        row = _row(line)
        if row is not None:
            rows[row["key"]] = row
        elif number < len(lines):
            raise SceneError(
                f"{path}, line {number}: this is no row of a sweep, so the file was damaged or "
                "changed; take the line away to have its case computed again."
            )
    return rows


def rows_of(directory: Path) -> dict[str, Row]:
    """Return the rows of a sweep's directory and of its parts (part-1-of-4, ...), by key.

    Where several have a key, converged rows go before others, then the sweep's own before those
    of its parts. Raises SceneError as read_rows.
    """
    journals = [*sorted(directory.glob(f"{PARTS}/{JOURNAL}")), directory / JOURNAL]
    rows: dict[str, Row] = {}
    for path in journals:
        for key, row in read_rows(path).items():
            if not _converged(rows.get(key)) or _converged(row):
                rows[key] = row
    return rows


def _converged(row: Row | None) -> bool:
    return row is not None and row.get("status") == "converged"


def _row(line: bytes) -> Row | None:
    """Return the row a line holds, None where it holds none."""
    try:
        row = json.loads(line)
    except ValueError:
        return None
    return row if isinstance(row, dict) and isinstance(row.get("key"), str) else None


def _sound_length(file: int) -> int:
    """Return how many bytes are left without what a killed job left of a last line."""
    if os.fstat(file).st_size == 0:
        return 0
    with mmap.mmap(file, 0, access=mmap.ACCESS_READ) as text:
        end = text.rfind(b"\n") + 1
        start = text.rfind(b"\n", 0, max(end - 1, 0)) + 1
        return end if _row(text[start:end]) is not None else start


def _plain(value: Any) -> Any:
    """Return numbers and arrays of NumPy as Python's own."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"a journal has no place for {type(value).__name__} {value!r}")
