"""From a mesh that rank 0 holds (a user's file) to one that is spread over the ranks.

A DMPlex finds the edges and faces, spreads the cells and knows whose its points are; when the
arrays of the mesh are made it is forgotten. Rank 0 has the whole mesh only until it is spread.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.mesh import plex
from porolub.mesh.cell import CELLS, Cell
from porolub.mesh.mesh import Boundary, Facets, Mesh
from porolub.mesh.nodes import add_middles
from porolub.mesh.partition import partition
from porolub.mesh.raw import RawMesh
from porolub.mesh.topology import Topology
from porolub.mesh.whole import numbered, whole

Array = NDArray[np.float64]
Index = NDArray[np.int64]
SURFACE = "lubricated"
"""The boundary of a file that film and contact work on."""


def spread(raw: RawMesh | None, comm: MPI.Intracomm, degree: int) -> Mesh:
    """Distribute the mesh `raw` (None except on rank 0) without overlap. Collective."""
    about = None
    if raw is not None:
        about = raw.cell.name, tuple(raw.boundaries), bool(raw.middle) and degree == 2
    name, names, curved = comm.bcast(about)
    cell = CELLS[name]
    dm = plex.from_cells(raw, cell, comm)
    points = _distributed(dm, comm, raw, cell, degree, curved)
    mesh = _mesh(dm, comm, Topology.of(dm, cell), degree, names, points)
    dm.destroy()
    return mesh


@dataclass(frozen=True)
class _Points:
    """What rank 0 knew of the points (npoints,) of a rank: natural numbers of nodes and, where
    they are cells, of cells; positions (npoints, dim) of the nodes of a curved mesh."""

    node: Index
    cell: Index
    places: Array | None


def _distributed(
    dm: PETSc.DMPlex,
    comm: MPI.Intracomm,
    raw: RawMesh | None,
    cell: Cell,
    degree: int,
    curved: bool,
) -> _Points:
    """Give each rank its part of the DMPlex that rank 0 holds, its boundaries marked."""
    full, sides = None, []
    number, places = np.zeros(0, dtype=np.int64), np.zeros((0, cell.dim)) if curved else None
    if raw is not None:
        topology = Topology.of(dm, cell)
        full = whole(raw, topology)
        number, places = numbered(raw, topology, degree)
        sides = [topology.faces[at, face] for at, face in map(np.transpose, full.facets.values())]
        del topology
    plex.mark(dm, sides)
    part = partition(full, SURFACE, comm)
    del full
    point = np.arange(len(number))  # cells are the first points, as they were read
    forest, count = plex.distribute(dm, part), dm.getChart()[1]
    found = _Points(
        plex.from_original(forest, number, count),
        plex.from_original(forest, point, count),
        None if places is None else plex.from_original(forest, places, count),
    )
    if forest is not None:
        forest.destroy()
    return found


def _mesh(
    dm: PETSc.DMPlex,
    comm: MPI.Intracomm,
    topology: Topology,
    degree: int,
    names: Sequence[str],
    known: _Points,
) -> Mesh:
    """Arrays of this rank's part, its nodes and cells in the order of their natural numbers."""
    cell = topology.cell
    at = np.concatenate([topology.points(dim) for dim in topology.with_nodes(degree)])
    at = at[np.argsort(known.node[at])]
    node = np.full(len(known.node), -1, dtype=np.int64)
    node[at] = np.arange(len(at))
    natural_cell = known.cell[topology.points(cell.dim)]
    order = np.argsort(natural_cell)
    cells = node[topology.nodes(degree)[order]]
    if known.places is None:
        places = np.empty((len(at), cell.dim))
        vertices = node[slice(*topology.strata[0])]
        places[vertices] = dm.getCoordinatesLocal().array.reshape(-1, cell.dim)
        if degree == 2:
            add_middles(places, cells, cell)
    else:
        places = known.places[at]
    owned = plex.owned(dm)[at]
    return Mesh(
        comm=comm,
        degree=degree,
        cell=cell,
        cells=cells,
        nvertices=int(np.diff(topology.strata[0])[0]),
        coordinates=places,
        owned=owned,
        global_node=_global_numbers(dm, comm, at, owned),
        natural_node=known.node[at],
        natural_cell=natural_cell[order],
        boundaries=_boundaries(
            dm, topology.faces[order], cells, cell.face_nodes(degree), at, names
        ),
    )


def _global_numbers(
    dm: PETSc.DMPlex, comm: MPI.Intracomm, at: Index, owned: NDArray[np.bool_]
) -> Index:
    """Numbers (nnode,) of the nodes at the points `at` over all ranks, each owner's contiguous."""
    mine = int(owned.sum())
    start = comm.scan(mine) - mine
    number = np.full(dm.getChart()[1], -1, dtype=np.int64)
    number[at[owned]] = start + np.arange(mine)
    return plex.from_owners(dm, number)[at]


def _boundaries(
    dm: PETSc.DMPlex, faces: Index, cells: Index, of_faces: Index, at: Index, names: Sequence[str]
) -> dict[str, Boundary]:
    """The marked faces of the cells, and the nodes of the boundaries on this rank."""
    side, found = plex.marks(dm, len(names))[faces], {}
    for value, name in enumerate(names, start=1):
        mine, local = np.nonzero(side == value)
        facets = Facets(mine, local, cells[mine[:, None], of_faces[local]])
        on = np.zeros(dm.getChart()[1], dtype=np.int64)
        on[at[facets.nodes]] = 1
        found[name] = Boundary(facets, np.flatnonzero(plex.largest_of_all(dm, on)[at]))
    return found
