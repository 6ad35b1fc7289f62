"""Fluid content of the pores in time: int (m - m_0)/dt q with m = a (J - 1) + S p.

Backward Euler on the conserved content itself, so the balance of a step closes exactly
(de Boer et al. 2020, Eq. 5).  Nothing is computed in a steady solve (rate 0).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, VALUE, Integrand, Points
from porolub.terms.operation import Operation
from porolub.terms.term import Part


@dataclass(frozen=True)
class Storage:
    biot: float
    storage: float
    operation: Operation
    name: str = "storage"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u", "p"]

    def parts(self) -> list[Part]:
        return [Part("cells", self.rate_of_content, [("p", "u"), ("p", "p")])]

    def content(self, at: Points) -> np.ndarray:
        """Fluid volume added per reference volume, m."""
        return self.biot * (at.deformation.J - 1.0) + self.storage * at.value("p")

    def rate_of_content(self, at: Points, out: Integrand) -> None:
        rate = self.operation.rate
        if rate == 0.0:
            return
        out.residual("p", VALUE, rate * (self.content(at) - self.content(at.before)))
        if out.wants_jacobian:
            out.jacobian("p", VALUE, "u", GRAD, rate * self.biot * at.deformation.cof)
            out.jacobian("p", VALUE, "p", VALUE, np.full(at.weights.shape, rate * self.storage))
