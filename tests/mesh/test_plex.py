"""What DMPlex finds in the cells of a file: every edge and face, ours in our order."""

from itertools import pairwise

import numpy as np
import pytest
from mpi4py import MPI

from porolub.errors import SceneError
from porolub.mesh import plex
from porolub.mesh.cell import CELLS, HEX, Cell
from porolub.mesh.raw import RawMesh, check_boundaries
from porolub.mesh.read import read_mesh
from porolub.mesh.spread import spread
from porolub.mesh.topology import Topology
from tests.mesh.scenes import box_file, sector_file

KINDS = sorted(CELLS)


@pytest.fixture(params=KINDS)
def raw(request, tmp_path):
    cell, path = CELLS[request.param], tmp_path / "a.msh"
    if cell.dim == 2:
        sector_file(path, order=1, quads=cell.tensor)
    else:
        box_file(path, order=1, hexahedra=cell.tensor)
    return read_mesh(path, cell.dim, 1e-3, set())


def sets(cell: Cell, cells, parts):
    """Vertices of the parts of each cell, as sorted rows."""
    return np.sort(cells[:, np.array(parts)], axis=2)


def test_points_of_a_cell_are_where_ours_are(raw):
    cell = raw.cell
    dm = plex.from_cells(raw, cell, MPI.COMM_SELF)
    found = Topology.of(dm, cell)
    ends = list(pairwise(np.cumsum([0, cell.vertices, len(cell.edges)])))
    vertices, edges = (found.nodes(2)[:, slice(*end)] for end in ends)
    first = [stratum[0] for stratum in found.strata]
    np.testing.assert_array_equal(vertices - first[0], raw.cells)
    for points, dim, parts in ((edges, 1, cell.edges), (found.faces, cell.dim - 1, cell.faces)):
        corners = found.corners(dim)[points - first[dim]] - first[0]
        np.testing.assert_array_equal(corners, sets(cell, raw.cells, parts))
    euler = sum((-1) ** dim * (last - start) for dim, (start, last) in enumerate(found.strata))
    assert euler == 1  # vertices - edges + faces - cells of a body without holes
    dm.destroy()


@pytest.mark.parametrize("degree", [1, 2])
def test_every_node_is_there_once_in_the_order_of_its_vertices(raw, degree):
    mesh = spread(raw, MPI.COMM_SELF, degree)
    cell, column = raw.cell, raw.cell.vertices
    distinct = np.unique(np.round(mesh.coordinates, 9), axis=0)
    assert len(distinct) == len(mesh.coordinates) == mesh.global_node_count
    np.testing.assert_array_equal(mesh.vertices_of_cells, raw.cells)
    np.testing.assert_array_equal(mesh.coordinates[: mesh.nvertices], raw.points)
    np.testing.assert_array_equal(mesh.natural_node, np.arange(len(mesh.coordinates)))
    count = mesh.nvertices
    for parents in cell.parents() if degree == 2 else ():
        nodes = mesh.cells[:, column : column + len(parents)].ravel()
        rows = sets(cell, raw.cells, parents).reshape(len(nodes), -1)
        kind, first = np.unique(rows, axis=0, return_index=True)
        np.testing.assert_array_equal(nodes[first], count + np.arange(len(kind)))
        count, column = count + len(kind), column + len(parents)
    assert count == len(mesh.coordinates)


def test_a_twisted_cell_is_refused():
    points = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)], float)
    left = np.array([0, 1, 4, 3, 6, 7, 10, 9])
    right = left + 1
    check_boundaries(RawMesh(HEX, points, np.array([left, right]), {}))
    twisted = right[[4, 1, 2, 3, 0, 5, 6, 7]]
    with pytest.raises(SceneError, match=r"two cells near \[1\.0, 0\.5, 0\.5\].*twisted"):
        check_boundaries(RawMesh(HEX, points, np.array([left, twisted]), {}))
