"""The work queue under mpirun: each case is done once, and all ranks come to an end."""

import json
from pathlib import Path
from typing import Any

import pytest
from mpi4py import MPI

from porolub.errors import SceneError
from porolub.study.work.queue import Queue
from porolub.study.work.tasks import Work
from tests.study.grids import grid

SCRIPT = Path(__file__).with_name("queue_ranks.py")
AT_MOST = 60.0  # s, on a busy machine; alone 2 s
CASES = grid([float(k) for k in range(8)], [float(k) for k in range(5)])
ALL = {case.index for case in CASES}


def ranks(run_mpi, directory: Path, count: int, *what: str) -> list[dict[str, Any]]:
    """What each rank has to say, in their order."""
    run_mpi(count, SCRIPT, *what, timeout=AT_MOST)
    return [json.loads((directory / f"rank-{k}.json").read_text()) for k in range(count)]


def assert_once(said: list[dict[str, Any]]) -> None:
    """Each case begun and noted once, by the group that did it, its parents before it."""
    begun, noted = said[0]["begun"], said[0]["noted"]
    done = [(index, one["rank"]) for one in said for index in one["mine"]]
    assert {index for index, _ in noted} == ALL
    assert len(noted) == len(begun) == len(done) == len(ALL)
    assert sorted(map(tuple, begun)) == sorted(map(tuple, noted))
    place = {index: k for k, (index, _) in enumerate(begun)}
    assert all(place[p] < place[case.index] for case in CASES for p, _ in case.parents)


@pytest.mark.mpi
@pytest.mark.parametrize("count", [2, 3])
def test_each_case_is_done_once_and_all_groups_have_their_share(
    run_mpi, tmp_path: Path, count: int
) -> None:
    said = ranks(run_mpi, tmp_path, count, "all")
    assert_once(said)
    assert all(dict(map(tuple, said[0]["noted"]))[i] == one["rank"]
               for one in said for i in one["mine"])  # fmt: skip
    assert min(len(one["mine"]) for one in said) > len(ALL) / (4 * count)
    assert [one["problem"] for one in said] == [""] * count


@pytest.mark.mpi
def test_groups_of_two_ranks_and_one_that_is_left_over(run_mpi, tmp_path: Path) -> None:
    said = ranks(run_mpi, tmp_path, 5, "all", "pairs")
    assert {index for one in said for index in one["mine"]} == ALL
    assert sum(len(one["mine"]) for one in said) == len(ALL)
    assert [one["rank"] for one in said if one["mine"]] == [0, 2]
    assert {group for _, group in said[0]["noted"]} == {0, 1}


@pytest.mark.mpi
@pytest.mark.parametrize(("count", "group"), [(2, 0), (3, 2)])
def test_any_group_can_end_the_work_of_all(run_mpi, tmp_path: Path, count: int, group: int) -> None:
    """Cases under way elsewhere are finished and kept."""
    said = ranks(run_mpi, tmp_path, count, f"stop from {group}")
    assert said[0]["problem"] == f"asked by group {group}"
    assert len(said[group]["mine"]) == 3
    done = sorted(index for one in said for index in one["mine"])
    assert len(done) < len(ALL) / 2
    assert sorted(index for index, _ in said[0]["noted"]) == done
    assert len(said[0]["begun"]) == len(done) + 1  # and the one given up


@pytest.mark.mpi
@pytest.mark.parametrize(
    ("what", "problem"),
    [("disk full", "journal.jsonl: No space left"), ("defect", "ZeroDivisionError: division")],
)
def test_a_ledger_that_cannot_be_kept_ends_the_work(
    run_mpi, tmp_path: Path, what: str, problem: str
) -> None:
    """Also where it is the thread that answers the others who finds out."""
    said = ranks(run_mpi, tmp_path, 3, what)
    assert said[0]["problem"].startswith(problem)
    assert len(said[0]["noted"]) == 5
    assert len(said[0]["begun"]) <= 5 + 3


@pytest.mark.mpi
def test_an_exception_on_rank_0_leaves_nobody_waiting(run_mpi, tmp_path: Path) -> None:
    said = ranks(run_mpi, tmp_path, 3, "exception")
    assert said[0]["ended"] == "on rank 0"
    assert said[0]["problem"] == "ended by ZeroDivisionError on rank 0"
    assert [one["ended"] for one in said[1:]] == ["", ""]
    assert len(said[0]["begun"]) < len(ALL)


def test_one_group_does_all_in_their_order() -> None:
    work = Work(CASES, {})
    with Queue(MPI.COMM_SELF, 0, 1, work) as queue:
        done = []
        for task in queue.tasks():
            done.append(task.case.order)
            queue.done({"case": task.case.index, "key": task.case.key, "status": "converged"})
    assert done == list(range(len(CASES)))
    assert work.problem is None


def test_without_threads_of_mpi_ranks_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MPI, "Query_thread", lambda: MPI.THREAD_SERIALIZED)
    with pytest.raises(SceneError, match="MPI_THREAD_MULTIPLE"):
        Queue(MPI.COMM_SELF, 0, 2)
    with Queue(MPI.COMM_SELF, 0, 1, Work(grid([1.0]), {})) as queue:  # one group has no need
        assert [task.case.index for task in queue.tasks()] == [0]
