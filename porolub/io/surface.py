"""surface.csv: profiles along the lubricated surface."""

import csv
import io
from dataclasses import fields
from pathlib import Path

import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import write_text
from porolub.solve.report import SurfaceData

COLUMNS = tuple(field.name for field in fields(SurfaceData))
"""s, x, p, p_c, h, Q, V."""


def write_surface(path: Path, surface: SurfaceData) -> None:
    """Write the profiles in SI units; every number reads back to the same float."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    columns = [np.asarray(getattr(surface, name), dtype=float).tolist() for name in COLUMNS]
    writer.writerows(zip(*columns, strict=True))
    write_text(path, text.getvalue())


def read_surface(path: Path) -> SurfaceData:
    """Read what write_surface wrote. Raises SceneError where the file is not of that form."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            header, *rows = csv.reader(file)
        if tuple(header) != COLUMNS:
            raise ValueError("other columns")
        table = np.array([[float(cell) for cell in row] for row in rows]).reshape(-1, len(COLUMNS))
    except (OSError, ValueError) as error:
        raise SceneError(
            f"{path}: a table with the columns {','.join(COLUMNS)} cannot be read here."
        ) from error
    return SurfaceData(*table.T)
