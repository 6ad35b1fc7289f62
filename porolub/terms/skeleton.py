"""Momentum of the drained skeleton: int P(F) : grad w (de Boer et al. 2020, Eq. 1)."""

from __future__ import annotations

from dataclasses import dataclass

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, Integrand, Points
from porolub.laws.solid import LinearElastic, NeoHookean
from porolub.terms.term import Part


@dataclass(frozen=True)
class Skeleton:
    law: LinearElastic | NeoHookean
    dim: int
    degree: int
    name: str = "skeleton"

    def fields(self) -> list[Field]:
        return [Field("u", self.dim, self.degree, differential=True)]

    def reads(self) -> list[str]:
        return []

    def parts(self) -> list[Part]:
        return [Part("cells", self.momentum, [("u", "u")])]

    def momentum(self, at: Points, out: Integrand) -> None:
        d = at.deformation
        if out.wants_residual:
            out.residual("u", GRAD, self.law.stress(d))
        if out.wants_jacobian:
            out.jacobian("u", GRAD, "u", GRAD, self.law.tangent(d))
