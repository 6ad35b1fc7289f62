"""Every rank gets its share of the cells and of the lubricated surface; parts of files by hand."""

from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from porolub.mesh import plex
from porolub.mesh.partition import CELL_EXCESS, SURFACE_EXCESS, column_parts, excess
from porolub.mesh.raw import RawMesh
from porolub.mesh.read import read_mesh
from porolub.mesh.topology import Topology
from porolub.mesh.whole import Whole, whole
from tests.mesh.scenes import barrel_file, box_file

SCRIPT = Path(__file__).with_name("balance_ranks.py")
THIN, THICK = (24, 3, 8), (8, 8, 6)


def on_one_rank(raw: RawMesh) -> Whole:
    dm = plex.from_cells(raw, raw.cell, MPI.COMM_SELF)
    mesh = whole(raw, Topology.of(dm, raw.cell))
    dm.destroy()
    return mesh


@pytest.mark.mpi
def test_ranks_share_cells_and_surface(run_mpi, tmp_path):
    """The thick layer's graph is cut along its surface: there columns must take over."""
    files = []
    for name, counts in (("thin", THIN), ("thick", THICK)):
        path = tmp_path / f"{name}.msh"
        files.append(barrel_file(path, hexahedra=False, counts=counts, width=8e-3))
    for ranks in (2, 4, 6):
        output = run_mpi(ranks, SCRIPT, *files)
        lines = [line.split() for line in output.splitlines() if line.startswith("balance ")]
        assert [Path(line[1]).stem for line in lines] == ["barrel", "thin", "thick"]
        for _, name, cells, facets in lines:
            assert float(cells) <= (1.0 if name == "barrel" else CELL_EXCESS), (ranks, name)
            assert float(facets) <= (1.0 if name == "barrel" else SURFACE_EXCESS), (ranks, name)


@pytest.mark.parametrize("ranks", [2, 3, 4, 7])
def test_columns_take_all_cells_below_a_facet(tmp_path, ranks):
    path = barrel_file(tmp_path / "a.msh", hexahedra=True, counts=THICK, width=8e-3)
    mesh = on_one_rank(read_mesh(path, 3, 1e-3, {"lubricated"}))
    part = column_parts(mesh, "lubricated", ranks)
    assert set(part) == set(range(ranks))
    at = mesh.facets["lubricated"][:, 0]
    assert excess(part[at], ranks) <= 1.1
    centres = mesh.raw.points[mesh.raw.cells].mean(axis=1)
    angle = np.arctan2(centres[:, 0], 100.0 - centres[:, 1])
    column = np.round(np.column_stack([angle, centres[:, 2]]), 6)
    for place in np.unique(column, axis=0):
        assert len(set(part[(column == place).all(axis=1)])) == 1


def test_excess_is_that_of_the_fullest_part():
    assert excess(np.array([0, 0, 0, 1]), 2) == 1.5
    assert excess(np.zeros(0, dtype=np.int64), 4) == 1.0
    assert excess(np.array([3]), 4) == 4.0


@pytest.mark.parametrize("hexahedra", [False, True])
def test_neighbours_share_a_face(tmp_path, hexahedra):
    raw = read_mesh(box_file(tmp_path / "a.msh", order=1, hexahedra=hexahedra), 3, 1e-3, {"top"})
    mesh = on_one_rank(raw)
    outer = sum(len(rows) for rows in mesh.facets.values())
    assert 2 * len(mesh.neighbours) + outer == len(raw.cells) * len(raw.cell.faces)
    shared = [len(np.intersect1d(raw.cells[a], raw.cells[b])) for a, b in mesh.neighbours]
    assert set(shared) == {len(raw.cell.faces[0])}
