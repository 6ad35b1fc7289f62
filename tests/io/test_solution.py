"""Solutions on disk: what comes back, from whatever number of ranks, and what is no solution."""

from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from porolub.errors import SceneError, SolveError
from porolub.io.solution import read_solution, write_solution
from porolub.solve.neighbours import Solution
from porolub.solve.transfer import Snapshot

SCRIPT = Path(__file__).with_name("solution_ranks.py")


def made_up(scalars: dict[str, float], marks: dict[str, float]) -> Solution:
    random = np.random.default_rng(5)
    ticks = (np.sort(random.random(13)), np.linspace(0.0, 1.0, 4))
    rows = {"u": random.normal(size=(175, 2)), "p": random.normal(size=(52, 1)) * 1e6}
    edges = (-0.004, 0.005) if marks else ()
    return Solution(Snapshot(ticks, rows, scalars, False), 0.0175, edges, marks)


WHOLE = made_up({"v0": 1.1e-4}, {"closed 0": -0.004, "pressurised 0": -0.003, "closed 1": 0.1 / 3})
PLAIN = made_up({}, {})


def assert_same(found: Solution, expected: Solution) -> None:
    assert replace(found, data=expected.data) == expected
    assert found.data.scalars == expected.data.scalars
    assert found.data.shared == expected.data.shared
    assert set(found.data.rows) == set(expected.data.rows)
    for name, rows in expected.data.rows.items():
        np.testing.assert_array_equal(found.data.rows[name], rows)
    for line, ticks in zip(found.data.ticks, expected.data.ticks, strict=True):
        np.testing.assert_array_equal(line, ticks)


@pytest.mark.parametrize("solution", [WHOLE, PLAIN], ids=["in contact", "nothing but fields"])
def test_it_comes_back_as_it_was(tmp_path: Path, solution: Solution) -> None:
    path = tmp_path / "state.h5"
    write_solution(path, PLAIN)
    write_solution(path, solution)  # in its place
    assert_same(read_solution(path), solution)
    assert [p.name for p in tmp_path.iterdir()] == ["state.h5"]


def test_a_missing_file_is_an_error_of_input(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"gone\.h5: this is no solution to start from"):
        read_solution(tmp_path / "gone.h5")


def test_a_file_that_ends_early_is_no_solution(tmp_path: Path) -> None:
    path = tmp_path / "state.h5"
    write_solution(path, WHOLE)
    whole = path.read_bytes()
    for size in [*range(0, 2000, 50), *range(2000, len(whole), 400), len(whole) - 1]:
        path.write_bytes(whole[:size])
        with pytest.raises(SceneError, match="no solution to start from"):
            read_solution(path)


def remove(name: str):
    def damage(file: h5py.File) -> None:
        del file[name]

    return damage


def put(name: str, what: object):
    def damage(file: h5py.File) -> None:
        del file[name]
        file[name] = what

    return damage


DAMAGES = {
    "no rows": remove("rows"),
    "no marks": remove("marks"),
    "no ticks along the first axis": remove("ticks/0"),
    "no length": lambda file: file.attrs.__delitem__("length"),
    "length in words": lambda file: file.attrs.__setitem__("length", "17 mm"),
    "several lengths": lambda file: file.attrs.__setitem__("length", np.ones(3)),
    "one edge": put("edges", 0.004),
    "rows that are numbers": put("rows", np.ones(3)),
    "a field that is a number": put("rows/p", 3.0),
    "a field of fields": put("rows/p", h5py.SoftLink("/ticks")),
    "a field that leads nowhere": put("rows/p", h5py.SoftLink("/nowhere")),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_file_that_holds_something_else_is_no_solution(tmp_path: Path, damage: str) -> None:
    path = tmp_path / "state.h5"
    write_solution(path, WHOLE)
    with h5py.File(path, "a") as file:
        DAMAGES[damage](file)
    with pytest.raises(SceneError, match=r"state\.h5: this is no solution to start from"):
        read_solution(path)


def test_any_other_file_is_no_solution(tmp_path: Path) -> None:
    path = tmp_path / "state.h5"
    path.write_text("key = 'value'\n" * 500)
    with pytest.raises(SceneError, match="no solution to start from"):
        read_solution(path)
    path.unlink()
    path.mkdir()
    with pytest.raises(SceneError, match="no solution to start from"):
        read_solution(path)


def test_where_it_cannot_be_written_the_scene_is_not_to_blame(tmp_path: Path) -> None:
    with pytest.raises(SolveError, match="cannot be written"):
        write_solution(tmp_path / "nowhere" / "state.h5", WHOLE)


@pytest.mark.mpi
def test_any_number_of_ranks_reads_what_any_other_wrote(run_mpi, tmp_path: Path) -> None:
    """Each run reads what it and those before it wrote; all have written the same bytes."""
    for ranks in (1, 2, 4):
        assert "all alike" in run_mpi(ranks, SCRIPT, tmp_path)
    files = sorted(tmp_path.glob("?.h5"))
    assert [path.stem for path in files] == ["1", "2", "4"]
    assert len({path.read_bytes() for path in files}) == 1


@pytest.mark.mpi
def test_all_ranks_know_of_a_file_that_is_none(run_mpi, tmp_path: Path) -> None:
    output = run_mpi(2, f"""
        from pathlib import Path
        from mpi4py import MPI
        from porolub.errors import SceneError
        from porolub.io.solution import read_solution
        COMM = MPI.COMM_WORLD
        try:
            read_solution(Path({str(tmp_path)!r}) / "gone.h5", COMM)
        except SceneError as error:
            print(f"rank {{COMM.rank}}: {{error}}", flush=True)
        """, timeout=60)
    for rank in range(2):
        assert f"rank {rank}: {tmp_path}/gone.h5: this is no solution" in output
