"""Parts of a sweep: disjoint, together all, equal in size, each with its own starts."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.errors import SceneError
from porolub.study.plan.cases import Case
from porolub.study.plan.parts import part_of, read_part
from tests.study.grids import grid, grids


def indices(cases: list[Case], parts: int) -> list[list[int]]:
    return [[case.index for case in part_of(cases, k, parts)] for k in range(1, parts + 1)]


def test_a_curve_is_cut_into_pieces_of_equal_length() -> None:
    cases = grid([float(n) for n in range(12)])
    assert indices(cases, 3) == [list(range(4)), list(range(4, 8)), list(range(8, 12))]


def test_pieces_follow_the_numbers_not_the_file() -> None:
    cases = grid([3.0, 1.0, 0.0, 2.0])
    assert indices(cases, 2) == [[1, 2], [0, 3]]


def test_worlds_stay_whole_where_that_is_even() -> None:
    cases = grid([0.0, 1.0, 2.0], [None] * 4)
    first, second = indices(cases, 2)
    assert first == [0, 1, 4, 5, 8, 9]
    assert second == [2, 3, 6, 7, 10, 11]


def test_worlds_are_cut_where_they_would_be_uneven() -> None:
    cases = grid([None] * 3, [float(n) for n in range(8)])
    assert [len(part) for part in indices(cases, 2)] == [12, 12]


def test_a_part_finds_its_starts_within_itself() -> None:
    cases = grid([float(n) for n in range(11)])
    part = part_of(cases, 2, 2)
    assert [case.index for case in part] == [6, 7, 8, 9, 10]
    assert [case.index for case in part if not case.parents] == [6, 10]
    assert part[2].parents == ((6, 0.5), (10, 0.5))


def test_all_is_one_part_of_one() -> None:
    cases = grid([0.0, 1.0, 2.0], [None] * 2)
    assert part_of(cases, 1, 1) == cases


@given(grids(), st.integers(1, 9))
def test_parts_are_all_of_the_sweep_once(cases: list[Case], parts: int) -> None:
    found = sorted(index for part in indices(cases, parts) for index in part)
    assert found == list(range(len(cases)))


@given(grids(), st.integers(1, 9))
def test_parents_are_in_the_same_part_and_come_first(cases: list[Case], parts: int) -> None:
    for k in range(1, parts + 1):
        part = {case.index: case for case in part_of(cases, k, parts)}
        assert sorted(case.order for case in part.values()) == list(range(len(part)))
        for case in part.values():
            assert all(part[parent].order < case.order for parent, _ in case.parents)
            assert (case.key, case.position) == (cases[case.index].key, cases[case.index].position)


@given(st.integers(1, 60), st.integers(1, 9))
def test_parts_of_a_curve_differ_by_few_cases(count: int, parts: int) -> None:
    sizes = [len(part) for part in indices(grid([float(n) for n in range(count)]), parts)]
    assert max(sizes) - min(sizes) <= 2


def test_a_map_is_cut_evenly() -> None:
    cases = grid(*[[float(n) for n in range(10)]] * 2)
    assert [len(part) for part in indices(cases, 4)] == [25] * 4
    assert max(map(len, indices(cases, 8))) <= 15


@pytest.mark.parametrize("text", ["0/3", "4/3", "1", "a/b", "1/0", "-1/3", "1/3/4", ""])
def test_impossible_parts_are_refused(text: str) -> None:
    with pytest.raises(SceneError, match="1 <= K <= N"):
        read_part(text)


def test_a_part_is_read() -> None:
    assert read_part("3/8") == (3, 8)
