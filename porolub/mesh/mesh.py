"""The distributed mesh: nodes, cells, named boundaries, as NumPy arrays of one rank."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.mesh import plex
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
class Mesh:
    """A distributed mesh without overlap and its Lagrange nodes of degree 1 or 2.

    Nodes are DMPlex points (vertices; for degree 2 also edges and, of quads and hexahedra,
    faces and cells). Local nodes number vertices first, so the nodes of degree 1 are the
    nodes 0 ... nvertices - 1.

    dm: the DMPlex, overlap 0; comm: mpi4py communicator; degree: 1 or 2
    cell: reference cell with the orders of nodes and faces
    cells: (ncell, nodes per cell) local nodes; the first `cell.vertices` columns are vertices
    node_point: (nnode,) DMPlex point; point_node: (npoints,) its inverse, -1 if no node
    coordinates: (nnode, dim) in mesh units, curved sides included
    owned: (nnode,) True where this rank owns the node
    global_node: (nnode,) number of the node over all ranks; owned nodes are contiguous
    natural_node, natural_cell: numbers that do not depend on the partition: 0 ... N-1 with
        vertices first
    cell_faces: (ncell, faces per cell) DMPlex points of the faces
    boundary_names: names of the boundaries; shape: the structured shape or None
    vertex_ticks: logical positions of the vertices along each axis (structured meshes)
    """

    dm: PETSc.DMPlex
    comm: MPI.Intracomm
    degree: int
    cell: Cell
    cells: Index
    nvertices: int
    node_point: Index
    point_node: Index
    coordinates: Array
    owned: NDArray[np.bool_]
    global_node: Index
    natural_node: Index
    natural_cell: Index
    cell_faces: Index
    boundary_names: tuple[str, ...]
    shape: Shape | None = None
    vertex_ticks: tuple[Array, ...] = field(default=())

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

    @cached_property
    def _facets(self) -> dict[str, Facets]:
        of_faces = self.cell.face_nodes(self.degree)
        faces = self.cell_faces.ravel()
        order = np.argsort(faces, kind="stable")
        found = {}
        for name in self.boundary_names:
            points = plex.label_points(self.dm, "Face Sets", self.boundary_names.index(name) + 1)
            points = points[np.isin(points, faces)]
            place = order[np.searchsorted(faces, points, sorter=order)]
            cells, local = np.divmod(place, len(self.cell.faces))
            found[name] = Facets(cells, local, self.cells[cells[:, None], of_faces[local]])
        return found

    def facets(self, name: str) -> Facets:
        """Outer facets of the boundary on this rank. Raises KeyError for an unknown name."""
        return self._facets[name]

    @cached_property
    def _boundary_nodes(self) -> dict[str, Index]:
        nodes = {}
        for name in self.boundary_names:
            marked = np.zeros(len(self.point_node), dtype=np.int64)
            marked[self.node_point[self.facets(name).nodes]] = 1
            marked = plex.largest_of_all(self.dm, marked)
            nodes[name] = np.flatnonzero(marked[self.node_point])
        return nodes

    def boundary_nodes(self, name: str) -> Index:
        """Local nodes (k,) on the boundary, sorted, also those whose facets are elsewhere.

        The first call is collective (all boundaries at once).
        """
        return self._boundary_nodes[name]

    def logical(self, points: Array) -> Array:
        """Logical coordinates (n, dim) in [0, 1] of points (n, dim) of a structured mesh."""
        if self.shape is None:
            raise ValueError("a mesh from a file has no logical coordinates")
        return self.shape.logical(points)

    def ticks(self) -> tuple[Array, ...]:
        """Logical positions of the nodes along each axis of a structured mesh."""
        return tuple(with_middles(ticks, self.degree) for ticks in self.vertex_ticks)

    def destroy(self) -> None:
        """Free the DMPlex."""
        self.dm.destroy()


def with_middles(ticks: Array, degree: int) -> Array:
    """Vertex positions of an axis with the middles in between for degree 2."""
    if degree == 1:
        return ticks
    full = np.empty(2 * len(ticks) - 1)
    full[::2] = ticks
    full[1::2] = (ticks[1:] + ticks[:-1]) / 2
    return full


def strata_with_nodes(dm: PETSc.DMPlex, cell: Cell, degree: int) -> Sequence[tuple[int, int]]:
    """Point ranges that carry a node, in the order nodes are numbered: vertices first."""
    depths = [0] if degree == 1 else [0, 1]
    if degree == 2 and cell.tensor:
        depths += [2] if cell.dim == 2 else [2, 3]
    return [dm.getDepthStratum(depth) for depth in depths]


def connectivity(dm: PETSc.DMPlex, cell: Cell, degree: int) -> tuple[Index, Index]:
    """DMPlex points of each local cell's nodes (in our order) and of its faces."""
    first, last = dm.getHeightStratum(0)
    nfaces, nedges = len(cell.faces), len(cell.edges)
    inner = nfaces if cell.dim == 3 else 0
    closure = plex.closures(dm, np.arange(first, last))
    closure = closure.reshape(-1, 1 + inner + nedges + cell.vertices)
    faces = closure[:, 1 : 1 + inner][:, list(cell.plex_faces)]
    edges = closure[:, 1 + inner : 1 + inner + nedges][:, list(cell.plex_edges)]
    vertices = closure[:, 1 + inner + nedges :][:, list(cell.plex_vertices)]
    columns = [vertices]
    if degree == 2:
        columns.append(edges)
        if cell.tensor:
            columns += [faces, closure[:, :1]]
    return np.hstack(columns), (faces if cell.dim == 3 else edges)
