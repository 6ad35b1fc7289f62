"""Fluid between the surfaces: int h q ds; its rate is the squeeze (de Boer et al. 2020, Eq. 7)."""

from __future__ import annotations

from dataclasses import dataclass

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.laws.lubricant import film_thickness
from porolub.terms.plane import Plane
from porolub.terms.term import Part


@dataclass(frozen=True)
class Squeeze:
    plane: Plane
    boundary: str
    displacement: bool
    approach: bool
    name: str = "squeeze"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["p"]

    def parts(self) -> list[Part]:
        return []

    def contents(self) -> list[Part]:
        blocks = self.plane.blocks("p", self.displacement, self.approach)
        return [Part(f"facets:{self.boundary}", self.content, blocks)]

    def content(self, at: Points, out: Integrand) -> None:
        h, dh = film_thickness(self.plane.gap(at))
        out.residual("p", VALUE, h)
        if out.wants_jacobian:
            self.plane.chain(at, out, "p", VALUE, dh)
