"""The circle a lubricated surface lies on: its centre is where the body turns.

A sector states it; of a user's mesh it is found by fitting a circle to the surface's nodes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porolub.fem.domains import Domain
from porolub.terms.plane import Plane

Array = NDArray[np.float64]
ROUND = 1e-3  # largest misfit, as a share of the surface's own height, that counts as a circle


@dataclass(frozen=True)
class Circle:
    """In mesh units, in the plane of motion (x, y)."""

    centre: tuple[float, float]
    radius: float

    def arc(self, X: Array) -> Array:
        """Signed arc position (...) of points (..., dim), 0 below the centre, positive in +x."""
        return self.radius * np.arctan2(X[..., 0] - self.centre[0], self.centre[1] - X[..., 1])


def fit_circle(X: Array) -> Circle | None:
    """Least-squares circle through points (n, 2); None where they lie on none (or on a line)."""
    middle = X.mean(axis=0)
    size = np.ptp(X, axis=0).max()
    x, y = ((X - middle) / size).T
    design = np.column_stack([2 * x, 2 * y, np.ones_like(x)])
    solution, _, rank, _ = np.linalg.lstsq(design, x**2 + y**2, rcond=1e-10)
    if rank < 3:
        return None
    a, b, c = solution
    radius = np.sqrt(c + a**2 + b**2)
    misfit = np.abs(np.hypot(x - a, y - b) - radius).max()
    if misfit > ROUND * np.ptp(y):
        return None
    return Circle((float(a * size + middle[0]), float(b * size + middle[1])), float(radius * size))


def surface_circle(scene: Any, mesh: Any, boundary: str | None, length: float) -> Circle | None:
    """The circle of the scene's lubricated surface in mesh units. Collective."""
    stated = getattr(scene.geometry, "outer_radius", None)
    if stated is not None:
        return Circle((0.0, stated / length), stated / length)
    if mesh.shape is not None or boundary is None:
        return None
    parts = mesh.comm.allgather(mesh.coordinates[mesh.boundary_nodes(boundary)][:, :2])
    return fit_circle(np.vstack(parts))


@dataclass(frozen=True)
class LubricatedSurface:
    """The surface that faces the rigid plane (scaled).

    domain: its facets; area: reference measure; weights: (nnode,) integral of each displacement
    basis function over it; circle: the circle it lies on, if any.
    """

    name: str
    plane: Plane
    domain: Domain
    area: float
    weights: Array
    circle: Circle | None


def typical_thickness(mesh: Any, boundary: str | None) -> float:
    """Volume over surface of a user's mesh: its thickness for scaling. Collective."""
    volume = mesh.comm.allreduce(float(Domain("cells", mesh, 2).weights.sum()))
    if boundary is None or boundary not in mesh.boundary_names:
        return volume ** (1.0 / mesh.dim)
    area = mesh.comm.allreduce(float(Domain(f"facets:{boundary}", mesh, 2).weights.sum()))
    return volume / area
