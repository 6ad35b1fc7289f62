"""Layers of hexahedra as files: any map of a brick, in any orientation."""

from collections.abc import Callable, Sequence
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SIDES = ("inlet", "outlet", "bone", "lubricated", "front", "back")
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))


def solid_file(path: Path, counts: Sequence[int], place: Callable[[Array], Array],
               names: Sequence[str] = SIDES) -> Path:
    """Eight-node hexahedra in the image of the unit brick under `place`, (n, 3) to (n, 3) in m.

    counts: elements along each axis; names: of the sides x = 0, x = 1, y = 0, ... A name that
    occurs twice is one boundary.
    """
    ticks = [np.linspace(0.0, 1.0, n + 1) for n in counts]
    logical = np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1).reshape(-1, 3)
    n = np.arange(len(logical)).reshape([c + 1 for c in counts])
    ends = (slice(0, -1), slice(1, None))
    cells = np.stack([n[ends[i], ends[j], ends[k]].ravel() for i, j, k in CORNERS], axis=1)
    quads, tags = [], []
    known = list(dict.fromkeys(names))
    for side, name in enumerate(names):
        face = n.take(-(side % 2), axis=side // 2)
        ring = [face[ends[i], ends[j]].ravel() for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
        quads.append(np.stack(ring, axis=1))
        tags.append(np.full(len(quads[-1]), known.index(name) + 1))
    groups = [np.concatenate(tags), np.full(len(cells), 9)]
    meshio.Mesh(
        place(logical),
        [("quad", np.vstack(quads)), ("hexahedron", cells)],
        cell_data={"gmsh:physical": groups, "gmsh:geometrical": groups},
        field_data={**{name: np.array([k + 1, 2]) for k, name in enumerate(known)},
                    "layer": np.array([9, 3])},
    ).write(path, file_format="gmsh22", binary=False)
    return path


def barrel(radius: float, thickness: float, angle: float, width: float) -> Callable[[Array], Array]:
    """A straight barrel about z, lowest at the origin; angle is the half angle."""
    def place(q: Array) -> Array:
        t, r = angle * (2 * q[:, 0] - 1), radius - thickness * (1 - q[:, 1])
        return np.column_stack([r * np.sin(t), radius - r * np.cos(t), width * (q[:, 2] - 0.5)])

    return place


def cap(radius: float, thickness: float, angle: float, half: float) -> Callable[[Array], Array]:
    """A spherical layer, lowest at the origin, between the planes |z| = half.

    Its inlet and outlet are planes through the axis z, `angle` to each side.
    """
    def place(q: Array) -> Array:
        t, z = angle * (2 * q[:, 0] - 1), half * (2 * q[:, 2] - 1)
        r = np.sqrt((radius - thickness * (1 - q[:, 1])) ** 2 - z**2)
        return np.column_stack([r * np.sin(t), radius - r * np.cos(t), z])

    return place
