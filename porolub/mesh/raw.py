"""A mesh as plain arrays on one rank, before it is distributed."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.mesh.cell import Cell

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class RawMesh:
    """Vertices, cells, named boundary facets.

    points: (n, dim) vertex positions in mesh units
    cells: (ncell, vertices per cell) vertex numbers
    boundaries: name -> (nf, vertices per facet) vertex numbers
    middle: positions of second-order nodes, one (k, m) array of sorted vertex numbers and one
        (k, dim) array of positions for each kind (m = 2: edges, ...); empty if straight
    """

    cell: Cell
    points: Array
    cells: Index
    boundaries: dict[str, Index]
    middle: tuple[tuple[Index, Array], ...] = ()


def signed_sizes(cell: Cell, points: Array, cells: Index) -> Array:
    """Orientation measure of each cell (ncell,): negative for cells turned inside out."""
    corner = points[cells]
    if cell.name == "quad":
        a, b = corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]
        return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    if cell.name == "triangle":
        a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
        return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    ends = (1, 2, 3) if cell.name == "tet" else (1, 3, 4)
    a, b, c = (corner[:, end] - corner[:, 0] for end in ends)
    return np.asarray(np.einsum("ij,ij->i", np.cross(a, b), c))


def oriented(raw: RawMesh) -> RawMesh:
    """The same mesh with every cell listed so that its Jacobian is positive.

    Raises SceneError if a cell has no size.
    """
    sizes = signed_sizes(raw.cell, raw.points, raw.cells)
    if np.any(sizes == 0):
        where = raw.points[raw.cells[np.argmin(np.abs(sizes))]].mean(axis=0)
        raise SceneError(f"the mesh has a cell of zero size near {where.tolist()} (mesh units).")
    cells = raw.cells.copy()
    turned = sizes < 0
    cells[turned] = cells[turned][:, list(raw.cell.mirror)]
    return replace(raw, cells=cells)


def face_keys(facets: Index) -> Index:
    """Facets as rows of sorted vertex numbers, so that equal facets have equal rows."""
    return np.sort(np.asarray(facets, dtype=np.int64), axis=1)


def distinct_rows(rows: Index) -> tuple[Index, Index]:
    """The distinct rows, sorted, and the place of each row among them."""
    if not len(rows):
        return rows, np.zeros(0, dtype=np.int64)
    order = np.lexsort(rows.T[::-1])
    ordered = rows[order]
    new = np.concatenate([[True], (ordered[1:] != ordered[:-1]).any(axis=1)])
    place = np.empty(len(rows), dtype=np.int64)
    place[order] = np.cumsum(new) - 1
    return ordered[new], place


def match_rows(table: Index, rows: Index) -> Index:
    """Position in `table` (distinct rows) of each row of `rows`; -1 where it is not there."""
    both, inverse = distinct_rows(np.vstack([table, rows]))
    place = np.full(len(both), -1, dtype=np.int64)
    place[inverse[: len(table)]] = np.arange(len(table))
    return place[inverse[len(table) :]]


def check_boundaries(raw: RawMesh) -> None:
    """Raises SceneError unless cells that share the corners of a face share the face, and every
    boundary facet is outside and in one boundary only."""
    faces = np.vstack([raw.cells[:, list(face)] for face in raw.cell.faces])
    distinct, place = distinct_rows(face_keys(faces))
    if faces.shape[1] == 4:
        _check_diagonals(raw, faces, place)
    outer = distinct[np.bincount(place) == 1]
    owner = np.full(len(outer), -1)
    for number, (name, facets) in enumerate(raw.boundaries.items()):
        if facets.shape[1] != outer.shape[1]:
            raise SceneError(f"boundary '{name}' of the mesh does not consist of its cells' faces.")
        place = match_rows(outer, face_keys(facets))
        inside = int((place < 0).sum())
        if inside:
            raise SceneError(
                f"boundary '{name}' of the mesh has {inside} of {len(facets)} facets that are "
                "not outer faces of its cells: a boundary must lie on the outside."
            )
        taken = owner[place].max(initial=-1)
        if taken >= 0:
            raise SceneError(
                f"boundaries '{list(raw.boundaries)[taken]}' and '{name}' of the mesh share "
                "facets: each facet must belong to one boundary only."
            )
        owner[place] = number


def _check_diagonals(raw: RawMesh, faces: Index, place: Index) -> None:
    """Quads of equal `place` have equal corners; they are one face if the diagonals are equal."""
    ends = np.stack([np.sort(faces[:, ::2], axis=1), np.sort(faces[:, 1::2], axis=1)])
    diagonal = (ends[..., 0] * len(raw.points) + ends[..., 1]).min(axis=0)
    of_place = np.zeros(len(faces), dtype=np.int64)
    of_place[place] = diagonal
    wrong = np.flatnonzero(of_place[place] != diagonal)
    if len(wrong):
        where = raw.points[faces[wrong[0]]].mean(axis=0)
        raise SceneError(
            f"the mesh has two cells near {where.tolist()} (mesh units) that list the corners of "
            "the face between them in different orders: one of them is twisted."
        )
