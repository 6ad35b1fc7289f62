"""Which rank has which columns of a structured mesh, by arithmetic.

A column is all cells across the layer at one place of the surface. Ranks form a grid over the
surface (along x deep), each has a rectangle of whole columns: as many cells as the others, as
many facets of the lubricated surface, and little in common with its neighbours.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from porolub.mesh import lattice

Index = NDArray[np.int64]


def rank_grid(along: int, deep: int, ranks: int) -> tuple[int, int]:
    """Ranks along and deep for along x deep columns, their product `ranks`.

    The least of: columns of the fullest rank + columns that the ranks have in common / ranks.
    """

    def cost(first: int) -> tuple[float, int]:
        second = ranks // first
        fullest = -(-along // first) * -(-deep // second)
        cuts = (min(first, along) - 1) * deep + (min(second, deep) - 1) * along
        return fullest + cuts / ranks, -first

    first = min((n for n in range(1, ranks + 1) if ranks % n == 0), key=cost)
    return first, ranks // first


def _split(count: int, parts: int) -> Index:
    """First cell of each part and the end (parts + 1,): sizes differ by at most one."""
    small, more = divmod(count, parts)
    return np.concatenate([[0], np.cumsum(small + (np.arange(parts) < more))]).astype(np.int64)


@dataclass(frozen=True)
class Columns:
    """The columns of `counts` cells along, across (and deep) on `ranks` ranks.

    A node between ranks belongs to the one below it along and deep.
    """

    counts: tuple[int, ...]
    ranks: int

    @cached_property
    def _splits(self) -> tuple[Index, ...]:
        """Where each axis is cut."""
        deep = self.counts[2] if len(self.counts) == 3 else 1
        first, second = rank_grid(self.counts[0], deep, self.ranks)
        whole = np.array([0, self.counts[1]])
        return (_split(self.counts[0], first), whole, _split(deep, second))[: len(self.counts)]

    def _places(self, rank: Index) -> list[Index]:
        """Which part of each axis a rank has."""
        second = 1 if len(self.counts) == 2 else len(self._splits[2]) - 1
        return [rank // second, 0 * rank, rank % second][: len(self.counts)]

    def box(self, rank: int) -> tuple[Index, Index]:
        """First cell and end of a rank's columns along each axis, (dim,) each."""
        place = self._places(np.asarray(rank))
        return (
            np.array([cut[p] for cut, p in zip(self._splits, place, strict=True)]),
            np.array([cut[p + 1] for cut, p in zip(self._splits, place, strict=True)]),
        )

    def owned(self, ranks: Index) -> tuple[Index, Index]:
        """Boxes [low, high] of fine node indices that ranks (...) own, (..., dim) each."""
        place = self._places(np.asarray(ranks))
        starts = [cut[p] for cut, p in zip(self._splits, place, strict=True)]
        low = np.stack([2 * start + (start > 0) for start in starts], axis=-1)
        ends = [2 * cut[p + 1] for cut, p in zip(self._splits, place, strict=True)]
        return low, np.stack(ends, axis=-1)

    def owners(self, index: Index) -> Index:
        """Ranks (n,) that own the nodes with fine indices (n, dim)."""
        below = np.maximum((index - 1) // 2, 0)
        place = [
            np.searchsorted(cut, below[:, k], side="right") - 1
            for k, cut in enumerate(self._splits)
        ]
        if len(place) == 2:
            return place[0]
        return place[0] * (len(self._splits[2]) - 1) + place[2]

    def starts(self, degree: int) -> Index:
        """Number (ranks,) of the first node each rank owns."""
        many = lattice.count(*self.owned(np.arange(self.ranks)), degree)
        return np.concatenate([[0], np.cumsum(many)[:-1]])
