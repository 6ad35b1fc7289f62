"""Counting the nodes of a user's mesh, so that ``check`` can tell what it will cost.

Only here does the scene layer read a mesh, and only when it is asked to count.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from porolub.errors import SceneError

_Table = dict[str, tuple[tuple[int, ...], ...]]
# corners, and within them the edges and the quadrilateral faces, in meshio's (VTK's) numbering
_CORNERS = {"line": 2, "triangle": 3, "quad": 4, "tetra": 4, "hexahedron": 8}
_DIMENSION = {"line": 1, "triangle": 2, "quad": 2, "tetra": 3, "hexahedron": 3}
_EDGES: _Table = {
    "line": ((0, 1),),
    "triangle": ((0, 1), (1, 2), (2, 0)),
    "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "tetra": ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    "hexahedron": (
        *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
        *((0, 4), (1, 5), (2, 6), (3, 7)),
    ),
}
_QUADS: _Table = {
    "quad": ((0, 1, 2, 3),),
    "hexahedron": (
        *((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4)),
        *((1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    ),
}

_TRIANGLES: _Table = {
    "triangle": ((0, 1, 2),),
    "tetra": ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)),
}


@dataclass(frozen=True)
class FileNodes:
    """Numbers of nodes by degree (1, 2): ``layer[degree]`` and ``surface[degree]``."""

    layer: dict[int, int]
    surface: dict[int, int]


def count_file_nodes(path: Path, dimension: int, surface: str) -> FileNodes:
    """Count the nodes of the layer and of the boundary called ``surface``.

    Raises SceneError if the file is no mesh of that dimension.
    """
    mesh = _read(path)
    tag = mesh.field_data.get(surface, (None,))[0]
    physical = mesh.cell_data.get("gmsh:physical")
    layer, on_surface = [], []
    for number, block in enumerate(mesh.cells):
        kind = block.type.rstrip("0123456789")
        if kind not in _CORNERS:
            continue
        corners = block.data[:, : _CORNERS[kind]]
        if _DIMENSION[kind] == dimension:
            layer.append((kind, corners))
        elif _DIMENSION[kind] == dimension - 1 and physical is not None:
            on_surface.append((kind, corners[physical[number] == tag]))
    if not layer:
        raise SceneError(
            f'geometry.path = "{path}": the mesh has no elements of dimension {dimension}, '
            f"as scene.dimension = {dimension} needs."
        )
    return FileNodes(
        {d: _nodes(layer, d) for d in (1, 2)}, {d: _nodes(on_surface, d) for d in (1, 2)}
    )


def count_file_parts(path: Path, dimension: int) -> dict[str, int]:
    """Count the elements of that dimension and their interior faces, edges and vertices, by kind.

    Raises SceneError if the file is no mesh.
    """
    import numpy as np

    blocks = []
    for block in _read(path).cells:
        kind = block.type.rstrip("0123456789")
        if _DIMENSION.get(kind) == dimension:
            blocks.append((kind, block.data[:, : _CORNERS[kind]]))
    numbers: dict[str, int] = {}
    for kind, corners in blocks:
        numbers[kind] = numbers.get(kind, 0) + len(corners)
    faces: dict[str, _Table] = {"line": _EDGES}
    if dimension == 3:
        faces = {"triangle": _TRIANGLES, "quad": _QUADS}
    rim = []  # faces of one element only, and from them the edges and vertices on the boundary
    for kind, table in faces.items():
        rows = _parts(blocks, table)
        if rows:
            every = np.vstack(rows)
            _, first, times = np.unique(
                np.sort(every, axis=1), axis=0, return_index=True, return_counts=True
            )
            numbers[kind] = int((times > 1).sum())
            rim.append((kind, every[first[times == 1]]))
    if dimension == 3:
        numbers["line"] = _distinct(_parts(blocks, _EDGES)) - _distinct(_parts(rim, _EDGES))
    numbers["vertex"] = _nodes(blocks, 1) - _nodes(rim, 1)
    return numbers


def _parts(blocks: list[tuple[str, Any]], table: _Table) -> list[Any]:
    """Corners of the parts of elements, as often as elements have them."""
    return [
        corners[:, list(part)].reshape(-1, len(part))
        for kind, corners in blocks
        for part in table.get(kind, ())
    ]


def _read(path: Path) -> Any:
    import meshio

    try:
        return meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio's readers have no common error
        raise SceneError(f'geometry.path = "{path}": meshio cannot read this mesh.') from error


def _nodes(blocks: list[tuple[str, Any]], degree: int) -> int:
    """Count the nodes of a degree: vertices, and for 2 those on edges, quads and in hexahedra."""
    count = _distinct([corners.reshape(-1, 1) for _, corners in blocks])
    if degree == 1:
        return count
    count += _distinct(_parts(blocks, _EDGES)) + _distinct(_parts(blocks, _QUADS))
    return count + sum(len(corners) for kind, corners in blocks if kind == "hexahedron")


def _distinct(rows: list[Any]) -> int:
    """Count rows that differ as sets of vertices."""
    import numpy as np

    return len(np.unique(np.sort(np.vstack(rows), axis=1), axis=0)) if rows else 0
