"""The mesh is the same on 1, 2 and 4 ranks."""

from pathlib import Path

import numpy as np
import pytest

from tests.mesh.scenes import barrel_file, sector_file
from tests.mpirun import mpirun

SCRIPT = Path(__file__).with_name("gather_ranks.py")


def by_number(values, number):
    """Rows of `values` in the order of `number`; all copies of a row must be equal."""
    distinct, first, inverse = np.unique(number, return_index=True, return_inverse=True)
    np.testing.assert_array_equal(values, values[first][inverse])
    np.testing.assert_array_equal(distinct, np.arange(len(distinct)))
    return values[first]


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    """The directory of a number of ranks; starting them takes longer than any of the meshes."""
    files = tmp_path_factory.mktemp("files")
    paths = []
    for order in (1, 2):
        for cubes in (False, True):
            plane, body = (files / f"{kind} {order} {cubes}.msh" for kind in ("plane", "body"))
            paths += [sector_file(plane, order=order, quads=cubes)]
            paths += [barrel_file(body, order=order, hexahedra=cubes)]
    written = {}
    for ranks in (1, 2, 4):
        written[ranks] = tmp_path_factory.mktemp(f"{ranks} ranks")
        mpirun(written[ranks], ranks, SCRIPT, written[ranks], *paths)
    return written


@pytest.mark.mpi
@pytest.mark.parametrize("case", ["sector", "triangle", "barrel"])
def test_same_mesh_on_any_number_of_ranks(meshes, case):
    compare_ranks(meshes, case, 3 if case == "barrel" else 2)


@pytest.mark.mpi
@pytest.mark.parametrize("quads", [False, True])
@pytest.mark.parametrize("order", [1, 2])
def test_same_plane_mesh_from_a_file(meshes, order, quads):
    compare_ranks(meshes, f"plane {order} {quads}", 2)


@pytest.mark.mpi
@pytest.mark.parametrize("hexahedra", [False, True])
@pytest.mark.parametrize("order", [1, 2])
def test_same_body_from_a_file(meshes, order, hexahedra):
    compare_ranks(meshes, f"body {order} {hexahedra}", 3)


def compare_ranks(meshes, case, dimension):
    found = {ranks: dict(np.load(directory / f"{case}.npz")) for ranks, directory in meshes.items()}
    one = found[1]
    names = [key for key in one if key.startswith(("facets", "nodes"))]
    assert len(names) == (12 if dimension == 3 else 8)
    for ranks, data in found.items():
        count = len(one["x"])
        np.testing.assert_array_equal(np.sort(data["owned"]), np.arange(count))
        assert (len(data["natural"]) > count) == (ranks > 1)
        positions = by_number(data["x"], data["natural"])
        np.testing.assert_array_equal(positions, by_number(one["x"], one["natural"]))
        # a node has one global number, whichever rank is asked
        by_number(data["global"][:, None], data["natural"])
        by_number(data["natural"][:, None], data["global"])
        assert len(data["cell"]) == len(one["cell"])
        cells = by_number(data["cells"], data["cell"])
        np.testing.assert_array_equal(cells, by_number(one["cells"], one["cell"]))
        for name in names:
            rows = np.unique(data[name], axis=0)
            np.testing.assert_array_equal(rows, np.unique(one[name], axis=0))
            if name.startswith("facets"):
                assert len(rows) == len(data[name]), "a facet is on two ranks"


@pytest.mark.mpi
def test_more_ranks_than_cells(run_mpi):
    run_mpi(
        4,
        """
        from mpi4py import MPI
        from porolub.mesh import build_mesh
        from tests.mesh.scenes import scene

        mesh = build_mesh(scene("block"), MPI.COMM_WORLD, along=2, across=1)
        assert mesh.global_cell_count == 2
        assert mesh.global_node_count == 15
        assert MPI.COMM_WORLD.allreduce(len(mesh.facets("top").cells)) == 2
        """,
    )


@pytest.mark.mpi
def test_more_ranks_than_cells_of_a_file(run_mpi, tmp_path):
    path = barrel_file(tmp_path / "a.msh", order=1, hexahedra=True, counts=(2, 1, 1))
    run_mpi(
        4,
        f"""
        from mpi4py import MPI
        from porolub.mesh import build_mesh
        from tests.mesh.scenes import scene

        mesh = build_mesh(scene("file", 3, path="{path}"), MPI.COMM_WORLD)
        assert mesh.global_cell_count == 2
        assert mesh.global_node_count == 45
        assert mesh.cells.shape[1] == 27
        assert MPI.COMM_WORLD.allreduce(len(mesh.facets("lubricated").cells)) == 2
        """,
    )


@pytest.mark.mpi
def test_an_error_on_rank_0_reaches_all_ranks(run_mpi, tmp_path):
    output = run_mpi(
        2,
        """
        from mpi4py import MPI
        from porolub.errors import SceneError
        from porolub.mesh import build_mesh
        from tests.mesh.scenes import scene

        try:
            build_mesh(scene("file", path="absent.msh"), MPI.COMM_WORLD)
        except SceneError as error:
            print(f"refused: {error}\\n", end="", flush=True)
        """,
    )
    assert output.count("refused: geometry.path = 'absent.msh' cannot be read") == 2


@pytest.mark.mpi
def test_run_mpi_ends_what_takes_too_long(run_mpi):
    with pytest.raises(pytest.fail.Exception, match="took longer than 2"):
        run_mpi(2, "import time; time.sleep(60)", timeout=2)
    with pytest.raises(pytest.fail.Exception, match="exit code"):
        run_mpi(2, "raise SystemExit(7)")
    run_mpi(2, "raise SystemExit(7)", code=7)
