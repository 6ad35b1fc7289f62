"""Which rank gets which cells of a mesh from a file: even in cells and on the lubricated surface.

PT-Scotch's parts have equally many cells and short interfaces, but know nothing of the surface.
Where that leaves a rank with much more of the surface than its share, the cells go out in
columns instead: each with the surface facet nearest to it, the facets in equal parts.
"""

import logging

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.sparse import coo_array
from scipy.spatial import cKDTree

from porolub.mesh.whole import Whole

Array = NDArray[np.float64]
Index = NDArray[np.int64]
SURFACE_EXCESS = 1.3  # facets of the fullest rank over the mean beyond which columns are tried
CELL_EXCESS = 1.1  # cells of the fullest rank over the mean that columns may have

log = logging.getLogger(__name__)


def excess(part: Index, ranks: int) -> float:
    """Members of the fullest of the parts 0 ... ranks - 1 over their mean; 1 if there are none."""
    return float(np.bincount(part, minlength=ranks).max() * ranks / max(len(part), 1)) or 1.0


def partition(mesh: Whole | None, surface: str, comm: MPI.Intracomm) -> Index:
    """Rank (ncell,) of each cell of the mesh of rank 0 (None elsewhere; none there). Collective.

    surface: the boundary to spread evenly, if the mesh has it.
    """
    if comm.size == 1:
        return np.zeros(0 if mesh is None else len(mesh.raw.cells), dtype=np.int64)
    by_graph = _graph_parts(mesh, comm)
    if mesh is None or surface not in mesh.facets:
        return by_graph
    facets = mesh.facets[surface][:, 0]
    uneven = excess(by_graph[facets], comm.size)
    if uneven <= SURFACE_EXCESS:
        return by_graph
    by_column = column_parts(mesh, surface, comm.size)
    cells, even = excess(by_column, comm.size), excess(by_column[facets], comm.size)
    log.debug(
        "surface facets over their mean: %.2f by graph, %.2f by columns, which have %.2f in cells",
        *(uneven, even, cells),
    )
    return by_column if even < uneven and cells <= CELL_EXCESS else by_graph


def _graph_parts(mesh: Whole | None, comm: MPI.Intracomm) -> Index:
    """Parts (ncell,) by PT-Scotch from the graph of cells that share faces."""
    count = comm.bcast(None if mesh is None else len(mesh.raw.cells))
    mine = count if mesh is not None else 0
    pairs = np.zeros((0, 2), np.int64) if mesh is None else mesh.neighbours
    both = np.vstack([pairs, pairs[:, ::-1]])
    graph = coo_array((np.ones(len(both)), both.T), shape=(mine, max(count, 1))).tocsr()
    csr = (graph.indptr.astype(PETSc.IntType), graph.indices.astype(PETSc.IntType), graph.data)
    mat = PETSc.Mat().createAIJ(((mine, count), (mine, count)), csr=csr, comm=comm)
    tool, found = PETSc.MatPartitioning().create(comm), PETSc.IS()
    tool.setAdjacency(mat)
    tool.setType("ptscotch")
    tool.apply(found)
    part = np.array(found.getIndices(), dtype=np.int64)
    for used in (found, tool, mat):
        used.destroy()
    return part


def column_parts(mesh: Whole, surface: str, ranks: int) -> Index:
    """Parts (ncell,): each cell goes with the facet of the surface nearest to its centre."""
    corners = mesh.raw.points[mesh.raw.cells]
    at, face = mesh.facets[surface].T
    of_faces = np.array(mesh.raw.cell.faces)
    centres = mesh.raw.points[mesh.raw.cells[at[:, None], of_faces[face]]].mean(axis=1)
    nearest = cKDTree(centres).query(corners.mean(axis=1))[1]
    nearest[at] = np.arange(len(at))
    load = np.bincount(nearest, minlength=len(centres)).astype(float)
    part = np.zeros(len(centres), dtype=np.int64)
    _bisect(centres, load / load.mean() + 1.0, np.arange(len(centres)), 0, ranks, part)
    return part[nearest]


def _bisect(places: Array, load: Array, rows: Index, first: int, ranks: int, part: Index) -> None:
    """Recursive coordinate bisection of `rows` over the ranks from `first` on, into `part`."""
    if ranks == 1 or len(rows) == 0:
        part[rows] = first
        return
    axis = int(np.ptp(places[rows], axis=0).argmax())
    rows = rows[np.argsort(places[rows, axis], kind="stable")]
    below = ranks // 2
    so_far = np.cumsum(load[rows]) - load[rows] / 2
    cut = int(np.searchsorted(so_far, so_far[-1] * below / ranks))
    _bisect(places, load, rows[:cut], first, below, part)
    _bisect(places, load, rows[cut:], first + below, ranks - below, part)
