"""Rotation carries volume change through the contact: int a (v . grad J) q, conservatively.

Integrated by parts (v is divergence free and tangential to the arcs):
- int a (J - 1) v . grad q + int_ends a (J - 1) (v . n) q.  Fluid mass then closes to solver
tolerance.  ``entering="fresh"``: material enters undeformed, J = 1 where v . n < 0.
de Boer et al. 2020, Eqs. 5-6.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, VALUE, Integrand, Points
from porolub.laws import tensors
from porolub.terms.operation import Operation
from porolub.terms.term import Part

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Carry:
    biot: float
    operation: Operation
    ends: tuple[str, ...]
    fresh: bool
    name: str = "carry"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u", "p"]

    def parts(self) -> list[Part]:
        blocks = [("p", "u")]
        ends = [Part(f"facets:{end}", self.end_flux, blocks) for end in self.ends]
        return [Part("cells", self.transport, blocks), *ends]

    def transport(self, at: Points, out: Integrand, density: Array | float = 1.0) -> None:
        """- a (J - 1) v . grad q times a density (ne, nq) that the tangent holds fixed."""
        a, d, v = self.biot * density, at.deformation, self.velocity(at)
        out.residual("p", GRAD, v, weight=-a * (d.J - 1.0))
        if out.wants_jacobian:
            out.jacobian("p", GRAD, "u", GRAD, tensors.outer(v, d.cof), weight=-a)

    def end_flux(self, at: Points, out: Integrand, density: Array | float = 1.0) -> None:
        """a (J - 1) v . n q, likewise."""
        a, d, vn = self.biot * density, at.deformation, self.end_speed(at)
        out.residual("p", VALUE, a * (d.J - 1.0) * vn)
        if out.wants_jacobian:
            out.jacobian("p", VALUE, "u", GRAD, d.cof, weight=a * vn)

    def velocity(self, at: Points) -> Array:
        """v (ne, nq, dim)."""
        return at.kept("body velocity", self.operation.motion,
                       lambda: self.operation.body_velocity(at.position))

    def end_speed(self, at: Points) -> Array:
        """v . n (ne, nq) of material that brings its volume change along: not if fresh."""
        vn = np.einsum("...d,...d->...", self.velocity(at), at.normal)
        return np.maximum(vn, 0.0) if self.fresh else vn
