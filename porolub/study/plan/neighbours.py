"""Which finished cases a case starts from: bisection along the axes.

Along one axis the two ends are level 0, the middle is level 1, the quarters are level 2 and so on.
A position above level 0 lies between two of lower level, its brackets. A case starts from the two
brackets along the axis on which its level is highest (the first of several), all else equal. So
neither ranks nor interruptions decide what a case starts from.
"""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porolub.study.plan.cases import Case

Bracket = tuple[int, int]
Grid = dict[Hashable, "Case"]


@cache
def bisection(count: int) -> tuple[tuple[int, Bracket], ...]:
    """Return level and brackets of the positions 0 ... count - 1; level 0 is its own bracket."""
    found = {end: (0, (end, end)) for end in (0, count - 1)}
    gaps, level = [(0, count - 1)], 0
    while gaps:
        level += 1
        halves = []
        for left, right in gaps:
            if right - left > 1:
                middle = (left + right) // 2
                found[middle] = (level, (left, right))
                halves += [(left, middle), (middle, right)]
        gaps = halves
    return tuple(found[position] for position in range(count))


def worlds(cases: Iterable["Case"]) -> list[list["Case"]]:
    """Return the cases in groups within which there may be neighbours, in their order."""
    groups: dict[Hashable, list[Case]] = {}
    for case in cases:
        groups.setdefault(_world(case), []).append(case)
    return list(groups.values())


def with_neighbours(cases: Sequence["Case"]) -> list["Case"]:
    """Return the cases with ``parents`` and ``order`` set, in the order given.

    In each world the cases must make a full grid over the axes along which there are neighbours.
    """
    ranked: dict[int, tuple[int, int, int]] = {}
    parents: dict[int, tuple[tuple[int, float], ...]] = {}
    for world in worlds(cases):
        for case, levels, found in _in_world(world):
            ranked[case.index] = (max(levels, default=0), sum(levels), case.index)
            parents[case.index] = found if case.scene is not None else ()
    first_to_last = sorted(ranked, key=ranked.__getitem__)
    order = {index: place for place, index in enumerate(first_to_last)}
    return [replace(c, parents=parents[c.index], order=order[c.index]) for c in cases]


def _world(case: "Case") -> Hashable:
    """Return what neighbours have in common: the positions along all axes that part worlds."""
    return tuple(
        place if x is None else None
        for place, x in zip(case.position, case.coordinates, strict=True)
    )


def _in_world(
    world: Sequence["Case"],
) -> Iterable[tuple["Case", list[int], tuple[tuple[int, float], ...]]]:
    """Yield each case with its levels along the axes of its world, and its parents."""
    along = [a for a, x in enumerate(world[0].coordinates) if x is not None]
    ascending = [sorted({_coordinate(case, a) for case in world}) for a in along]
    rank = [{x: i for i, x in enumerate(xs)} for xs in ascending]

    def place(case: "Case") -> tuple[int, ...]:
        return tuple(rank[n][_coordinate(case, a)] for n, a in enumerate(along))

    grid = {place(case): case for case in world}
    for here, case in grid.items():
        halvings = [bisection(len(xs))[i] for xs, i in zip(ascending, here, strict=True)]
        levels = [level for level, _ in halvings]
        if max(levels, default=0) == 0:
            yield case, levels, ()
            continue
        axis = levels.index(max(levels))
        left, right = halvings[axis][1]
        xs = ascending[axis]
        share = (xs[here[axis]] - xs[left]) / (xs[right] - xs[left])
        ends = [grid[(*here[:axis], end, *here[axis + 1 :])].index for end in (left, right)]
        yield case, levels, ((ends[0], 1.0 - share), (ends[1], share))


def _coordinate(case: "Case", axis: int) -> float:
    x = case.coordinates[axis]
    assert x is not None  # the axes along which a world extends
    return x
