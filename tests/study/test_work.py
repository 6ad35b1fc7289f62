"""What is handed out when: every case once, parents first, whatever becomes of them."""

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.errors import Interrupted, PorolubError, SolveError
from porolub.study.plan.cases import Case
from porolub.study.work.tasks import End, Row, Task, Wait, Work
from tests.study.grids import SCENE, grid, grids

Parents = Mapping[int, tuple[tuple[int, float], ...]]


def case(index: int, order: int, *parents: tuple[int, float]) -> Case:
    return Case(index, (index,), {}, {}, SCENE, "", f"key {index}", (), parents, order)


def row(case: Case, status: str = "converged") -> Row:
    return {"case": case.index, "key": case.key, "status": status}


def take(work: Work) -> Task:
    task = work.next(0)
    assert isinstance(task, Task)
    return task


def indices(work: Work) -> list[int]:
    """The order in which one group does all cases."""
    found = []
    while isinstance(task := work.next(0), Task):
        found.append(task.case.index)
        work.done(row(task.case), 0)
    assert isinstance(task, End)
    return found


CHAIN = [case(0, 1), case(1, 0), case(2, 2, (0, 0.25), (1, 0.75)), case(3, 3, (1, 0.5), (2, 0.5))]


def test_cases_come_in_their_order_not_that_of_their_numbers() -> None:
    assert indices(Work(CHAIN, {})) == [1, 0, 2, 3]


def test_a_curve_begins_with_its_ends_then_its_middle() -> None:
    assert indices(Work(grid([float(k) for k in range(9)]), {})) == [0, 8, 4, 2, 6, 1, 3, 5, 7]


def test_a_case_waits_for_all_it_starts_from() -> None:
    work = Work(CHAIN, {})
    first, second = take(work), take(work)
    assert work.left == 2
    assert work.next(0) == work.next(1) == Wait()
    work.done(row(first.case), 0)
    assert work.next(0) == Wait()
    work.done(row(second.case), 1)
    third = take(work)
    assert third.starts == ((0, "key 0", 0.25), (1, "key 1", 0.75))
    assert work.next(1) == Wait()
    work.done(row(third.case), 0)
    assert take(work).starts == ((1, "key 1", 0.5), (2, "key 2", 0.5))
    assert work.next(0) == work.next(1) == End()  # what is under way is another's


def test_a_case_that_can_begin_is_not_kept_by_one_that_cannot() -> None:
    cases = [case(0, 0), case(1, 1, (0, 1.0)), case(2, 2)]
    work = Work(cases, {})
    assert [take(work).case.index, take(work).case.index] == [0, 2]


@pytest.mark.parametrize("status", ["failed", "refused"])
def test_the_weights_of_failed_parents_go_to_the_others(status: str) -> None:
    cases = [case(k, k) for k in range(4)]
    cases.append(case(4, 4, (0, 0.5), (1, 0.2), (2, 0.3)))
    cases.append(case(5, 5, (1, 0.4), (3, 0.6)))
    work = Work(cases, {})
    for k in range(4):
        work.done(row(take(work).case, status if k in (1, 3) else "converged"), 0)
    starts = take(work).starts
    assert [(i, key) for i, key, _ in starts] == [(0, "key 0"), (2, "key 2")]
    assert [w for *_, w in starts] == pytest.approx([0.625, 0.375])
    assert take(work).starts == ()  # from zero


def test_a_parent_of_no_weight_is_no_start() -> None:
    work = Work([case(0, 0), case(1, 1), case(2, 2, (0, 0.0), (1, 1.0))], {})
    for status in ("converged", "failed"):
        work.done(row(take(work).case, status), 0)
    assert take(work).starts == ()


def test_rows_from_before_are_neither_done_again_nor_waited_for() -> None:
    before = {"key 0": row(CHAIN[0]), "key 1": row(CHAIN[1], "failed")}
    work = Work(CHAIN, before)
    assert work.left == 2
    task = take(work)
    assert (task.case.index, task.starts) == (2, ((0, "key 0", 1.0),))
    assert indices(Work(CHAIN, {c.key: row(c) for c in CHAIN})) == []


def test_a_state_is_kept_only_where_others_will_start_from_it() -> None:
    wanted = {}
    work = Work(CHAIN, {})
    while isinstance(task := work.next(0), Task):
        wanted[task.case.index] = task.wanted
        work.done(row(task.case), 0)
    assert wanted == {0: True, 1: True, 2: True, 3: False}
    again = Work(CHAIN, {"key 3": row(CHAIN[3])})  # its parents need not be there for it
    assert take(again).wanted  # for case 2
    assert not take(Work(CHAIN, {c.key: row(c) for c in CHAIN[:1] + CHAIN[2:]})).wanted


