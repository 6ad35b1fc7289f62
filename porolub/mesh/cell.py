"""Reference cells: which vertices make an edge, a face, and in which order nodes are listed.

Node order of a cell is that of VTK (quad9, triangle6, hexahedron27, tetra10): vertices,
then edges, then faces (hexahedra), then the centre (quads, hexahedra). Cells have a positive
Jacobian. Faces list their vertices so that the normal points out of the cell: for a 2D edge
(a, b) it is (y_b - y_a, x_a - x_b), for a 3D face it follows the right-hand rule.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Cell:
    """A reference cell (in 2D the edges are the faces).

    `mirror` lists the vertices in an order that turns the cell's orientation round.
    """

    name: str
    dim: int
    vertices: int
    edges: tuple[tuple[int, int], ...]
    faces: tuple[tuple[int, ...], ...]
    tensor: bool  # quads and hexahedra: faces and centre carry a node of degree 2
    mirror: tuple[int, ...]

    def nodes(self, degree: int) -> int:
        """Nodes of one cell for Lagrange elements of degree 1 or 2."""
        if degree == 1:
            return self.vertices
        inner = (len(self.faces) * (self.dim == 3) + 1) if self.tensor else 0
        return self.vertices + len(self.edges) + inner

    def face_nodes(self, degree: int) -> NDArray[np.int64]:
        """Cell-local node numbers of every face (nface, nodes per face), vertices first."""
        rows = []
        pairs = [frozenset(edge) for edge in self.edges]
        for number, face in enumerate(self.faces):
            row = list(face)
            if degree == 2:
                ring = face[1:] + face[:1] if self.dim == 3 else face[1:]
                sides = zip(face, ring, strict=False)  # in 2D one edge: the face itself
                row += [self.vertices + pairs.index(frozenset(side)) for side in sides]
                if self.dim == 3 and self.tensor:
                    row.append(self.vertices + len(self.edges) + number)
            rows.append(row)
        return np.array(rows, dtype=np.int64)

    def parents(self) -> list[NDArray[np.int64]]:
        """Vertices whose mean is the straight position of each non-vertex node, by kind.

        One array (count, vertices per entity) each for edges, inner faces and centre.
        """
        kinds = [np.array(self.edges)]
        if self.tensor and self.dim == 3:
            kinds.append(np.array(self.faces))
        if self.tensor:
            kinds.append(np.arange(self.vertices)[None])
        return kinds


QUAD = Cell(
    name="quad",
    dim=2,
    vertices=4,
    edges=((0, 1), (1, 2), (2, 3), (3, 0)),
    faces=((0, 1), (1, 2), (2, 3), (3, 0)),
    tensor=True,
    mirror=(0, 3, 2, 1),
)

TRIANGLE = Cell(
    name="triangle",
    dim=2,
    vertices=3,
    edges=((0, 1), (1, 2), (2, 0)),
    faces=((0, 1), (1, 2), (2, 0)),
    tensor=False,
    mirror=(0, 2, 1),
)

HEX = Cell(
    name="hex",
    dim=3,
    vertices=8,
    edges=(
        *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
        *((0, 4), (1, 5), (2, 6), (3, 7)),
    ),
    faces=((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (2, 3, 7, 6), (0, 3, 2, 1), (4, 5, 6, 7)),
    tensor=True,
    mirror=(0, 3, 2, 1, 4, 7, 6, 5),
)

TET = Cell(
    name="tet",
    dim=3,
    vertices=4,
    edges=((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    faces=((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)),
    tensor=False,
    mirror=(0, 2, 1, 3),
)

CELLS = {cell.name: cell for cell in (QUAD, TRIANGLE, HEX, TET)}
