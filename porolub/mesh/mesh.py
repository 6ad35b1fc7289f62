"""The distributed mesh: nodes, cells, named boundaries, as NumPy arrays of one rank."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.mesh.cell import Cell
from porolub.mesh.shape import Shape

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class Facets:
    """Outer facets of a named boundary that lie on this rank; each is on one rank only.

    cells: (nf,) local cell; local_face: (nf,) number of the face in the cell;
    nodes: (nf, nodes per facet) local nodes: vertices (normal pointing outward), middles of
    the edges between them, centre (see porolub.mesh.cell).
    """

    cells: Index
    local_face: Index
    nodes: Index


@dataclass(frozen=True)
class Boundary:
    """A named boundary on this rank: its facets, and its nodes (k,), sorted, also those whose
    facets are on other ranks."""

    facets: Facets
    nodes: Index


@dataclass(frozen=True)
class Mesh:
    """A distributed mesh without overlap and its Lagrange nodes of degree 1 or 2.

    Local nodes number vertices first, so the nodes of degree 1 are the nodes
    0 ... nvertices - 1; the natural numbers of local nodes increase.

    comm: mpi4py communicator; degree: 1 or 2
    cell: reference cell with the orders of nodes and faces
    cells: (ncell, nodes per cell) local nodes; the first `cell.vertices` columns are vertices
    coordinates: (nnode, dim) in mesh units, curved sides included
    owned: (nnode,) True where this rank owns the node
    global_node: (nnode,) number of the node over all ranks; owned nodes are contiguous
    natural_node, natural_cell: numbers that do not depend on the partition: 0 ... N-1 with
        vertices first
    boundaries: by name; shape: the structured shape or None
    vertex_ticks: logical positions of the vertices along each axis (structured meshes)
    fine_index: (nnode, dim) places in the tensor grid of a structured mesh, even at vertices, odd
        between them (see porolub.mesh.lattice); None of a mesh from a file
    """

    comm: MPI.Intracomm
    degree: int
    cell: Cell
    cells: Index
    nvertices: int
    coordinates: Array
    owned: NDArray[np.bool_]
    global_node: Index
    natural_node: Index
    natural_cell: Index
    boundaries: dict[str, Boundary]
    shape: Shape | None = None
    vertex_ticks: tuple[Array, ...] = field(default=())
    fine_index: Index | None = None

    @property
    def dim(self) -> int:
        return self.cell.dim

    @property
    def cell_type(self) -> str:
        """quad, triangle, hex or tet."""
        return self.cell.name

    @property
    def vertices_of_cells(self) -> Index:
        """(ncell, vertices per cell) local nodes: the degree-1 element."""
        return self.cells[:, : self.cell.vertices]

    @cached_property
    def global_cell_count(self) -> int:
        return int(self.comm.allreduce(len(self.cells)))

    @cached_property
    def global_node_count(self) -> int:
        return int(self.comm.allreduce(int(self.owned.sum())))

    @property
    def boundary_names(self) -> tuple[str, ...]:
        return tuple(self.boundaries)

    def facets(self, name: str) -> Facets:
        """Outer facets of the boundary on this rank. Raises KeyError for an unknown name."""
        return self.boundaries[name].facets

    def boundary_nodes(self, name: str) -> Index:
        """Local nodes (k,) on the boundary, sorted, also those whose facets are elsewhere."""
        return self.boundaries[name].nodes

    def logical(self, points: Array) -> Array:
        """Logical coordinates (n, dim) in [0, 1] of points (n, dim) of a structured mesh."""
        if self.shape is None:
            raise ValueError("a mesh from a file has no logical coordinates")
        return self.shape.logical(points)

    def ticks(self) -> tuple[Array, ...]:
        """Logical positions of the nodes along each axis of a structured mesh."""
        return tuple(with_middles(ticks, self.degree) for ticks in self.vertex_ticks)


def with_middles(ticks: Array, degree: int) -> Array:
    """Vertex positions of an axis with the middles in between for degree 2."""
    if degree == 1:
        return ticks
    full = np.empty(2 * len(ticks) - 1)
    full[::2] = ticks
    full[1::2] = (ticks[1:] + ticks[:-1]) / 2
    return full
