"""What the layer's deformation adds to the pressure equation, estimated point by point.

Eliminating the displacement from the linearised equations leaves a pressure equation whose extra
operator is dense.  For preconditioning it is estimated by what each point would do by itself:
a pressure p changes the volume by a p / modulus (fixed stress: Kim, Tchelepi and Juanes 2011),
and pressure in the film opens the gap by compliance times p (Winkler).  The terms here fill the
block (p, p) alone, with the derivatives that the true terms would have with these estimates.
They hold no residual: no solution depends on them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, VALUE, Integrand, Points
from porolub.laws.lubricant import film_thickness
from porolub.terms.carry import Carry
from porolub.terms.film import Film
from porolub.terms.storage import Storage
from porolub.terms.streamline import Streamline
from porolub.terms.term import Part

Array = NDArray[np.float64]
PP = [("p", "p")]


@dataclass(frozen=True)
class FixedStress:
    """Storage and carry with J - 1 = a p / modulus."""

    storage: Storage
    carry: Carry | None
    streamline: Streamline | None
    modulus: float
    name: str = "fixed stress"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["p"]

    @property
    def swelling(self) -> float:
        """a d(J - 1)/dp."""
        return self.storage.biot**2 / self.modulus

    def parts(self) -> list[Part]:
        if self.carry is None:
            return []
        ends = [Part(f"facets:{end}", self.leaves, PP) for end in self.carry.ends]
        return [Part("cells", self.carried, PP), *ends]

    def contents(self) -> list[Part]:
        return [Part("cells", self.held, PP)]

    def held(self, at: Points, out: Integrand) -> None:
        """Of the content a (J - 1) that a pressure brings with it."""
        if out.wants_jacobian:
            one = np.full(at.weights.shape, self.swelling)
            out.jacobian("p", VALUE, "p", VALUE, one)

    def carried(self, at: Points, out: Integrand) -> None:
        """Of the transport of a (J - 1), with the diffusion that stabilises it."""
        assert self.carry is not None
        if out.wants_jacobian:
            v = self.carry.velocity(at)
            out.jacobian("p", GRAD, "p", VALUE, v, weight=-self.swelling)
            if self.streamline is not None:
                diffusivity = self.streamline.kept_diffusivity(at)
                weight = self.swelling / self.storage.biot
                out.jacobian("p", GRAD, "p", GRAD, diffusivity, weight=weight)

    def leaves(self, at: Points, out: Integrand) -> None:
        """Of the material that goes through the ends."""
        assert self.carry is not None
        if out.wants_jacobian:
            out.jacobian("p", VALUE, "p", VALUE, self.swelling * self.carry.end_speed(at))


@dataclass(frozen=True)
class WinklerFilm:
    """Film and squeeze with d gap = compliance d p.

    The layer's compliance is its thickness over its modulus for long waves of pressure, and in
    proportion to the wave for short ones.  What the film itself does not smooth is as short as an
    element: half the element's length counts, the layer's thickness (1, scaled) at most.
    """

    film: Film
    squeeze: bool
    modulus: float
    name: str = "winkler film"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["p"]

    def parts(self) -> list[Part]:
        return [Part(f"facets:{self.film.boundary}", self.flow, PP)]

    def contents(self) -> list[Part]:
        squeeze = [Part(f"facets:{self.film.boundary}", self.held, PP)]
        return squeeze if self.squeeze else []

    def compliance(self, at: Points) -> Array:
        """(ne, 1) thickness over modulus."""
        length = at.weights.sum(axis=1, keepdims=True) ** (1.0 / (at.dim - 1))
        return np.minimum(1.0, length / 2.0) / self.modulus

    def flow(self, at: Points, out: Integrand) -> None:
        """Of the film's flow, by the thickness."""
        if not out.wants_jacobian:
            return
        film, softness = self.film, self.compliance(at)
        h, dh = film_thickness(film.plane.gap(at))
        U = film.operation.entrainment(at.position, at.normal)
        g = film.surface_gradient(at)
        by_h = film.law.conductance_derivative(h)[..., None] * g - U / 2.0
        out.jacobian("p", GRAD, "p", VALUE, (softness * dh)[..., None] * by_h)
        if film.upwind is not None:
            s, extra = film.upwinding(at, h, U)
            along = s[..., :, None] * s[..., None, :]
            out.jacobian("p", GRAD, "p", GRAD, along, weight=softness * dh * extra)

    def held(self, at: Points, out: Integrand) -> None:
        """Of the squeeze."""
        if out.wants_jacobian:
            _, dh = film_thickness(self.film.plane.gap(at))
            out.jacobian("p", VALUE, "p", VALUE, self.compliance(at) * dh)
