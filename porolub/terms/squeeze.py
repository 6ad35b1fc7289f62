"""Film thickness in time: int (h - h_0)/dt q ds (de Boer et al. 2020, Eq. 7), backward Euler."""

from __future__ import annotations

from dataclasses import dataclass

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.laws.lubricant import film_thickness
from porolub.terms.operation import Operation
from porolub.terms.plane import Plane
from porolub.terms.term import Part


@dataclass(frozen=True)
class Squeeze:
    plane: Plane
    operation: Operation
    boundary: str
    displacement: bool
    approach: bool
    name: str = "squeeze"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["p"]

    def parts(self) -> list[Part]:
        blocks = self.plane.blocks("p", self.displacement, self.approach)
        return [Part(f"facets:{self.boundary}", self.rate_of_thickness, blocks)]

    def rate_of_thickness(self, at: Points, out: Integrand) -> None:
        rate = self.operation.rate
        if rate == 0.0:
            return
        h, dh = film_thickness(self.plane.gap(at))
        before, _ = film_thickness(self.plane.gap(at.before))
        out.residual("p", VALUE, rate * (h - before))
        if out.wants_jacobian:
            self.plane.chain(at, out, "p", VALUE, rate * dh)
