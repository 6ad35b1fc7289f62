"""Unilateral contact with Coulomb friction, by nodal quadrature on the lubricated surface.

Unknown: contact pressure l at the displacement nodes (of quadratic triangles at the middles of the
sides, see porolub.fem.dofs.nodal_points).  Rows: min(l, c gap) = 0 at each node
(no penetration, l >= 0, l gap = 0) and the traction -l m on the skeleton, with friction
mu l against the sliding direction if the scene wants it to shear the layer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.laws.contact import complementarity
from porolub.terms.operation import Operation
from porolub.terms.plane import Plane
from porolub.terms.term import Part


@dataclass(frozen=True)
class Contact:
    plane: Plane
    operation: Operation
    boundary: str
    stiffness: float
    friction: float  # 0 unless friction shears the skeleton
    approach: bool
    degree: int
    name: str = "contact"

    def fields(self) -> list[Field]:
        return [Field("l", 1, self.degree, support=self.boundary, nodal=True)]

    def reads(self) -> list[str]:
        return ["u"]

    def parts(self) -> list[Part]:
        blocks = [("u", "l"), ("l", "l"), *self.plane.blocks("l", True, self.approach)]
        return [Part(f"nodes:{self.boundary}", self.constraint, blocks)]

    def constraint(self, at: Points, out: Integrand) -> None:
        pressure = at.value("l")
        phi, by_pressure, by_gap = complementarity(pressure, self.plane.gap(at), self.stiffness)
        direction = at.constant(np.asarray(self.plane.toward)).copy()
        if self.friction:
            against = self.operation.sliding_direction(at.position, at.normal)
            direction += self.friction * self.operation.friction * against
        out.residual("l", VALUE, phi)
        out.residual("u", VALUE, pressure[..., None] * direction)
        if out.wants_jacobian:
            out.jacobian("u", VALUE, "l", VALUE, direction)
            out.jacobian("l", VALUE, "l", VALUE, by_pressure)
            self.plane.chain(at, out, "l", VALUE, by_gap)
