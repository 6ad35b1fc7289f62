"""From the mesh of rank 0 to the distributed mesh with numbered nodes."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.mesh import plex
from porolub.mesh.cell import CELLS, Cell
from porolub.mesh.gmsh_file import write_msh
from porolub.mesh.mesh import Mesh, connectivity, strata_with_nodes
from porolub.mesh.nodes import curved_points, shape_positions, straight_positions
from porolub.mesh.raw import RawMesh
from porolub.mesh.shape import Shape

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class _Carried:
    """What is known of each DMPlex point before distribution and travels with it.

    node, cell: (npoints,) partition-independent numbers of nodes and cells, else -1
    position: (npoints, dim) curved positions of middle nodes, NaN elsewhere; None if straight
    """

    node: Index
    cell: Index
    position: Array | None

    @classmethod
    def of(
        cls, dm: PETSc.DMPlex, cell: Cell, degree: int, raw: RawMesh | None, curved: bool
    ) -> "_Carried":
        npoints = dm.getChart()[1]
        nodes, cells = np.full((2, npoints), -1, dtype=np.int64)
        count = 0
        for first, last in strata_with_nodes(dm, cell, degree):
            nodes[first:last] = np.arange(count, count + last - first)
            count += last - first
        first, last = dm.getHeightStratum(0)
        cells[first:last] = np.arange(last - first)
        position = None
        if curved:
            position = np.empty((0, cell.dim)) if raw is None else curved_points(dm, raw)
        return cls(nodes, cells, position)

    def along(self, sf: PETSc.SF | None, npoints: int) -> "_Carried":
        """The same for the points of each rank after distribution through `sf`."""
        bent = self.position
        return _Carried(
            plex.from_original(sf, self.node, npoints),
            plex.from_original(sf, self.cell, npoints),
            None if bent is None else plex.from_original(sf, bent, npoints),
        )


def _read(raw: RawMesh | None, comm: MPI.Intracomm) -> PETSc.DMPlex:
    """Write the mesh of rank 0 with gmsh and read it into a DMPlex, still all on rank 0."""
    with tempfile.TemporaryDirectory(prefix="porolub-") as folder:
        path = Path(folder) / "mesh.msh"
        if raw is not None:
            write_msh(raw, path)
        return plex.read(str(path), comm)


def _global_numbers(dm: PETSc.DMPlex, node_point: Index, owned: NDArray[np.bool_]) -> Index:
    """Numbers (nnode,) of the nodes over all ranks, those of each owner contiguous."""
    mine = int(owned.sum())
    start = dm.comm.tompi4py().scan(mine) - mine
    number = np.full(dm.getChart()[1], -1, dtype=np.int64)
    number[node_point[owned]] = start + np.arange(mine)
    return plex.from_owners(dm, number)[node_point]


def distributed(
    raw: RawMesh | None,
    comm: MPI.Intracomm,
    degree: int,
    shape: Shape | None,
    ticks: tuple[Array, ...],
) -> Mesh:
    """Spread the mesh `raw` (None except on rank 0) over the ranks. Collective.

    Structured meshes (`shape`, with logical vertex `ticks`) go out in strips along the layer.
    """
    about = None
    if raw is not None:
        about = raw.cell.name, tuple(raw.boundaries), bool(raw.middle) and degree == 2
    cell_name, names, curved = comm.bcast(about)
    cell = CELLS[cell_name]
    dm = _read(raw, comm)
    carried = _Carried.of(dm, cell, degree, raw, curved)
    sf = plex.distribute(dm, strips=shape is not None)
    npoints = dm.getChart()[1]
    carried = carried.along(sf, npoints)
    if sf is not None:
        sf.destroy()

    strata = strata_with_nodes(dm, cell, degree)
    node_point = np.concatenate([np.arange(*stratum) for stratum in strata])
    point_node = np.full(npoints, -1, dtype=np.int64)
    point_node[node_point] = np.arange(len(node_point))
    cell_points, cell_faces = connectivity(dm, cell, degree)
    cells = point_node[cell_points]

    owned_point = np.ones(npoints, dtype=bool)
    owned_point[plex.ghosts(dm)] = False
    owned = owned_point[node_point]

    vertices = dm.getCoordinatesLocal().array.reshape(-1, cell.dim)
    if shape is not None:
        positions = shape_positions(shape, ticks, vertices, len(node_point), cells, cell)
    else:
        positions = straight_positions(vertices, len(node_point), cells, cell)
    if carried.position is not None:
        bent = carried.position[node_point]
        positions = np.where(np.isnan(bent), positions, bent)
    first, last = dm.getHeightStratum(0)
    return Mesh(
        dm=dm,
        comm=comm,
        degree=degree,
        cell=cell,
        cells=cells,
        nvertices=len(vertices),
        node_point=node_point,
        point_node=point_node,
        coordinates=positions,
        owned=owned,
        global_node=_global_numbers(dm, node_point, owned),
        natural_node=carried.node[node_point],
        natural_cell=carried.cell[first:last],
        cell_faces=cell_faces,
        boundary_names=names,
        shape=shape,
        vertex_ticks=ticks,
    )