@pytest.mark.parametrize("problem", [Interrupted("Interrupted by SIGTERM"), SolveError("full")])
def test_a_problem_ends_the_work_and_the_first_one_counts(problem: PorolubError) -> None:
    work = Work(CHAIN, {})
    first = take(work)
    work.stop(problem)
    work.stop(SolveError("later"))
    assert work.next(0) == work.next(1) == End()
    assert work.problem is problem
    work.done(row(first.case), 0)  # computed in the meantime: kept, and nothing follows
    assert work.next(0) == End()


def fails(error: Exception) -> Callable[..., None]:
    def call(*_: Any) -> None:
        raise error

    return call


@pytest.mark.parametrize("where", ["begun", "note", "refresh"])
def test_what_cannot_be_written_ends_the_work(where: str) -> None:
    full = SolveError("journal.jsonl: No space left on device")
    work = Work(CHAIN, {}, **{where: fails(full)})
    work.done(row(take(work).case), 0)
    work.refresh()
    assert work.problem is full
    assert work.next(0) == End()


def test_no_defect_of_the_ledger_leaves_groups_without_an_answer(caplog) -> None:
    work = Work(CHAIN, {}, note=fails(ZeroDivisionError("division by zero")))
    work.done(row(take(work).case), 0)
    assert work.next(1) == End()
    assert str(work.problem).startswith("ZeroDivisionError: division by zero")
    assert "Traceback" in caplog.text


def test_the_ledger_hears_of_every_case_and_group() -> None:
    heard: list[tuple[str, int, int]] = []
    work = Work(CHAIN, {}, lambda c, group: heard.append(("begun", c.index, group)),
                lambda r, group: heard.append((r["status"], r["case"], group)))
    one, two = work.next(3), work.next(5)
    work.done(row(two.case, "failed"), 5)
    work.done(row(one.case), 3)
    assert heard == [("begun", 1, 3), ("begun", 0, 5), ("failed", 0, 5), ("converged", 1, 3)]


@st.composite
def trees(draw: st.DrawFn) -> list[Case]:
    """Cases that start from any earlier ones, in any order of their numbers."""
    count = draw(st.integers(1, 25))
    number = draw(st.permutations(range(count)))
    cases = []
    for order in range(count):
        earlier = st.lists(st.integers(0, order - 1), max_size=3, unique=True)
        chosen = draw(earlier) if order else []
        parents = tuple((number[p], 1.0 / len(chosen)) for p in chosen)
        cases.append(case(number[order], order, *parents))
    return sorted(cases, key=lambda c: c.index)


@given(trees() | grids(), st.data())
def test_each_case_is_handed_out_once_and_after_its_parents(cases: list[Case], data) -> None:
    """Whoever finishes first, and whatever fails; never a wait without anything under way."""
    work, under_way, begun = Work(cases, {}), [], []
    done: dict[int, str] = {}
    while True:
        task = work.next(0)
        if isinstance(task, Task):
            begun.append(task.case.index)
            assert all(parent in done for parent, _ in task.case.parents)
            good = [p for p, _ in task.case.parents if done[p] == "converged"]
            assert [index for index, *_ in task.starts] == good
            assert sum(w for *_, w in task.starts) == pytest.approx(float(bool(good)))
            under_way.append(task.case)
        elif not under_way:
            assert isinstance(task, End)
            break
        if under_way and (not isinstance(task, Task) or data.draw(st.booleans())):
            case = under_way.pop(data.draw(st.integers(0, len(under_way) - 1)))
            done[case.index] = data.draw(st.sampled_from(["converged", "failed"]))
            work.done(row(case, done[case.index]), 0)
    assert sorted(begun) == sorted(c.index for c in cases)


@given(trees() | grids(), st.integers(2, 12))
def test_many_threads_share_the_work(cases: list[Case], count: int) -> None:
    """Each case once; the ledger is never told two things at a time."""
    inside, most, noted = 0, 0, []

    def alone(*told: Any) -> None:
        nonlocal inside, most
        inside += 1
        most = max(most, inside)
        time.sleep(0)  # let another thread in, if it may
        if isinstance(told[0], dict):
            noted.append(told[0]["case"])
        inside -= 1

    work = Work(cases, {}, alone, alone)
    by_index = {c.index: c for c in cases}
    problems: list[BaseException] = []

    def group(number: int) -> None:
        try:
            while not problems and not isinstance(task := work.next(number), End):
                if isinstance(task, Task):
                    parents = by_index[task.case.index].parents
                    assert {p for p, _ in parents} <= set(noted)
                    work.done(row(task.case), number)
        except BaseException as problem:
            problems.append(problem)

    threads = [threading.Thread(target=group, args=(k,), daemon=True) for k in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20.0)
        assert not thread.is_alive()
    assert problems == []
    assert sorted(noted) == sorted(by_index)
    assert most == 1
