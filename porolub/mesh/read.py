"""Reading a user's mesh: any file meshio knows, with named boundaries, lengths in metres."""

import contextlib
import io
import logging
from collections.abc import Collection, Iterator
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.mesh.cell import CELLS, Cell
from porolub.mesh.raw import RawMesh, face_keys, oriented

Array = NDArray[np.float64]
Index = NDArray[np.int64]

log = logging.getLogger(__name__)

KINDS = {
    "quad": ("quad", "quad8", "quad9"),
    "triangle": ("triangle", "triangle6"),
    "hex": ("hexahedron", "hexahedron20", "hexahedron27"),
    "tet": ("tetra", "tetra10"),
}
"""meshio's names of the elements of order 1 and 2."""
FACETS = {2: ("line", "line3"), 3: (*KINDS["triangle"], *KINDS["quad"])}
CORNERS = {"line": 2, "triangle": 3, "quad": 4}


def read_mesh(path: Path, dim: int, length_scale: float, required: Collection[str]) -> RawMesh:
    """The mesh in `path` (m), lengths divided by `length_scale`; curved sides are kept.

    Boundaries are the named groups of lines (2D) or faces (3D). Raises SceneError when the
    file cannot be read, mixes cell types or lacks one of the `required` boundaries.
    """
    here = f"geometry.path = '{path}'"
    file = _read_quietly(path, here)
    kinds = {block.type for block in file.cells}
    present = [
        (cell, name)
        for cell in CELLS.values()
        for name in KINDS[cell.name]
        if cell.dim == dim and name in kinds
    ]
    solid = kinds & {name for cell in CELLS.values() if cell.dim == 3 for name in KINDS[cell.name]}
    if len(present) != 1 or (dim == 2 and solid):
        allowed = "quads or triangles" if dim == 2 else "hexahedra or tetrahedra"
        raise SceneError(
            f"{here} must hold one kind of {dim}D cells ({allowed}, of first or second order) "
            f"for scene.dimension = {dim}; it holds: {', '.join(sorted(kinds)) or 'nothing'}."
        )
    ((cell, kind),) = present
    cells = np.vstack([block.data for block in file.cells if block.type == kind]).astype(np.int64)
    points = np.asarray(file.points, dtype=float) / length_scale
    if dim == 2 and points.shape[1] == 3:
        height = points[cells, 2]
        if np.ptp(height) > 1e-9 * np.ptp(points):
            raise SceneError(f"{here} does not lie in the x-y plane, as a 2D scene needs.")
    points = np.ascontiguousarray(points[:, :dim])

    named = dict(_named_facets(file, dim))
    missing = sorted(set(required) - set(named))
    if missing:
        found = ", ".join(sorted(named)) or "none"
        raise SceneError(
            f"{here} has no boundary named '{missing[0]}'"
            f" (needed: {', '.join(sorted(required))}; named in the file: {found})."
        )
    corners = cells[:, : cell.vertices]
    used, flat = np.unique(corners, return_inverse=True)
    number = np.full(len(points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    boundaries = {}
    for name, facets in named.items():
        if (number[facets] < 0).any():
            raise SceneError(f"boundary '{name}' of {here} has nodes that belong to no cell.")
        distinct = np.unique(face_keys(number[facets]), axis=0, return_index=True)[1]
        boundaries[name] = number[facets[np.sort(distinct)]]
    middle = _middle_nodes(cell, points, cells, number)
    return oriented(
        RawMesh(cell, points[used], flat.reshape(corners.shape), boundaries, tuple(middle))
    )


def _read_quietly(path: Path, here: str) -> meshio.Mesh:
    """meshio.read, which prints and, on files it cannot read, ends the process."""
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            file = meshio.read(path)
    except SystemExit as error:
        reason = "no reader for files of that name accepts it"
        raise SceneError(f"{here} cannot be read as a mesh: {reason}.") from error
    except Exception as error:  # readers of broken files fail in every possible way
        reason = str(error).rstrip(".") or type(error).__name__
        raise SceneError(f"{here} cannot be read as a mesh: {reason}.") from error
    if printed.getvalue().strip():
        log.info("%s: %s", here, " ".join(printed.getvalue().split()))
    return file


def _named_facets(file: meshio.Mesh, dim: int) -> Iterator[tuple[str, Index]]:
    """Name and vertices (nf, k) of each named group of facets."""
    tags = file.cell_data.get("gmsh:physical")
    groups = {}
    if tags is not None:
        for name, (tag, of_dim) in file.field_data.items():
            if of_dim == dim - 1:
                groups[name] = [np.flatnonzero(np.abs(values) == tag) for values in tags]
    for name, members in file.cell_sets.items():
        if not name.startswith("gmsh:"):
            groups.setdefault(name, members)
    for name, members in groups.items():
        parts = []
        for block, rows in zip(file.cells, members, strict=True):
            if block.type in FACETS[dim] and rows is not None and len(rows):
                corners = CORNERS[block.type.rstrip("0123456789")]
                parts.append(block.data[np.asarray(rows, dtype=np.int64), :corners])
        if parts:
            if len({part.shape[1] for part in parts}) > 1:
                raise SceneError(f"boundary '{name}' mixes triangles and quads.")
            yield name, np.vstack(parts).astype(np.int64)


def _middle_nodes(
    cell: Cell, points: Array, cells: Index, number: Index
) -> Iterator[tuple[Index, Array]]:
    """Second-order nodes by kind: sorted vertex numbers they lie between, and positions.

    Serendipity elements (8, 20 nodes) have no nodes on faces or in the centre: there the
    serendipity shape functions say where the middle is.
    """
    if cells.shape[1] == cell.vertices:
        return
    place = points[cells]
    edges = np.array(cell.edges)
    on_edges = cell.vertices + np.arange(len(edges))
    kinds = [(edges, place[:, on_edges])]
    given = cells.shape[1] - cell.vertices - len(edges)
    pairs = [frozenset(edge) for edge in cell.edges]
    if cell.tensor and cell.dim == 3:
        faces = np.array(cell.faces)
        ring = [
            [cell.vertices + pairs.index(frozenset(e)) for e in zip(f, np.roll(f, -1), strict=True)]
            for f in cell.faces
        ]
        blend = place[:, np.array(ring)].sum(axis=2) / 2 - place[:, faces].sum(axis=2) / 4
        start = cell.vertices + len(edges)
        kinds.append((faces, place[:, start : start + len(faces)] if given else blend))
    if cell.tensor:
        weight = 2.0 if cell.dim == 2 else 4.0
        blend = place[:, on_edges].sum(axis=1) / weight - place[:, : cell.vertices].sum(axis=1) / 4
        centre = place[:, -1] if given else blend
        kinds.append((np.arange(cell.vertices)[None], centre[:, None]))
    for parents, positions in kinds:
        keys = face_keys(number[cells[:, parents]].reshape(-1, parents.shape[1]))
        distinct, first = np.unique(keys, axis=0, return_index=True)
        yield distinct, positions.reshape(-1, positions.shape[-1])[first]
