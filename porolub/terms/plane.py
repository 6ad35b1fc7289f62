"""The rigid plane opposite the lubricated surface, and the gap between them.

gap = d0 - m . (X + u) - v0, with m the unit vector from the body to the plane and d0 such that
the undeformed body touches at v0 = 0 (v0 positive when pressed in).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.fem.points import GRAD, VALUE, Integrand, Points
from porolub.terms.operation import Operation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Plane:
    """``toward``: unit vector m; ``offset``: d0 = max of m . X over the lubricated surface."""

    toward: tuple[float, ...]
    offset: float
    operation: Operation

    def gap(self, at: Points) -> Array:
        m = np.asarray(self.toward)
        reach = at.position @ m
        if at.has("u"):
            reach = reach + at.value("u") @ m
        approach = at.value("v0") if at.has("v0") else self.operation.approach
        return self.offset - reach - approach

    def slope(self, at: Points, along: Array) -> Array:
        """d gap / d s in the tangential unit direction ``along`` (ne, nq, dim)."""
        moved = np.einsum("...ij,...j->...i", at.deformation.F, along)
        return -moved @ np.asarray(self.toward)

    def chain_slope(self, at: Points, out: Integrand, test: str, op: bool, by_slope: Array,
                    along: Array) -> None:
        """Add the tangent of a flux whose derivative by the slope is ``by_slope`` (.., dim)."""
        if at.has("u"):
            dslope = -np.asarray(self.toward)[:, None] * along[..., None, :]
            flux = by_slope[..., None, None] * dslope[..., None, :, :]
            out.jacobian(test, op, "u", GRAD, flux)

    def chain(self, at: Points, out: Integrand, test: str, op: bool, by_gap: Array) -> None:
        """Add the tangent of a contribution whose derivative by the gap is ``by_gap``."""
        if at.has("u"):
            m = np.asarray(self.toward)
            rank = by_gap.ndim - 2  # components after (ne, nq)
            by_u = by_gap[..., None] * (-m).reshape((1,) * rank + (-1,))
            out.jacobian(test, op, "u", VALUE, by_u)
        if at.has("v0"):
            out.jacobian(test, op, "v0", VALUE, -by_gap)

    def blocks(self, test: str, displacement: bool, approach: bool) -> list[tuple[str, str]]:
        return [(test, "u")] * displacement + [(test, "v0")] * approach
