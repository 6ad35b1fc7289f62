"""Prescribed total traction on a named boundary (dead load per reference area)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.terms.operation import Operation
from porolub.terms.term import Part


@dataclass(frozen=True)
class Traction:
    """``normal``: compression positive; ``vector``: components, added to it.

    ``varying`` gives both at a time in s, instead.
    """

    boundary: str
    normal: float
    vector: tuple[float, ...]
    operation: Operation = field(default_factory=Operation)
    varying: Callable[[float], tuple[float, tuple[float, ...]]] | None = None
    name: str = "traction"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u"]

    def parts(self) -> list[Part]:
        return [Part(f"facets:{self.boundary}", self.apply)]

    def apply(self, at: Points, out: Integrand) -> None:
        normal, vector = self.normal, self.vector
        if self.varying is not None:
            normal, vector = self.varying(self.operation.time)
        t = -normal * at.normal + np.asarray(vector)
        out.residual("u", VALUE, -self.operation.share * t)
