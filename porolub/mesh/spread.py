"""From a mesh that rank 0 holds (a user's file) to one that is spread over the ranks.

Rank 0 numbers everything, tells each rank its share and forgets the rest: arrays of the whole
mesh exist there, and only while the mesh is set up.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.mesh.cell import CELLS
from porolub.mesh.mesh import Boundary, Facets, Mesh
from porolub.mesh.partition import partition
from porolub.mesh.raw import RawMesh
from porolub.mesh.whole import Whole, whole

Index = NDArray[np.int64]
SURFACE = "lubricated"
"""The boundary of a file that film and contact work on."""


def spread(raw: RawMesh | None, comm: MPI.Intracomm, degree: int) -> Mesh:
    """Distribute the mesh `raw` (None except on rank 0) without overlap. Collective."""
    full = None if raw is None else whole(raw, degree)
    part = partition(full, SURFACE, comm)
    if full is None:
        share = comm.recv(source=0)
    else:
        shares = _shares(full, part, comm.size)
        share = next(shares)
        for rank, other in enumerate(shares, start=1):  # one at a time: no second copy of all
            comm.send(other, dest=rank)
    return _mesh(comm, degree, **share)


def _shares(full: Whole, part: Index, ranks: int) -> Iterator[dict[str, Any]]:
    """What each rank is told. Nodes belong to the lowest rank that has one of their cells."""
    owner = np.full(len(full.places), ranks, dtype=np.int64)
    np.minimum.at(owner, full.nodes, part[:, None])
    number = np.empty_like(owner)
    number[np.argsort(owner, kind="stable")] = np.arange(len(owner))
    of_faces = full.raw.cell.face_nodes(1 if full.nodes.shape[1] == full.raw.cell.vertices else 2)
    nodes_of = {}
    for name, (at, face) in ((name, rows.T) for name, rows in full.facets.items()):
        nodes_of[name] = np.unique(full.nodes[at[:, None], of_faces[face]])
    local_cell = np.empty(len(part), dtype=np.int64)
    for rank in range(ranks):
        mine = np.flatnonzero(part == rank)
        nodes, cells = np.unique(full.nodes[mine], return_inverse=True)
        cells = cells.reshape(len(mine), full.nodes.shape[1])
        local_cell[mine] = np.arange(len(mine))
        boundaries = {}
        for name, rows in full.facets.items():
            at, face = rows[part[rows[:, 0]] == rank].T
            at = local_cell[at]
            facets = Facets(at, face, cells[at[:, None], of_faces[face]])
            on = np.isin(nodes, nodes_of[name], assume_unique=True)
            boundaries[name] = Boundary(facets, np.flatnonzero(on))
        yield {
            "cell": full.raw.cell.name,
            "cells": cells,
            "nvertices": int(np.searchsorted(nodes, len(full.raw.points))),
            "coordinates": full.places[nodes],
            "owned": owner[nodes] == rank,
            "global_node": number[nodes],
            "natural_node": nodes,
            "natural_cell": mine,
            "boundaries": boundaries,
        }


def _mesh(comm: MPI.Intracomm, degree: int, cell: str, **arrays: Any) -> Mesh:
    return Mesh(comm=comm, degree=degree, cell=CELLS[cell], **arrays)
