"""Neighbours come from bisecting the axes, whatever the order of the values in the file."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.study.plan.cases import Case
from porolub.study.plan.neighbours import bisection, worlds
from tests.study.grids import grid, grids


def parents(*axes: list[float | None]) -> list[tuple[tuple[int, float], ...]]:
    return [case.parents for case in grid(*axes)]


def test_bisection_halves_until_nothing_is_left() -> None:
    levels = [level for level, _ in bisection(9)]
    assert levels == [0, 3, 2, 3, 1, 3, 2, 3, 0]
    assert bisection(9)[3] == (3, (2, 4))
    assert bisection(9)[4] == (1, (0, 8))
    assert bisection(1) == ((0, (0, 0)),)
    assert [level for level, _ in bisection(2)] == [0, 0]


@given(st.integers(1, 400))
def test_brackets_are_of_lower_level_on_both_sides(count: int) -> None:
    found = bisection(count)
    assert len(found) == count
    for place, (level, (left, right)) in enumerate(found):
        if level == 0:
            assert place in (0, count - 1)
        else:
            assert left < place < right
            assert max(found[left][0], found[right][0]) < level
    assert max(level for level, _ in found) <= count.bit_length()


def test_along_one_axis_the_weights_follow_the_numbers() -> None:
    assert parents([0.0, 1.0, 4.0]) == [(), ((0, 0.75), (2, 0.25)), ()]
    assert parents([4.0, 0.0, 1.0]) == [(), (), ((1, 0.75), (0, 0.25))]


def test_over_two_axes_the_finer_one_is_taken_the_first_of_equals() -> None:
    found = parents([0.0, 1.0, 2.0], [0.0, 1.0, 2.0, 3.0, 4.0])
    assert found[0] == found[4] == found[10] == found[14] == ()
    assert found[2] == ((0, 0.5), (4, 0.5))  # on an edge
    assert found[7] == ((2, 0.5), (12, 0.5))  # both axes have level 1: the first one
    assert found[6] == ((5, 0.5), (7, 0.5))  # the second axis has level 2


def test_categories_part_worlds() -> None:
    found = parents([None, None], [0.0, 1.0, 2.0])
    assert found == [(), ((0, 0.5), (2, 0.5)), (), (), ((3, 0.5), (5, 0.5)), ()]


def test_without_coordinates_work_goes_in_the_order_of_the_cases() -> None:
    cases = grid([None] * 5, [None] * 3)
    assert [case.order for case in cases] == list(range(15))
    assert all(case.parents == () for case in cases)


def test_coarse_levels_come_first() -> None:
    cases = grid([float(n) for n in range(9)])
    work = sorted(cases, key=lambda case: case.order)
    assert [case.index for case in work] == [0, 8, 4, 2, 6, 1, 3, 5, 7]


@given(grids())
def test_parents_precede_children(cases: list[Case]) -> None:
    assert sorted(case.order for case in cases) == list(range(len(cases)))
    for case in cases:
        assert all(cases[parent].order < case.order for parent, _ in case.parents)


@given(grids())
def test_weights_reproduce_where_a_case_lies(cases: list[Case]) -> None:
    for case in cases:
        if not case.parents:
            continue
        assert sum(weight for _, weight in case.parents) == pytest.approx(1.0, abs=1e-15)
        for axis, x in enumerate(case.coordinates):
            places = [(cases[parent].coordinates[axis], w) for parent, w in case.parents]
            if x is not None:
                between = sum(place * w for place, w in places if place is not None)
                assert between == pytest.approx(x, abs=1e-12)


@given(grids())
def test_no_parent_lies_across_categories(cases: list[Case]) -> None:
    world_of = {case.index: n for n, world in enumerate(worlds(cases)) for case in world}
    for case in cases:
        for parent, weight in case.parents:
            assert 0 < weight < 1
            assert world_of[parent] == world_of[case.index]
            differs = [a != b for a, b in zip(case.position, cases[parent].position, strict=True)]
            assert sum(differs) == 1


@given(grids())
def test_every_case_goes_back_to_a_start_from_zero(cases: list[Case]) -> None:
    roots = {case.index for case in cases if not case.parents}
    reached = set(roots)
    for case in sorted(cases, key=lambda case: case.order):
        if all(parent in reached for parent, _ in case.parents):
            reached.add(case.index)
    assert len(reached) == len(cases)
    along = [x is not None for x in cases[0].coordinates]
    assert len(roots) <= len(worlds(cases)) * 2 ** sum(along)
