"""Numbers of the nodes of a tensor grid, by arithmetic: no rank needs a table of the others'.

A node has a fine index (a, b[, c]): even along an axis at vertices, odd halfway between them.
Nodes are counted kind by kind: vertices, then those odd along one axis (edges), along two
(faces, in 2D the middles of quads), along all; within a kind the first axis is slowest.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

Index = NDArray[np.int64]


def kinds(dim: int, degree: int) -> list[tuple[int, ...]]:
    """Parities of the fine index of each kind of node, in the order they are counted."""
    if degree == 1:
        return [(0,) * dim]
    return sorted(product((0, 1), repeat=dim), key=lambda odd: (sum(odd), [-o for o in odd]))


def _first(low: Index, odd: int) -> Index:
    """Smallest fine index of that parity from `low` on."""
    return low + ((odd - low) & 1)


def _many(low: Index, high: Index, odd: int) -> Index:
    """How many fine indices of that parity lie in [low, high]."""
    return np.maximum(0, (high - _first(low, odd)) // 2 + 1)


def count(low: Index, high: Index, degree: int) -> Index:
    """Nodes (...) with fine indices in the boxes [low, high], both (..., dim)."""
    low, high = np.asarray(low), np.asarray(high)
    return sum(
        (
            np.prod([_many(low[..., k], high[..., k], o) for k, o in enumerate(odd)], axis=0)
            for odd in kinds(low.shape[-1], degree)
        ),
        np.zeros(low.shape[:-1], dtype=np.int64),
    )


def numbers(index: Index, low: Index, high: Index) -> Index:
    """Numbers (...) of fine indices (..., dim) among those of the box [low, high].

    `low` and `high` are (dim,), or (..., dim) where each node is counted in a box of its own.
    """
    low, high = np.asarray(low), np.asarray(high)
    dim = index.shape[-1]
    parity = index & 1
    result = np.empty(index.shape[:-1], dtype=np.int64)
    offset: Index = np.zeros((), dtype=np.int64)
    for odd in kinds(dim, 2):
        number: Index = np.zeros((), dtype=np.int64)
        size: Index = np.ones((), dtype=np.int64)
        for k, o in enumerate(odd):
            many = _many(low[..., k], high[..., k], o)
            number = number * many + (index[..., k] - _first(low[..., k], o)) // 2
            size = size * many
        of_kind = (parity == odd).all(axis=-1)
        result[of_kind] = (offset + number)[of_kind]
        offset = offset + size
    return result


def nodes(low: Sequence[int], high: Sequence[int], degree: int) -> Index:
    """Fine indices (n, dim) of the nodes in the box [low, high], in the order of `numbers`."""
    parts = []
    for odd in kinds(len(low), degree):
        box = zip(low, high, odd, strict=True)
        axes = [np.arange(a + ((o - a) & 1), b + 1, 2) for a, b, o in box]
        grid = np.meshgrid(*axes, indexing="ij")
        parts.append(np.stack([axis.ravel() for axis in grid], axis=1))
    return np.vstack(parts).astype(np.int64)
