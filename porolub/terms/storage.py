"""Fluid content of the pores: int m q with m = a (J - 1) + S p (de Boer et al. 2020, Eq. 5).

The rows of fluid mass hold its rate, a difference of contents, so the balance closes exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, VALUE, Integrand, Points
from porolub.terms.term import Part


@dataclass(frozen=True)
class Storage:
    biot: float
    storage: float
    name: str = "storage"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u", "p"]

    def parts(self) -> list[Part]:
        return []

    def contents(self) -> list[Part]:
        return [Part("cells", self.content, [("p", "u"), ("p", "p")])]

    def content(self, at: Points, out: Integrand) -> None:
        """Fluid volume added per reference volume."""
        a, S, d = self.biot, self.storage, at.deformation
        out.residual("p", VALUE, a * (d.J - 1.0) + S * at.value("p"))
        if out.wants_jacobian:
            out.jacobian("p", VALUE, "u", GRAD, d.cof, weight=a)
            out.jacobian("p", VALUE, "p", VALUE, np.full(at.weights.shape, S))
