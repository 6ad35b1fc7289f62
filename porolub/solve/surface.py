"""The circle a lubricated surface lies on: its centre is where the body turns.

A sector states it; of a user's mesh it is found by fitting a circle, a cylinder about the axis of
the motion or a sphere to the surface's vertices.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.fem.domains import Domain
from porolub.scene.directions import unit_vector
from porolub.terms.plane import Plane

Array = NDArray[np.float64]
ROUND = 1e-3  # largest misfit, as a share of the surface's own height, that counts as a circle


@dataclass(frozen=True)
class Circle:
    """In mesh units: ``centre`` (2,) in the plane of x and y, or (3,).

    Seen from the centre the arc position is 0 in the direction ``down`` and grows toward
    ``along``, perpendicular unit vectors with as many components.
    """

    centre: tuple[float, ...]
    radius: float
    down: tuple[float, ...] = (0.0, -1.0)
    along: tuple[float, ...] = (1.0, 0.0)

    def arc(self, X: Array) -> Array:
        """Signed arc position (...) of points (..., dim)."""
        reach = X[..., : len(self.centre)] - np.asarray(self.centre)
        return self.radius * np.arctan2(reach @ np.asarray(self.along),
                                        reach @ np.asarray(self.down))


def fit_round(X: Array, comm: MPI.Intracomm) -> tuple[Array, float] | None:
    """Centre (k,) and radius of the circle or sphere through points (n, k). Collective.

    By least squares; every rank brings its own points. None where they lie on none (or are flat).
    |x|^2 = 2 x . c + (r^2 - |c|^2) is linear in what is sought; ranks exchange the triangles of
    their QR factors only.
    """
    k = X.shape[1]
    count = comm.allreduce(len(X))
    if count <= k:
        return None
    low = np.min(comm.allgather(X.min(axis=0, initial=np.inf)), axis=0)
    high = np.max(comm.allgather(X.max(axis=0, initial=-np.inf)), axis=0)
    middle = np.asarray(comm.allreduce(X.sum(axis=0))) / count
    size = (high - low).max()
    x = (X - middle) / size
    rows = np.column_stack([2 * x, np.ones(len(x)), (x**2).sum(axis=1)])
    rows = np.vstack(comm.allgather(np.linalg.qr(rows, mode="r")))
    solution, _, rank, _ = np.linalg.lstsq(rows[:, :-1], rows[:, -1], rcond=1e-10)
    if rank < k + 1:
        return None
    centre, radius = solution[:k], np.sqrt(solution[k] + (solution[:k] ** 2).sum())
    reach = x - centre
    misfit = np.abs(np.linalg.norm(reach, axis=1) - radius).max(initial=0.0)
    up = -centre / max(float(np.linalg.norm(centre)), 1e-300)  # from the centre to the middle
    height = comm.allreduce((reach @ up).max(initial=-np.inf), op=MPI.MAX) - comm.allreduce(
        (reach @ up).min(initial=np.inf), op=MPI.MIN)
    if comm.allreduce(misfit, op=MPI.MAX) > ROUND * height:
        return None
    return centre * size + middle, float(radius * size)


def _fit_axis(X: Array, comm: MPI.Intracomm, axis: Array, toward: Array) -> Circle | None:
    """The cylinder about an axis, or the sphere, through points (n, 3). Collective."""
    along = np.cross(axis, toward)
    if np.linalg.norm(along) < 1e-9:  # spins on the plane: the arc positions follow x or y
        along = np.eye(3)[0 if abs(toward[0]) < 0.9 else 1]
        along = along - (along @ toward) * toward
        down = toward
    else:
        along = along / np.linalg.norm(along)
        down = np.cross(along, axis)
    frame = np.stack([along, down])
    found = fit_round(X @ frame.T, comm) if abs(down @ axis) < 1e-9 else None
    if found is not None:
        centre = found[0] @ frame
    else:
        found = fit_round(X, comm)
        if found is None:
            return None
        centre = found[0]
    return Circle(tuple(centre.tolist()), found[1], tuple(down.tolist()), tuple(along.tolist()))


def surface_circle(scene: Any, mesh: Any, boundary: str | None, length: float) -> Circle | None:
    """The circle of the scene's lubricated surface in mesh units. Collective."""
    stated = getattr(scene.geometry, "outer_radius", None)
    if stated is not None:
        return Circle((0.0, stated / length), stated / length)
    if mesh.shape is not None or boundary is None or boundary not in mesh.boundary_names:
        return None
    nodes = mesh.boundary_nodes(boundary)
    # middles of straight edges lie beside the surface
    X = mesh.coordinates[nodes[mesh.owned[nodes] & (nodes < mesh.nvertices)]]
    if mesh.dim == 3:
        axis = np.asarray(unit_vector(getattr(scene.motion, "axis", "z"), 3))
        return _fit_axis(X, mesh.comm, axis, np.asarray(scene.geometry.toward_plane(3)))
    found = fit_round(X, mesh.comm)
    return None if found is None else Circle(tuple(found[0].tolist()), found[1])


@dataclass(frozen=True)
class LubricatedSurface:
    """The surface that faces the rigid plane (scaled).

    domain: its facets; area: reference measure; weights: (nnode,) of nodal quadrature over it, in
    sum the area; circle: the circle it lies on, if any.
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
