"""From a scene to a distributed mesh."""

import logging
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.errors import SceneError
from porolub.mesh import plex
from porolub.mesh.cell import CELLS, Cell
from porolub.mesh.gmsh_file import write_msh
from porolub.mesh.grading import graded_ticks, uniform_ticks
from porolub.mesh.grid import grid
from porolub.mesh.mesh import Mesh, connectivity, strata_with_nodes
from porolub.mesh.raw import RawMesh, check_boundaries
from porolub.mesh.shape import Shape, shape_from_scene

Array = NDArray[np.float64]
log = logging.getLogger(__name__)


def build_mesh(
    scene: Any,
    comm: MPI.Comm | PETSc.Comm,
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
    `edge_band` are in that mesh unit.

    along, across, degree: in place of the scene's values
    edges: arc positions along the lubricated surface (0 in its middle) to refine toward, to
        elements of `edge_size` within `edge_band` of them
    surface_ratio: size across the layer of the element at the surface over that at the bone

    Raises SceneError for a shape, element or file that cannot be meshed.
    """
    comm = comm.tompi4py() if isinstance(comm, PETSc.Comm) else comm
    degree = scene.mesh.degree if degree is None else degree
    shape, ticks = None, ()
    if scene.geometry.shape != "file":
        shape = shape_from_scene(scene, length_scale)
        counts = (along or scene.mesh.along, across or scene.mesh.across)
        line = uniform_ticks(counts[0])
        if edges and edge_size:
            arc = graded_ticks(shape.length, counts[0], edges, edge_size, edge_band)
            line = arc / shape.length + 0.5
        ticks = (line, uniform_ticks(counts[1], surface_ratio))
        if shape.dim == 3:
            ticks += (uniform_ticks(scene.mesh.deep),)
    raw, problem = None, None
    if comm.rank == 0:
        try:
            raw = _raw_mesh(scene, shape, ticks, length_scale)
        except SceneError as error:
            problem = str(error)
    problem = comm.bcast(problem)
    if problem is not None:
        raise SceneError(problem)
    return _distributed(raw, comm, degree, shape, ticks)


def _raw_mesh(
    scene: Any, shape: Shape | None, ticks: Sequence[Array], length_scale: float
) -> RawMesh:
    raw = grid(shape, ticks, triangles=scene.mesh.element == "triangle")
    check_boundaries(raw)
    return raw


def _distributed(
    raw: RawMesh | None,
    comm: MPI.Comm,
    degree: int,
    shape: Shape | None,
    ticks: tuple[Array, ...],
) -> Mesh:
    """Hand the mesh of rank 0 to DMPlex, distribute it and number its nodes."""
    about = None if raw is None else (raw.cell.name, tuple(raw.boundaries))
    cell_name, names = comm.bcast(about)
    cell = CELLS[cell_name]
    with tempfile.TemporaryDirectory(prefix="porolub-") as folder:
        path = Path(folder) / "mesh.msh"
        if raw is not None:
            write_msh(raw, path)
        dm = plex.read(str(path), comm)
    npoints = dm.getChart()[1]
    natural = np.full(npoints, -1, dtype=np.int64)
    count = 0
    for first, last in strata_with_nodes(dm, cell, degree):
        natural[first:last] = np.arange(count, count + last - first)
        count += last - first
    first, last = dm.getHeightStratum(0)
    natural_cell = np.full(npoints, -1, dtype=np.int64)
    natural_cell[first:last] = np.arange(last - first)

    sf = plex.distribute(dm, strips=shape is not None)
    npoints = dm.getChart()[1]
    natural = plex.from_original(sf, natural, npoints)
    first, last = dm.getHeightStratum(0)
    natural_cell = plex.from_original(sf, natural_cell, npoints)[first:last]
    if sf is not None:
        sf.destroy()

    strata = strata_with_nodes(dm, cell, degree)
    node_point = np.concatenate([np.arange(*stratum) for stratum in strata])
    point_node = np.full(npoints, -1, dtype=np.int64)
    point_node[node_point] = np.arange(len(node_point))
    cell_points, cell_faces = connectivity(dm, cell, degree)
    cells = point_node[cell_points]
    nvertices = strata[0][1] - strata[0][0]

    owned_point = np.ones(npoints, dtype=bool)
    owned_point[plex.ghosts(dm)] = False
    owned = owned_point[node_point]
    offset = comm.exscan(int(owned.sum())) or 0
    number = np.full(npoints, -1, dtype=np.int64)
    number[node_point[owned]] = offset + np.arange(int(owned.sum()))
    number = plex.from_owners(dm, number)

    vertices = dm.getCoordinatesLocal().array.reshape(-1, cell.dim)
    return Mesh(
        dm=dm,
        comm=comm,
        degree=degree,
        cell=cell,
        cells=cells,
        nvertices=nvertices,
        node_point=node_point,
        point_node=point_node,
        coordinates=_positions(vertices, cells, len(node_point), cell, shape, ticks, degree),
        owned=owned,
        global_node=number[node_point],
        natural_node=natural[node_point],
        natural_cell=natural_cell,
        cell_faces=cell_faces,
        boundary_names=names,
        shape=shape,
        vertex_ticks=ticks,
    )


def _positions(
    vertices: Array,
    cells: NDArray[np.int64],
    nnode: int,
    cell: Cell,
    shape: Shape | None,
    ticks: Sequence[Array],
    degree: int,
) -> Array:
    """Positions of all local nodes; on a shape they are middles in logical coordinates."""
    places = np.empty((nnode, cell.dim))
    places[: len(vertices)] = vertices
    if shape is not None:
        logical = shape.logical(vertices)
        for axis, line in enumerate(ticks):
            # exact ticks in place of the inverse map's rounding
            between = (line[1:] + line[:-1]) / 2
            logical[:, axis] = line[np.searchsorted(between, logical[:, axis])]
        places[: len(vertices)] = logical
    if degree == 2:
        column = cell.vertices
        for parents in cell.parents():
            middle = places[cells[:, parents]].mean(axis=2)
            nodes = cells[:, column : column + len(parents)]
            places[nodes.ravel()] = middle.reshape(-1, cell.dim)
            column += len(parents)
    return shape.physical(places) if shape is not None else places
