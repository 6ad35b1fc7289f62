"""Cases without scenes on grids of any shape, for what only depends on where cases lie."""

from collections.abc import Sequence
from itertools import product
from typing import cast

from hypothesis import strategies as st

from porolub.scene import Scene
from porolub.study.plan.cases import Case
from porolub.study.plan.neighbours import with_neighbours

Places = Sequence[float | None]
SCENE = cast(Scene, object())  # any: nothing is asked of it


def grid(*axes: Places) -> list[Case]:
    """Return cases on a full grid; coordinates None part worlds."""
    cases = []
    for index, position in enumerate(product(*(range(len(axis)) for axis in axes))):
        where = tuple(axis[i] for axis, i in zip(axes, position, strict=True))
        cases.append(Case(index, position, {}, {}, SCENE, "", str(index), where))
    return with_neighbours(cases)


def _categories() -> st.SearchStrategy[list[None]]:
    return st.integers(1, 4).map(lambda count: [None] * count)


def _numbers() -> st.SearchStrategy[list[float]]:
    return st.lists(
        st.integers(-500, 500).map(lambda n: n / 4), min_size=1, max_size=12, unique=True
    )


def grids() -> st.SearchStrategy[list[Case]]:
    """Grids over one to three axes, numbers in any order and categories."""
    return st.lists(_numbers() | _categories(), min_size=1, max_size=3).map(
        lambda axes: grid(*axes)
    )
