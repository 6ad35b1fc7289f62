"""Structured meshes of second order as files, for shapes a scene cannot name."""

from collections.abc import Callable
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SIDES = {"inlet": 1, "outlet": 2, "lubricated": 3, "bone": 4}


def growing(size: float, end: float, ratio: float) -> Array:
    """Ticks from 0 to `end` whose steps grow from about `size` by about `ratio` each."""
    count = max(1, round(np.log1p(end / size * (ratio - 1.0)) / np.log(ratio)))
    steps = ratio ** np.arange(count)
    return np.concatenate([[0.0], np.cumsum(steps) / steps.sum() * end])


def _with_middles(ticks: Array) -> Array:
    full = np.empty(2 * len(ticks) - 1)
    full[::2], full[1::2] = ticks, (ticks[1:] + ticks[:-1]) / 2
    return full


def layer_file(path: Path, x: Array, y: Array, surface: Callable[[Array], Array]) -> Path:
    """A layer above a plane: from its lubricated underside `surface(x)` up to max(y), in m.

    x, y: ticks of the vertices, y from 0 at the underside. Biquadratic cells (9 nodes) with all
    nodes of the underside on the curve; sides have the names of a sector.
    """
    X, Y = np.meshgrid(_with_middles(x), _with_middles(y), indexing="ij")
    Y = Y + surface(X) * (1.0 - Y / y[-1])
    return write_cells(path, X, Y)


def write_cells(path: Path, x: Array, y: Array) -> Path:
    """x, y: (2 along + 1, 2 across + 1) places of the nodes, across counted from the surface, m."""
    n = np.arange(x.size).reshape(x.shape)
    low, mid, high = slice(0, -1, 2), slice(1, None, 2), slice(2, None, 2)
    around = [(low, low), (high, low), (high, high), (low, high),
              (mid, low), (high, mid), (mid, high), (low, mid), (mid, mid)]
    cells = np.stack([n[pick].ravel() for pick in around], axis=1)
    lines = {"inlet": n[0], "outlet": n[-1], "lubricated": n[:, 0], "bone": n[:, -1]}
    sides = [np.stack([row[low], row[high], row[mid]], axis=1) for row in lines.values()]
    tags = [np.full(len(side), SIDES[name]) for name, side in zip(lines, sides, strict=True)]
    groups = [np.concatenate(tags), np.full(len(cells), 9)]
    meshio.Mesh(
        np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]),
        [("line3", np.vstack(sides)), ("quad9", cells)],
        cell_data={"gmsh:physical": groups, "gmsh:geometrical": groups},
        field_data={**{name: np.array([tag, 1]) for name, tag in SIDES.items()},
                    "layer": np.array([9, 2])},
    ).write(path, file_format="gmsh22", binary=False)
    return path
