"""A mesh that rank 0 holds whole, before it is spread: neighbours, boundaries, node numbers."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.mesh.raw import RawMesh, face_keys, match_rows
from porolub.mesh.topology import Topology

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class Whole:
    """Cells of a whole mesh: what was read, which of them meet, which are on a boundary.

    raw: what it was made from; facets: name -> (nf, 2): cell and number of the face in the cell
    neighbours: (k, 2) cells that share a face
    """

    raw: RawMesh
    facets: dict[str, Index]
    neighbours: Index


def whole(raw: RawMesh, topology: Topology) -> Whole:
    """Find the boundaries' facets and the cells that meet, from the points of all cells.

    The boundaries consist of outer faces of the cells (see raw.check_boundaries).
    """
    first, last = topology.strata[raw.cell.dim - 1]
    faces = topology.faces.ravel()
    order = np.argsort(faces, kind="stable")
    ordered = faces[order]
    start = np.searchsorted(ordered, np.arange(first, last + 1))
    outer = np.flatnonzero(np.diff(start) == 1)
    corners = topology.corners(raw.cell.dim - 1)[outer] - topology.strata[0][0]
    facets = {}
    for name, rows in raw.boundaries.items():
        found = order[start[outer[match_rows(corners, face_keys(rows))]]]
        facets[name] = np.stack(np.divmod(found, len(raw.cell.faces)), axis=1)
    twice = np.flatnonzero(ordered[1:] == ordered[:-1])
    neighbours = np.stack([order[twice], order[twice + 1]], axis=1) // len(raw.cell.faces)
    return Whole(raw, facets, neighbours)


def numbered(raw: RawMesh, topology: Topology, degree: int) -> tuple[Index, Array | None]:
    """Natural numbers (npoints,) of the nodes, -1 at points without one, and their positions
    (npoints, dim) if the mesh gives them between vertices.

    Vertices come first, as they were read, then edges, faces, cells, each kind in the order of
    its sorted vertices: the mesh's own numbers, whatever PETSc's are.
    """
    npoints = max(last for _, last in topology.strata)
    number = np.full(npoints, -1, dtype=np.int64)
    first, last = topology.strata[0]
    number[first:last] = np.arange(last - first)
    places = np.empty((npoints, raw.cell.dim)) if raw.middle and degree == 2 else None
    if places is not None:
        places[first:last] = raw.points
    count = last - first
    for kind, dim in enumerate(topology.with_nodes(degree)[1:]):
        start, end = topology.strata[dim]
        rows = face_keys(raw.cells) if dim == raw.cell.dim else topology.corners(dim) - first
        order = np.lexsort(rows.T[::-1])
        number[start + order] = count + np.arange(len(order))
        if places is not None:
            known, positions = raw.middle[kind]
            places[start:end] = positions[match_rows(known, rows)]
        count += end - start
    return number, places
