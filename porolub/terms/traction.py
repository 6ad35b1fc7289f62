"""Prescribed total traction on a named boundary (dead load per reference area)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.terms.operation import Operation
from porolub.terms.term import Part


@dataclass(frozen=True)
class Traction:
    """``normal``: compression positive; ``vector``: components, added to it."""

    boundary: str
    normal: float
    vector: tuple[float, ...]
    operation: Operation = field(default_factory=Operation)
    name: str = "traction"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u"]

    def parts(self) -> list[Part]:
        return [Part(f"facets:{self.boundary}", self.apply)]

    def apply(self, at: Points, out: Integrand) -> None:
        t = -self.normal * at.normal + np.asarray(self.vector)
        out.residual("u", VALUE, -self.operation.share * t)
