"""The cases of a sweep in parts that know nothing of each other, for arrays of jobs."""

import re
from collections.abc import Sequence

from porolub.errors import SceneError
from porolub.study.plan.cases import Case
from porolub.study.plan.neighbours import with_neighbours, worlds

World = Sequence[Case]

WHOLE_WORLDS_WITHIN = 0.1
"""Relative imbalance of a cut that is accepted to keep worlds whole: they share no starts."""


def read_part(text: str) -> tuple[int, int]:
    """Return ``"3/8"`` as (3, 8), the third of eight parts. Raises SceneError."""
    match = re.fullmatch(r"\s*(\d+)\s*/\s*(\d+)\s*", text)
    part, parts = (int(match[1]), int(match[2])) if match else (0, 0)
    if not 1 <= part <= parts:
        raise SceneError(f"--part {text}: K/N is needed with 1 <= K <= N, such as 3/8.")
    return part, parts


def part_of(cases: Sequence[Case], part: int, parts: int) -> list[Case]:
    """Return the cases of the ``part``-th of ``parts`` parts, counted from 1, in their order.

    Each part is a block of neighbours and finds its starts within itself: its corners start from
    zero. Cases keep their index and key. The parts are as equal as the axes allow; with more parts
    than cases some are empty.
    """
    mine = {case.index for world in _cut(worlds(cases), part - 1, parts) for case in world}
    return with_neighbours([case for case in cases if case.index in mine])


def _cut(blocks: Sequence[World], part: int, parts: int) -> Sequence[World]:
    """Return one of ``parts`` parts, counted from 0: halve until it is found."""
    if parts == 1 or not blocks:
        return blocks
    first = parts // 2
    low, high = _halves(blocks, first / parts)
    return _cut(low, part, first) if part < first else _cut(high, part - first, parts - first)


def _halves(blocks: Sequence[World], share: float) -> tuple[list[World], list[World]]:
    """Cut off a share of the cases: whole worlds if that comes out even, or along an axis."""
    axes = range(len(blocks[0][0].position))
    extents = {None: len(blocks)} | {a: max(len(_along(w, a)) for w in blocks) for a in axes}
    astray = {a: abs(round(n * share) / n - share) / share for a, n in extents.items()}
    best = min(extents, key=lambda a: (round(astray[a], 12), -extents[a]))
    if astray[None] <= WHOLE_WORLDS_WITHIN or best is None:
        count = round(len(blocks) * share)
        return list(blocks[:count]), list(blocks[count:])
    low: list[World] = []
    high: list[World] = []
    for world in blocks:
        places = _along(world, best)
        kept = set(places[: round(len(places) * share)])
        low.append([case for case in world if case.coordinates[best] in kept])
        high.append([case for case in world if case.coordinates[best] not in kept])
    return [w for w in low if w], [w for w in high if w]


def _along(world: World, axis: int) -> list[float]:
    """Return the coordinates of a world along an axis, ascending; none where it has no extent."""
    found = {x for case in world if (x := case.coordinates[axis]) is not None}
    return sorted(found) or [0.0]
