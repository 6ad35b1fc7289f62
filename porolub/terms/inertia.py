"""Inertia of the skeleton: rho_s u_tt of de Boer et al. 2020, Eq. 1, as a first-order system.

Momentum: d/dt int rho_s w . test joins the rows of u; velocity: d/dt int u . test = int w . test,
with rho_s per reference volume and w in the element of u, so w is the scheme's rate of u, node by
node.  That holds where u is given, too: its velocity needs no condition of its own.  In a steady
state w = 0.

The body's rotation is left out, as in the paper: its convective and centripetal accelerations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.terms.term import Part


@dataclass(frozen=True)
class Inertia:
    """``density`` rho_s (unit: pressure time^2 / length^2); dim and degree are those of u."""

    density: float
    dim: int
    degree: int
    name: str = "inertia"

    def fields(self) -> list[Field]:
        return [Field("w", self.dim, self.degree, differential=True)]

    def reads(self) -> list[str]:
        return ["u"]

    def parts(self) -> list[Part]:
        return [Part("cells", self.velocity, [("w", "w")])]

    def contents(self) -> list[Part]:
        return [Part("cells", self.content, [("u", "w"), ("w", "u")])]

    def velocity(self, at: Points, out: Integrand) -> None:
        out.residual("w", VALUE, at.value("w"), weight=-1.0)
        if out.wants_jacobian:
            out.jacobian("w", VALUE, "w", VALUE, at.constant(np.eye(self.dim)), weight=-1.0)

    def content(self, at: Points, out: Integrand) -> None:
        """Momentum, and the displacement whose rate is the velocity."""
        out.residual("u", VALUE, at.value("w"), weight=self.density)
        out.residual("w", VALUE, at.value("u"))
        if out.wants_jacobian:
            one = at.constant(np.eye(self.dim))
            out.jacobian("u", VALUE, "w", VALUE, one, weight=self.density)
            out.jacobian("w", VALUE, "u", VALUE, one)
