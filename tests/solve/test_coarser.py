"""Numbers on coarser meshes, found from the solution on a scene's own."""

from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from porolub.mesh import build_mesh, coarsened
from porolub.scene import Scene, load_scene
from porolub.solve.coarser import with_coarser
from porolub.solve.derived import scalars
from porolub.solve.estimate import MESHES
from porolub.solve.newton import Clock
from porolub.solve.options import set_options
from porolub.solve.steady import SteadySolver
from tests.conftest import RunMPI
from tests.solve.models import JOBS, case1

COMM = MPI.COMM_SELF
SCRIPT = Path(__file__).parent / "coarser_ranks.py"


@pytest.fixture(autouse=True)
def _options() -> None:
    set_options("")


@pytest.mark.parametrize(("along", "across", "expected"), [
    (64, 8, [(32, 4), (16, 2), (8, 1), (4, 1)]), (75, 9, [(38, 5), (19, 3)]), (9, 1, [(5, 1)])])
def test_every_other_line_of_vertices_is_left_out(
    along: int, across: int, expected: list[tuple[int, int]]
) -> None:
    mesh = build_mesh(case1(along, across), COMM, edges=(0.1,), edge_size=1e-3)
    for times, counts in enumerate(expected, 1):
        coarse = coarsened(mesh, times, COMM)
        assert coarse is not None
        assert tuple(len(line) - 1 for line in coarse.vertex_ticks) == counts
        for line, fine in zip(coarse.vertex_ticks, mesh.vertex_ticks, strict=True):
            assert set(line) <= set(fine)
            assert (line[0], line[-1]) == (fine[0], fine[-1])
        assert coarse.global_cell_count == np.prod(counts)
    assert coarsened(mesh, 5, COMM) is None


def test_triangles_stay_triangles() -> None:
    mesh = build_mesh(case1(16, 2, "mesh.element=triangle"), COMM)
    coarse = coarsened(mesh, 1, COMM)
    assert coarse is not None
    assert (coarse.cell_type, coarse.global_cell_count) == ("triangle", 16)


def numbers_and_coarser(scene: Scene) -> list[float]:
    """Friction on meshes each of which halves the next, coarsest first."""
    outcome = SteadySolver(scene, COMM).solve()
    assert outcome.converged, outcome.message
    found = with_coarser(outcome.model, outcome.x, [scalars(outcome.model, outcome.x)], Clock())
    outcome.destroy()
    return [float(numbers["friction_coefficient"] or 0.0) for numbers in found]


def test_they_are_those_of_the_scene_on_such_meshes() -> None:
    """64 x 8 halves exactly, so the coarser ones are meshes a scene may have."""
    found = numbers_and_coarser(case1(64, 8))
    assert len(found) == MESHES
    for counts, value in zip([(16, 2), (32, 4)], found, strict=False):
        assert numbers_and_coarser(case1(*counts))[-1] == pytest.approx(value, rel=1e-8)


def test_what_is_known_is_not_solved_again() -> None:
    outcome = SteadySolver(case1(20, 3), COMM).solve()
    known = [{"approach": 1.0}, {"approach": 2.0}, {"approach": 3.0}]
    assert with_coarser(outcome.model, outcome.x, known, Clock()) == known[::-1]
    outcome.destroy()


def test_a_mesh_of_few_elements_has_no_coarser_ones() -> None:
    assert len(numbers_and_coarser(case1(12, 2))) == 2  # 6 x 1, and then 3 would be too few


@pytest.mark.parametrize(("job", "changes"), [
    ("case1_bonded", ["mesh.grading=contact"]), ("dry_contact", []), ("joint3d", ["mesh.deep=3"])])
def test_runs_on_small_meshes_know_their_errors(job: str, changes: list[str]) -> None:
    scene = load_scene(JOBS / f"{job}.toml", ["mesh.along=40", "mesh.across=3", *changes])
    outcome = SteadySolver(scene, COMM).solve()
    assert outcome.converged, outcome.message
    numbers = scalars(outcome.model, outcome.x)
    for name in ("approach", "load_solid", "contact_length"):
        assert 0.0 <= outcome.errors[name] < abs(numbers[name]), name
    assert outcome.errors["approach"] > 0.0
    outcome.destroy()


@pytest.mark.mpi
@pytest.mark.parametrize("ranks", [2, 3])
def test_errors_do_not_depend_on_the_ranks(run_mpi: RunMPI, ranks: int) -> None:
    """Nor on whether a coarse mesh is shared or left to one rank."""
    scenes = 2
    alone, together = (run_mpi(n, SCRIPT).split() for n in (1, ranks))
    assert len(alone) == scenes
    np.testing.assert_allclose(np.array(together, float), np.array(alone, float), rtol=1e-5)
