"""Streamline stabilisation of the carry term (SUPG on the carried quantity).

At high Peclet number the carry term transports the volume change a (J - 1); the pressure answers
as convection with diffusivity c = M kappa / (a^2 eta).  This adds the conservative flux
a c_s s (s . grad j) along the stream s, with c_s from the cell Peclet number and j the volume
change J - 1 projected on the pressure's element, so that it has a gradient.  Diffusing j and not
p matters: inside a contact p varies while J, carried along, does not, and there the
stabilisation is silent.  It is zero where the flow is resolved and fades with refinement.
Brooks and Hughes (1982).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, VALUE, Integrand, Points
from porolub.laws import tensors
from porolub.laws.upwind import streamline_diffusivity
from porolub.terms.operation import Operation
from porolub.terms.term import Part


@dataclass(frozen=True)
class Streamline:
    biot: float
    capacity: float  # a^2 / M
    mobility: float  # kappa / eta
    operation: Operation
    degree: int  # of the projected volume change: the pressure's
    name: str = "streamline stabilisation"

    def fields(self) -> list[Field]:
        return [Field("j", 1, self.degree)]

    def reads(self) -> list[str]:
        return ["u", "p"]

    def parts(self) -> list[Part]:
        return [Part("cells", self.projection, [("j", "j"), ("j", "u")]),
                Part("cells", self.diffusion, [("p", "j")])]

    def projection(self, at: Points, out: Integrand) -> None:
        """int (j - (J - 1)) q = 0."""
        d = at.deformation
        out.residual("j", VALUE, at.value("j") - (d.J - 1.0))
        if out.wants_jacobian:
            out.jacobian("j", VALUE, "j", VALUE, np.ones(at.weights.shape))
            out.jacobian("j", VALUE, "u", GRAD, -d.cof)

    def diffusion(self, at: Points, out: Integrand) -> None:
        K = self.kept_diffusivity(at)
        out.residual("p", GRAD, tensors.apply(K, at.grad("j")))
        if out.wants_jacobian:
            out.jacobian("p", GRAD, "j", GRAD, K)

    def kept_diffusivity(self, at: Points) -> np.ndarray:
        """a c_s s s (ne, nq, dim, dim), computed once for a motion."""
        return at.kept(self.name, self.operation.motion, lambda: self.biot * self.diffusivity(at))

    def diffusivity(self, at: Points) -> np.ndarray:
        """Extra diffusivity c_s s s (ne, nq, dim, dim); depends on the motion, on no unknown."""
        v = self.operation.body_velocity(at.position)
        speed = np.linalg.norm(v, axis=-1)
        s = v / np.where(speed > 0, speed, 1.0)[..., None]
        length = at.domain.length_along(s, at.rows)
        extra = streamline_diffusivity(speed, length, self.mobility / self.capacity)
        return extra[..., None, None] * s[..., :, None] * s[..., None, :]
