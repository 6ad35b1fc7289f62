"""Fluid between the surfaces: int h q ds; its rate is the squeeze (de Boer et al. 2020, Eq. 7)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.laws.lubricant import film_thickness
from porolub.terms.plane import Plane
from porolub.terms.term import Part

Array = NDArray[np.float64]


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

    def content(self, at: Points, out: Integrand, density: Array | float = 1.0) -> None:
        """h times a density (ne, nq) that the tangent holds fixed."""
        h, dh = film_thickness(self.plane.gap(at))
        out.residual("p", VALUE, density * h)
        if out.wants_jacobian:
            self.plane.chain(at, out, "p", VALUE, density * dh)
