"""What a sparse LU factorisation costs, by counting a nested dissection instead of doing it.

A brick of elements is cut in two by the smallest plane of nodes, and the halves likewise, down to
one element. Eliminating the s unknowns of a plane (or of an element) that has b unknowns of
earlier planes around it makes a dense front of s + b rows:

    entries of L and U   s^2 + 2 s b
    operations           2/3 s^3 + 2 s^2 b + 2 s b^2

Summed over all fronts this has the known limits (George, SIAM J. Numer. Anal. 10, 1973): n log n
entries and n^(3/2) operations in the plane, n^(4/3) and n^2 in space; thin layers are between.
"""

from dataclasses import dataclass
from functools import cache
from math import prod

Axis = tuple[int, int]  # elements, and how many of the two ends belong to the brick
Fields = tuple[tuple[int, int], ...]  # components and degree of each


@dataclass(frozen=True)
class Factors:
    """Entries of L and U together, and floating-point operations."""

    entries: float
    operations: float

    def __add__(self, other: "Factors") -> "Factors":
        return Factors(self.entries + other.entries, self.operations + other.operations)


def factors(elements: tuple[int, ...], fields: Fields) -> Factors:
    """Count the factorisation of a brick of ``elements`` (along each axis) with nodal fields.

    ``fields`` are pairs of the number of components and the degree (1, 2) of the elements.
    """
    return _brick(tuple(sorted((n, 2) for n in elements)), fields)


def _unknowns(axes: tuple[Axis, ...], fields: Fields, closed: bool = False) -> int:
    """Count the unknowns of a brick: its own, or with those of the planes around it."""
    return sum(
        components * prod(n * degree - 1 + (2 if closed else ends) for n, ends in axes)
        for components, degree in fields
    )


@cache
def _brick(axes: tuple[Axis, ...], fields: Fields) -> Factors:
    around = _unknowns(axes, fields, closed=True) - _unknowns(axes, fields)
    cuts = [k for k, (n, _) in enumerate(axes) if n > 1]
    if not cuts:
        return _front(_unknowns(axes, fields), around)
    others = {k: axes[:k] + axes[k + 1 :] for k in cuts}
    cut = min(cuts, key=lambda k: (_unknowns(others[k], fields), -axes[k][0]))
    n, ends = axes[cut]
    halves = (n // 2, (ends + 1) // 2), (n - n // 2, ends // 2)
    total = _front(_unknowns(others[cut], fields), around)
    for half in halves:
        total += _brick(tuple(sorted((*others[cut], half))), fields)
    return total


def _front(s: int, b: int) -> Factors:
    return Factors(s * s + 2.0 * s * b, 2 / 3 * s**3 + 2.0 * s * s * b + 2.0 * s * b * b)
