"""From a scene to a distributed mesh."""

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
from porolub.mesh.cell import CELLS
from porolub.mesh.gmsh_file import write_msh
from porolub.mesh.grading import graded_ticks, uniform_ticks
from porolub.mesh.grid import grid
from porolub.mesh.mesh import Mesh, connectivity, strata_with_nodes
from porolub.mesh.nodes import curved_points, shape_positions, straight_positions
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
    shape: Shape | None = None
    ticks: tuple[Array, ...] = ()
    if scene.geometry.shape != "file":
        shape = shape_from_scene(scene, length_scale)
        count = along or scene.mesh.along
        line = uniform_ticks(count)
        if edges and edge_size:
            arc = graded_ticks(shape.length, count, edges, edge_size, edge_band)
            line = arc / shape.length + 0.5
        ticks = (line, uniform_ticks(across or scene.mesh.across, surface_ratio))
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


def _distributed(
    raw: RawMesh | None,
    comm: MPI.Intracomm,
    degree: int,
    shape: Shape | None,
    ticks: tuple[Array, ...],
) -> Mesh:
    """Hand the mesh of rank 0 to DMPlex, distribute it and number its nodes."""
    about = None if raw is None else (raw.cell.name, tuple(raw.boundaries), bool(raw.middle))
    cell_name, names, curved = comm.bcast(about)
    cell = CELLS[cell_name]
    with tempfile.TemporaryDirectory(prefix="porolub-") as folder:
        path = Path(folder) / "mesh.msh"
        if raw is not None:
            write_msh(raw, path)
        dm = plex.read(str(path), comm)

    # what is known per point before the points are spread over the ranks
    npoints = dm.getChart()[1]
    natural, count = np.full(npoints, -1, dtype=np.int64), 0
    for first, last in strata_with_nodes(dm, cell, degree):
        natural[first:last] = np.arange(count, count + last - first)
        count += last - first
    first, last = dm.getHeightStratum(0)
    natural_cell = np.full(npoints, -1, dtype=np.int64)
    natural_cell[first:last] = np.arange(last - first)
    bent = np.empty((0, cell.dim))
    if curved and degree == 2 and raw is not None:
        bent = curved_points(dm, raw)

    sf = plex.distribute(dm, strips=shape is not None)
    npoints = dm.getChart()[1]
    natural = plex.from_original(sf, natural, npoints)
    first, last = dm.getHeightStratum(0)
    natural_cell = plex.from_original(sf, natural_cell, npoints)[first:last]
    if curved and degree == 2:
        bent = plex.from_original(sf, bent, npoints)
    if sf is not None:
        sf.destroy()

    strata = strata_with_nodes(dm, cell, degree)
    node_point = np.concatenate([np.arange(*stratum) for stratum in strata])
    point_node = np.full(npoints, -1, dtype=np.int64)
    point_node[node_point] = np.arange(len(node_point))
    cell_points, cell_faces = connectivity(dm, cell, degree)
    cells = point_node[cell_points]

    owned_point = np.ones(npoints, dtype=bool)
    owned_point[plex.ghosts(dm)] = False
    owned = owned_point[node_point]
    mine = int(owned.sum())
    number = np.full(npoints, -1, dtype=np.int64)
    number[node_point[owned]] = comm.scan(mine) - mine + np.arange(mine)
    number = plex.from_owners(dm, number)

    vertices = dm.getCoordinatesLocal().array.reshape(-1, cell.dim)
    if shape is not None:
        positions = shape_positions(shape, ticks, vertices, len(node_point), cells, cell)
    else:
        positions = straight_positions(vertices, len(node_point), cells, cell)
        if curved and degree == 2:
            known = ~np.isnan(bent[node_point, 0])
            positions[known] = bent[node_point[known]]
    return Mesh(
        dm=dm,
        comm=comm,
        degree=degree,
        cell=cell,
        cells=cells,
        nvertices=len(vertices),
        node_point=node_point,
        point_node=point_node,
        coordinates=positions,
        owned=owned,
        global_node=number[node_point],
        natural_node=natural[node_point],
        natural_cell=natural_cell,
        cell_faces=cell_faces,
        boundary_names=names,
        shape=shape,
        vertex_ticks=ticks,
    )
