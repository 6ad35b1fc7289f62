"""All nodes of a mesh that one rank holds: numbers and places, from its vertices and cells."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.mesh.nodes import add_middles
from porolub.mesh.raw import RawMesh, distinct_rows, face_keys, match_rows

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class Whole:
    """A mesh with all its nodes: vertices first, then middles of edges, of faces, centres.

    raw: what it was made from; nodes: (ncell, nodes per cell); places: (nnode, dim)
    facets: name -> (nf, 2): cell and number of the face in the cell
    neighbours: (k, 2) cells that share a face
    """

    raw: RawMesh
    nodes: Index
    places: Array
    facets: dict[str, Index]
    neighbours: Index


def whole(raw: RawMesh, degree: int) -> Whole:
    """Number the nodes of degree 1 or 2 and find the boundaries' facets among the cells' faces.

    The boundaries consist of outer faces of the cells (see raw.check_boundaries).
    """
    cell, count = raw.cell, len(raw.points)
    columns = [raw.cells]
    keys_of = []
    for parents in cell.parents() if degree == 2 else ():
        keys = face_keys(raw.cells[:, parents].reshape(-1, parents.shape[1]))
        table, place = distinct_rows(keys)
        columns.append(count + place.reshape(-1, len(parents)))
        keys_of.append((count, table))
        count += len(table)
    nodes = np.hstack(columns)
    places = np.empty((count, cell.dim))
    places[: len(raw.points)] = raw.points
    if degree == 2:
        add_middles(places, nodes, cell)
        for (start, table), (known, positions) in zip(keys_of, raw.middle, strict=False):
            places[start : start + len(table)] = positions[match_rows(known, table)]
    facets, neighbours = _faces(raw)
    return Whole(raw, nodes, places, facets, neighbours)


def _faces(raw: RawMesh) -> tuple[dict[str, Index], Index]:
    per_cell = len(raw.cell.faces)
    faces = raw.cells[:, np.array(raw.cell.faces)].reshape(len(raw.cells) * per_cell, -1)
    table, place = distinct_rows(face_keys(faces))
    order = np.argsort(place, kind="stable")
    ordered = place[order]
    first = np.searchsorted(ordered, np.arange(len(table)))
    facets = {}
    for name, rows in raw.boundaries.items():
        found = order[first[match_rows(table, face_keys(rows))]]
        facets[name] = np.stack(np.divmod(found, per_cell), axis=1)
    twice = np.flatnonzero(ordered[1:] == ordered[:-1])
    neighbours = np.stack([order[twice], order[twice + 1]], axis=1) // per_cell
    return facets, neighbours
