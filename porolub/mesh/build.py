"""From a scene to a distributed mesh."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.errors import SceneError
from porolub.mesh.distribute import distributed
from porolub.mesh.grading import graded_ticks, uniform_ticks
from porolub.mesh.grid import grid
from porolub.mesh.mesh import Mesh
from porolub.mesh.raw import RawMesh, check_boundaries
from porolub.mesh.read import read_mesh
from porolub.mesh.shape import Shape, shape_from_scene

Array = NDArray[np.float64]
STANDARD = ("lubricated", "bone", "inlet", "outlet")
"""Boundaries that film and contact need in a mesh file."""


def build_mesh(
    scene: Any,
    comm: MPI.Intracomm | PETSc.Comm,
    *,
    length_scale: float = 1.0,
    along: int | None = None,
    across: int | None = None,
    edges: Sequence[float] | None = None,
    edge_size: float | None = None,
    edge_band: float = 0.0,
    surface_ratio: float = 1.0,
    degree: int | None = None,
) -> Mesh:
    """Build the scene's mesh on rank 0 through gmsh and distribute it. Collective.

    Lengths of the scene (m) are divided by `length_scale`; `edges`, `edge_size` and
    `edge_band` are in that mesh unit. All keywords but `length_scale` and `degree` are for
    structured shapes; a mesh file is taken as it is.

    along, across, degree: in place of the scene's values
    edges: arc positions along the lubricated surface (0 in its middle) to refine toward, to
        elements of `edge_size` within `edge_band` of them
    surface_ratio: size across the layer of the element at the surface over that at the bone

    Raises SceneError, on all ranks, for a shape, element or file that cannot be meshed.
    """
    comm = comm.tompi4py() if isinstance(comm, PETSc.Comm) else comm
    degree = scene.mesh.degree if degree is None else degree
    shape = None
    if scene.geometry.shape != "file":
        shape = shape_from_scene(scene, length_scale)
    raw: RawMesh | None = None
    result: tuple[Array, ...] | SceneError = ()
    if comm.rank == 0:
        try:
            ticks: tuple[Array, ...] = ()
            if shape is not None:
                counts = along or scene.mesh.along, across or scene.mesh.across, scene.mesh.deep
                near = () if edges is None else tuple(edges)
                ticks = _ticks(shape, counts, near, edge_size, edge_band, surface_ratio)
            raw = _raw_mesh(scene, shape, ticks, length_scale)
            result = ticks
        except SceneError as error:
            result = error
    result = comm.bcast(result)
    if isinstance(result, SceneError):
        raise result
    return distributed(raw, comm, degree, shape, result)


def _ticks(
    shape: Shape,
    counts: tuple[int, int, int],
    edges: Sequence[float],
    edge_size: float | None,
    edge_band: float,
    surface_ratio: float,
) -> tuple[Array, ...]:
    """Logical positions of the vertices along each axis."""
    line = uniform_ticks(counts[0])
    if edges and edge_size is not None:
        arc = graded_ticks(shape.length, counts[0], edges, edge_size, edge_band)
        line = arc / shape.length + 0.5
    ticks = (line, uniform_ticks(counts[1], surface_ratio))
    return ticks if shape.dim == 2 else (*ticks, uniform_ticks(counts[2]))


def _raw_mesh(
    scene: Any, shape: Shape | None, ticks: Sequence[Array], length_scale: float
) -> RawMesh:
    if shape is not None:
        triangles = scene.mesh.element == "triangle"
        if triangles and shape.dim == 3:
            raise SceneError(
                'mesh.element = "triangle" does not fit scene.dimension = 3; allowed there: quad.'
            )
        return grid(shape, ticks, triangles=triangles)
    required = set(getattr(scene, "boundary", ()))
    if getattr(scene, "film", None) or getattr(scene, "contact", None) or not required:
        required.update(STANDARD)
    raw = read_mesh(Path(scene.geometry.path), scene.scene.dimension, length_scale, required)
    check_boundaries(raw)
    return raw
