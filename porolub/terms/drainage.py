"""A lubricated surface without a film: ambient pressure where open, sealed where closed.

int c g p q ds with the gap g = max(0, gap) and a conductance c far above the layer's own, so
p = 0 at a gap that matters and the leaked fluid is counted; where the surface is closed it
conducts nothing.  In proportion to the gap, since a leak that is switched on and off makes
Newton cycle: the pressure that is let off pushes the surface shut again.
"""

from __future__ import annotations

from dataclasses import dataclass

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.laws.lubricant import film_thickness
from porolub.terms.plane import Plane
from porolub.terms.term import Part


@dataclass(frozen=True)
class Drainage:
    conductance: float  # per gap
    plane: Plane
    boundary: str
    approach: bool
    name: str = "open surface"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u", "p"]

    def parts(self) -> list[Part]:
        blocks = [("p", "p"), *self.plane.blocks("p", True, self.approach)]
        return [Part(f"facets:{self.boundary}", self.leak, blocks)]

    def leak(self, at: Points, out: Integrand) -> None:
        gap, dgap = film_thickness(self.plane.gap(at))
        p = at.value("p")
        out.residual("p", VALUE, self.conductance * gap * p)
        if out.wants_jacobian:
            out.jacobian("p", VALUE, "p", VALUE, self.conductance * gap)
            self.plane.chain(at, out, "p", VALUE, self.conductance * dgap * p)
