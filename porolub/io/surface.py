"""surface.csv: profiles along the lubricated surface; of a body, a row for each of its nodes."""

import csv
import io
from dataclasses import fields
from pathlib import Path

import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import write_text
from porolub.solve.report import SurfaceData, SurfaceMap

COLUMNS = tuple(field.name for field in fields(SurfaceData))
"""s, x, p, p_c, h, Q, V."""
MAP_COLUMNS = ("s", "x", "y", "z", "p", "p_c", "h", "Q_s", "Q_z", "V")
"""In three dimensions; the facets are in surface.h5."""


def write_surface(path: Path, surface: SurfaceData | SurfaceMap) -> None:
    """Write the profiles in SI units; every number reads back to the same float."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = COLUMNS if isinstance(surface, SurfaceData) else MAP_COLUMNS
    writer.writerow(names)
    columns = [np.asarray(getattr(surface, name), dtype=float).tolist() for name in names]
    writer.writerows(zip(*columns, strict=True))
    write_text(path, text.getvalue())


def read_surface(path: Path) -> SurfaceData:
    """Read the profiles of a two-dimensional scene. Raises SceneError for another file."""
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
