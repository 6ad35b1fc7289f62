"""A lubricated surface without a film: ambient pressure where open, sealed where closed.

The open surface leaks with a conductance far above the layer's, so p = 0 there to solver
accuracy and the leaked fluid is counted; at closed nodes it conducts nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.terms.plane import Plane
from porolub.terms.term import Part


@dataclass(frozen=True)
class Drainage:
    conductance: float
    plane: Plane
    stiffness: float
    boundary: str
    name: str = "open surface"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["p", "l"]

    def parts(self) -> list[Part]:
        return [Part(f"nodes:{self.boundary}", self.leak, [("p", "p")])]

    def leak(self, at: Points, out: Integrand) -> None:
        open_ = at.value("l") <= self.stiffness * self.plane.gap(at)
        c = self.conductance * np.where(open_, 1.0, 0.0)
        out.residual("p", VALUE, c * at.value("p"))
        if out.wants_jacobian:
            out.jacobian("p", VALUE, "p", VALUE, c)
