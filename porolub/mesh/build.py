"""From a scene to a distributed mesh."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.errors import SceneError
from porolub.mesh.cell import TRIANGLE
from porolub.mesh.grading import graded_ticks, uniform_ticks
from porolub.mesh.mesh import Mesh
from porolub.mesh.raw import RawMesh, check_boundaries
from porolub.mesh.read import read_mesh
from porolub.mesh.shape import Shape, shape_from_scene
from porolub.mesh.spread import spread
from porolub.mesh.structured import structured

Array = NDArray[np.float64]
STANDARD = ("lubricated", "bone", "inlet", "outlet")
"""Boundaries that film and contact need in a mesh file."""
FEWEST = 4  # elements along the surface of a coarsened mesh


def build_mesh(
    scene: Any,
    comm: MPI.Intracomm | PETSc.Comm,
    *,
    length_scale: float = 1.0,
    along: int | None = None,
    across: int | None = None,
    deep: int | None = None,
    edges: Sequence[float] | None = None,
    edge_size: float | None = None,
    edge_band: float = 0.0,
    surface_ratio: float = 1.0,
    degree: int | None = None,
) -> Mesh:
    """Build the scene's mesh, distributed over the ranks. Collective.

    Of a structured shape each rank builds its own part; a file is read on rank 0.

    Lengths of the scene (m) are divided by `length_scale`; `edges`, `edge_size` and
    `edge_band` are in that mesh unit. All keywords but `length_scale` and `degree` are for
    structured shapes; a mesh file is taken as it is.

    along, across, deep, degree: in place of the scene's values
    edges: arc positions along the lubricated surface (0 in its middle) to refine toward, to
        elements of `edge_size` within `edge_band` of them
    surface_ratio: size across the layer of the element at the surface over that at the bone

    Raises SceneError, on all ranks, for a shape, element or file that cannot be meshed.
    """
    comm = comm.tompi4py() if isinstance(comm, PETSc.Comm) else comm
    degree = scene.mesh.degree if degree is None else degree
    if scene.geometry.shape == "file":
        return spread(_from_rank_0(comm, lambda: _file_mesh(scene, length_scale)), comm, degree)
    shape = shape_from_scene(scene, length_scale)
    triangles = scene.mesh.element == "triangle"
    if triangles and shape.dim == 3:
        raise SceneError(
            'mesh.element = "triangle" does not fit scene.dimension = 3; allowed there: quad.'
        )
    counts = along or scene.mesh.along, across or scene.mesh.across, deep or scene.mesh.deep
    near = () if edges is None else tuple(edges)
    ticks: tuple[Array, ...] | None = None
    if comm.rank == 0:  # to the last bit the same on all ranks; warnings are logged once
        ticks = _ticks(shape, counts, near, edge_size, edge_band, surface_ratio)
    ticks = comm.bcast(ticks)
    assert ticks is not None
    return structured(shape, ticks, comm, degree, triangles=triangles)


def coarsened(mesh: Mesh, times: int, comm: MPI.Intracomm) -> Mesh | None:
    """A structured mesh with every other line of vertices left out, so many times. Collective.

    None for a mesh from a file and where less than FEWEST elements along the surface are left.
    """
    ticks = mesh.vertex_ticks
    for _ in range(times):
        ticks = tuple(np.append(line[:-1:2], line[-1]) for line in ticks)
    if mesh.shape is None or len(ticks[0]) <= FEWEST:
        return None
    return structured(mesh.shape, ticks, comm, mesh.degree, triangles=mesh.cell is TRIANGLE)


def _from_rank_0(comm: MPI.Intracomm, make: Callable[[], RawMesh]) -> RawMesh | None:
    """What rank 0 makes, None elsewhere; its SceneError is raised on all ranks."""
    made: RawMesh | None = None
    problem: SceneError | None = None
    if comm.rank == 0:
        try:
            made = make()
        except SceneError as error:
            problem = error
    problem = comm.bcast(problem)
    if problem is not None:
        raise problem
    return made


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


def _file_mesh(scene: Any, length_scale: float) -> RawMesh:
    required = set(getattr(scene, "boundary", ()))
    if getattr(scene, "film", None) or getattr(scene, "contact", None) or not required:
        required.update(STANDARD)
    raw = read_mesh(Path(scene.geometry.path), scene.scene.dimension, length_scale, required)
    check_boundaries(raw)
    return raw
