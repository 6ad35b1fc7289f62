"""Load balance L_s + L_f = L as the row of the rigid approach v0 (de Boer et al. 2020, 13-15).

L_s = int p_c ds and L_f = int p ds over the reference surface; v0 is solved with the rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.terms.operation import Operation
from porolub.terms.term import Part


@dataclass(frozen=True)
class LoadBalance:
    operation: Operation
    boundary: str
    area: float  # reference measure of the lubricated surface
    contact: bool
    fluid: bool
    name: str = "load"

    def fields(self) -> list[Field]:
        return [Field("v0", 1, 0, differential=True)]  # the film's thickness moves with it

    def reads(self) -> list[str]:
        return ["l"] * self.contact + ["p"] * self.fluid

    def parts(self) -> list[Part]:
        solid = [Part(f"nodes:{self.boundary}", self.solid_load, [("v0", "l")])]
        fluid = [Part(f"facets:{self.boundary}", self.fluid_load, [("v0", "p")])]
        applied = [Part(f"facets:{self.boundary}", self.applied_load)]
        return solid * self.contact + fluid * self.fluid + applied

    def solid_load(self, at: Points, out: Integrand) -> None:
        self._share(at, out, "l")

    def fluid_load(self, at: Points, out: Integrand) -> None:
        self._share(at, out, "p")

    def applied_load(self, at: Points, out: Integrand) -> None:
        assert self.operation.force is not None
        mean = self.operation.force / self.area
        out.residual("v0", VALUE, np.full(at.weights.shape, -mean))

    def _share(self, at: Points, out: Integrand, field: str) -> None:
        out.residual("v0", VALUE, at.value(field))
        if out.wants_jacobian:
            out.jacobian("v0", VALUE, field, VALUE, np.ones(at.weights.shape))
