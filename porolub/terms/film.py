"""Thin Reynolds film as a surface operator on the trace of p (de Boer et al. 2020, Eqs. 7-8).

int [h^3/(12 eta) grad_s p . grad_s q - h/2 U . grad_s q] ds, h = max(0, gap).  Added to the fluid
mass of the pores the exchange V drops out.  Where h = 0 the film conducts nothing and the
surface is sealed by itself; without pores nothing would determine the film pressure there, so
the conductance of a film of the thickness ``leak`` remains.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, Integrand, Points
from porolub.laws.lubricant import Newtonian, film_thickness
from porolub.laws.upwind import upwind_derivative, upwind_function
from porolub.terms.operation import Operation
from porolub.terms.plane import Plane
from porolub.terms.term import Part

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Film:
    law: Newtonian
    plane: Plane
    operation: Operation
    boundary: str
    displacement: bool
    approach: bool
    degree: int
    alone: bool  # no pores: the film brings its own pressure, on the surface only
    upwind: tuple[float, float] | None = None  # layer modulus and mobility; None: rigid surface
    leak: float = 0.0  # thickness of the film whose conductance remains in closed contact
    name: str = "film"

    def fields(self) -> list[Field]:
        if not self.alone:
            return []
        return [Field("p", 1, self.degree, support=self.boundary, differential=True)]

    def reads(self) -> list[str]:
        return [] if self.alone else ["p"]

    def parts(self) -> list[Part]:
        blocks = [("p", "p"), *self.plane.blocks("p", self.displacement, self.approach)]
        return [Part(f"facets:{self.boundary}", self.flow, blocks)]

    def flux(self, at: Points) -> Array:
        """Volume flux in the film per width, (ne, nq, dim), tangential."""
        h, _ = film_thickness(self.plane.gap(at))
        U = self.operation.entrainment(at.position, at.normal)
        g = self.surface_gradient(at)
        return -self.conductance(h)[..., None] * g + h[..., None] / 2.0 * U

    def conductance(self, h: Array) -> Array:
        return self.law.conductance(h) + self.law.conductance(np.asarray(self.leak))

    @staticmethod
    def surface_gradient(at: Points) -> Array:
        g, n = at.grad("p"), at.normal
        return g - np.einsum("...d,...d->...", g, n)[..., None] * n

    def flow(self, at: Points, out: Integrand) -> None:
        self.transport(at, out)
        if self.upwind is not None:
            self._upwind(at, out)

    def transport(self, at: Points, out: Integrand, density: Array | float = 1.0) -> None:
        """- flux . grad q times a density (ne, nq) that the tangent holds fixed."""
        r = np.broadcast_to(density, at.weights.shape)
        out.residual("p", GRAD, self.flux(at), weight=-r)
        if out.wants_jacobian:
            h, dh = film_thickness(self.plane.gap(at))
            U = self.operation.entrainment(at.position, at.normal)
            g, n = self.surface_gradient(at), at.normal
            tangential = np.eye(at.dim) - n[..., :, None] * n[..., None, :]
            out.jacobian("p", GRAD, "p", GRAD, tangential, weight=r * self.conductance(h))
            by_h = self.law.conductance_derivative(h)[..., None] * g - U / 2.0
            self.plane.chain(at, out, "p", GRAD, (r * dh)[..., None] * by_h)

    def _upwind(self, at: Points, out: Integrand) -> None:
        """Streamline diffusion of the film thickness where the elements do not resolve it.

        The deformable surface turns U/2 dh/ds into transport of h; film and pores answer a
        short wave of h with the diffusivity (h^3/(12 eta) + k l) M / l.  The slope is that of the
        gap itself, not of max(0, gap): cut off at a quadrature point it would jump there, and
        Newton would cycle; on closed elements it is zero anyway.
        """
        h, dh = film_thickness(self.plane.gap(at))
        U = self.operation.entrainment(at.position, at.normal)
        s, reach, resists, peclet = self._resolution(at, h, U)
        extra = reach * upwind_function(peclet)
        slope = self.plane.slope(at, s)
        out.residual("p", GRAD, (extra * slope)[..., None] * s)
        if out.wants_jacobian:
            by_h = (reach * upwind_derivative(peclet) * -peclet / resists
                    * self.law.conductance_derivative(h))
            self.plane.chain(at, out, "p", GRAD, (by_h * dh * slope)[..., None] * s)
            self.plane.chain_slope(at, out, "p", GRAD, extra[..., None] * s, s)

    def upwinding(self, at: Points, h: Array, U: Array) -> tuple[Array, Array]:
        """Unit direction (ne, nq, dim) and diffusivity of h (ne, nq) of the streamline term."""
        s, reach, _, peclet = self._resolution(at, h, U)
        return s, reach * upwind_function(peclet)

    def _resolution(self, at: Points, h: Array, U: Array) -> tuple[Array, Array, Array, Array]:
        """Stream, |U| l / 4, what resists the transport of h, and the cells' Peclet number."""
        assert self.upwind is not None
        modulus, mobility = self.upwind
        speed = np.linalg.norm(U, axis=-1)
        s = U / np.where(speed > 0, speed, 1.0)[..., None]
        length = at.domain.length_along(s, at.rows)
        resists = self.law.conductance(h) + mobility * length + 1e-30  # its square divides below
        peclet = speed * length**2 / (2.0 * modulus * resists)
        return s, speed * length / 4.0, resists, peclet
