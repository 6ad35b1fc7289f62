"""history.csv: one row for each accepted step."""

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path

from porolub.io.atomic import write_text
from porolub.io.summary import KEYS
from porolub.solve.report import StepRecord


def write_history(path: Path, records: Sequence[StepRecord]) -> None:
    """Write time (s) and every scalar of the steps, SI; empty where a step has no such value.

    Columns are those any step has: first the summary's keys in its order, then others as they
    first appear.
    """
    columns = _columns(record.values for record in records)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["time", *columns])
    for record in records:
        # float() first: repr of a NumPy number is no number
        cells = [_cell(record.values.get(column)) for column in columns]
        writer.writerow([_cell(record.time), *cells])
    write_text(path, text.getvalue())


def _columns(rows: Iterable[dict[str, float]]) -> list[str]:
    seen = dict.fromkeys(key for row in rows for key in row)
    return [key for key in KEYS if key in seen] + [key for key in seen if key not in KEYS]


def _cell(value: float | None) -> str:
    return "" if value is None else repr(float(value))
