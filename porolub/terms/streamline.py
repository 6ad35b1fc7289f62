"""Streamline stabilisation of the carry term, fading out with refinement.

At high Peclet number a (v . grad J) acts on the pressure as convection with diffusivity
c = M kappa / (a^2 eta).  This adds int (a^2/M) c_s (s . grad p)(s . grad q) along the stream s,
with c_s from the cell Peclet number: a conservative flux, zero where the flow is resolved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, Integrand, Points
from porolub.laws import tensors
from porolub.laws.upwind import streamline_diffusivity
from porolub.terms.operation import Operation
from porolub.terms.term import Part

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Streamline:
    capacity: float  # a^2 / M
    mobility: float  # kappa / eta
    operation: Operation
    weight: float = 1.0
    name: str = "streamline stabilisation"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["p"]

    def parts(self) -> list[Part]:
        return [Part("cells", self.diffusion, [("p", "p")])]

    def diffusion(self, at: Points, out: Integrand) -> None:
        K = at.kept(self.name, self.operation.motion, lambda: self.mobility_along(at))
        out.residual("p", GRAD, tensors.apply(K, at.grad("p")))
        if out.wants_jacobian:
            out.jacobian("p", GRAD, "p", GRAD, K)

    def mobility_along(self, at: Points) -> Array:
        """a^2/M c_s s s (ne, nq, dim, dim); depends on the motion, on no unknown."""
        v = self.operation.body_velocity(at.position)
        speed = np.linalg.norm(v, axis=-1)
        s = v / np.where(speed > 0, speed, 1.0)[..., None]
        length = at.domain.length_along(s, at.rows)
        extra = streamline_diffusivity(speed, length, self.mobility / self.capacity)
        size = (self.weight * self.capacity * extra)[..., None, None]
        return size * s[..., :, None] * s[..., None, :]
