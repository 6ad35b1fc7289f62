"""Sectors as mesh files whose elements are what a built mesh never has: skewed, or stretched."""

import math
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray

from tests.physics.mesh_files import write_cells

Array = NDArray[np.float64]
OUTER, THICKNESS, HALF_ANGLE = 100e-3, 1e-3, math.radians(5.0)  # those of Case 1
ENDS = 3e-3  # m; toward the ends, which stay radial, the lean is taken back


def skewed_sector(path: Path, along: int, across: int, degrees: float) -> Path:
    """Biquadratic cells whose sides lean by so many degrees against the thickness.

    Arcs stay arcs, so that the body still rolls in itself; every node lies on its own radius.
    """
    angle, depth = np.meshgrid(np.linspace(-HALF_ANGLE, HALF_ANGLE, 2 * along + 1),
                               np.linspace(0.0, THICKNESS, 2 * across + 1), indexing="ij")
    from_end = OUTER * (HALF_ANGLE - np.abs(angle))
    share = np.clip(from_end / ENDS, 0.0, 1.0)
    lean = math.tan(math.radians(degrees)) * share * share * (3.0 - 2.0 * share)
    angle = angle + lean * depth / (OUTER - depth)
    radius = OUTER - depth
    return write_cells(path, radius * np.sin(angle), OUTER - radius * np.cos(angle))


def lean_of(path: Path) -> float:
    """Largest angle (degrees) by which a side of a cell leans against the thickness."""
    mesh = meshio.read(path)
    corners = mesh.points[mesh.cells_dict["quad9"][:, [0, 3]], :2]  # below and above it
    side = corners[:, 1] - corners[:, 0]
    outward = np.array([0.0, OUTER]) - corners.mean(axis=1)
    cosine = np.einsum("kd,kd->k", side, outward) / (
        np.linalg.norm(side, axis=1) * np.linalg.norm(outward, axis=1))
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))).max())
