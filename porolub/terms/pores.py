"""Biot coupling and Darcy flow, in the frame the scene chooses.

Momentum: - int a p B(F) : grad w, with B = cof F (spatial) or I (material).  Integrated by parts
this is the body force a grad p together with a total boundary traction a p B N, so the natural
condition on a free boundary is zero *total* traction.
Fluid mass: int K grad p . grad q, K = (kappa/eta) J F^-1 F^-T (spatial) or (kappa/eta) I.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, VALUE, Integrand, Points
from porolub.laws import tensors
from porolub.terms.term import Part

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Pores:
    biot: float
    mobility: float  # kappa / eta
    spatial: bool
    degree: int
    name: str = "pores"

    def fields(self) -> list[Field]:
        return [Field("p", 1, self.degree, differential=True)]

    def reads(self) -> list[str]:
        return ["u"]

    def parts(self) -> list[Part]:
        darcy = [("p", "p")] + ([("p", "u")] if self.spatial else [])
        coupling = [("u", "p")] + ([("u", "u")] if self.spatial else [])
        return [Part("cells", self.momentum, coupling), Part("cells", self.mass, darcy)]

    def momentum(self, at: Points, out: Integrand) -> None:
        a, p, d = self.biot, at.value("p"), at.deformation
        B = d.cof if self.spatial else at.constant(np.eye(at.dim))
        out.residual("u", GRAD, B, weight=-a * p)
        if out.wants_jacobian:
            out.jacobian("u", GRAD, "p", VALUE, B, weight=-a)
            if self.spatial and d.finite:
                out.jacobian("u", GRAD, "u", GRAD, d.dcof, weight=-a * p)

    def mass(self, at: Points, out: Integrand, density: Array | float = 1.0) -> None:
        """K grad p times a density (ne, nq) that the tangent holds fixed."""
        k, g, d = self.mobility * density, at.grad("p"), at.deformation
        K = self.conductance(at)
        out.residual("p", GRAD, tensors.apply(K, g), weight=k)
        if out.wants_jacobian:
            out.jacobian("p", GRAD, "p", GRAD, K, weight=k)
            if self.spatial and d.finite:
                out.jacobian("p", GRAD, "u", GRAD, d.mobility_flux_derivative(g), weight=k)

    def flow(self, at: Points) -> Array:
        """K grad p (ne, nq, dim): the flow of fluid volume, turned round."""
        return self.mobility * tensors.apply(self.conductance(at), at.grad("p"))

    def conductance(self, at: Points) -> Array:
        """K / (kappa/eta), (ne, nq, dim, dim)."""
        return at.deformation.mobility_tensor if self.spatial else at.constant(np.eye(at.dim))
