"""What a compressible fluid adds: density ratio r(p) = rho/rho_0 less one, times the fluxes.

The incompressible terms count volumes; with these terms added the same rows count mass / rho_0.
They alone know other terms: those whose fluxes they multiply.

Pores, with S_s = S - eps_0 chi the part of storage that is not the fluid's own:
- content r (eps_0 + a (J - 1) + S_s p) - eps_0 instead of a (J - 1) + S p;
- Darcy flux r K grad p instead of K grad p;
- carry r (eps_0 + a (J - 1)) v instead of a (J - 1) v.
Film: content r h instead of h, flux r Q instead of Q (de Boer et al. 2020, Eq. 7).

On carry.  Fluid that fills the pores travels with the body, so its mass per reference volume,
density times pore volume, obeys d/dt + div(. v) = 0 but for Darcy flow.  Density therefore
multiplies all of the pore volume that Carry takes along: a (J - 1) and eps_0, which an
incompressible fluid carries without effect since div v = 0, a compressible one not (v . grad r).
Eq. 5 of the paper multiplies its a DJ/Dt by rho instead; the two differ by a (J - 1) v . grad rho,
and only the divergence conserves mass.  What is stored by S_s, the grains' part, stays at rest
here as it does in Carry and the paper, so that chi -> 0 leads back to Carry.  Entering material
that is fresh is neither deformed nor under pressure: r = 1, nothing is added.

Stabilising fluxes vanish with refinement and are not multiplied; nor is the leak of an open
surface, which only holds p = 0, where r = 1, and already counts what leaves.
"""

from __future__ import annotations

from dataclasses import dataclass

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, VALUE, Integrand, Points
from porolub.laws.fluid import CompressibleFluid
from porolub.laws.lubricant import film_thickness
from porolub.terms.carry import Carry
from porolub.terms.film import Film
from porolub.terms.pores import Pores
from porolub.terms.squeeze import Squeeze
from porolub.terms.storage import Storage
from porolub.terms.term import Block, Part


@dataclass(frozen=True)
class CompressiblePores:
    """``porosity`` eps_0 of the undeformed layer; ``carry`` None: the body does not turn."""

    fluid: CompressibleFluid
    porosity: float
    pores: Pores
    storage: Storage
    carry: Carry | None = None
    name: str = "compressible pores"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u", "p"]

    def parts(self) -> list[Part]:
        pp, both = [("p", "p")], [("p", "p"), ("p", "u")]
        parts = [Part("cells", self.darcy, both if self.pores.spatial else pp)]
        if self.carry is not None:
            parts.append(Part("cells", self.transport, both))
            parts += [Part(f"facets:{end}", self.end_flux, both) for end in self.carry.ends]
        return parts

    def contents(self) -> list[Part]:
        return [Part("cells", self.content, [("p", "u"), ("p", "p")])]

    def content(self, at: Points, out: Integrand) -> None:
        a, eps, chi = self.storage.biot, self.porosity, self.fluid.compressibility
        p, d, grains = at.value("p"), at.deformation, self.storage.storage - eps * chi
        excess, slope = self.fluid.excess_density(p)
        volume = eps + a * (d.J - 1.0) + grains * p
        out.residual("p", VALUE, excess * volume - eps * chi * p)
        if out.wants_jacobian:
            out.jacobian("p", VALUE, "u", GRAD, d.cof, weight=a * excess)
            out.jacobian("p", VALUE, "p", VALUE, slope * volume + excess * grains - eps * chi)

    def darcy(self, at: Points, out: Integrand) -> None:
        excess, slope = self.fluid.excess_density(at.value("p"))
        self.pores.mass(at, out, excess)
        if out.wants_jacobian:
            out.jacobian("p", GRAD, "p", VALUE, self.pores.flow(at), weight=slope)

    def transport(self, at: Points, out: Integrand) -> None:
        assert self.carry is not None
        excess, slope = self.fluid.excess_density(at.value("p"))
        v, change = self.carry.velocity(at), self.carry.biot * (at.deformation.J - 1.0)
        self.carry.transport(at, out, excess)
        out.residual("p", GRAD, v, weight=-excess * self.porosity)
        if out.wants_jacobian:
            out.jacobian("p", GRAD, "p", VALUE, v, weight=-slope * (self.porosity + change))

    def end_flux(self, at: Points, out: Integrand) -> None:
        assert self.carry is not None
        excess, slope = self.fluid.excess_density(at.value("p"))
        vn, change = self.carry.end_speed(at), self.carry.biot * (at.deformation.J - 1.0)
        self.carry.end_flux(at, out, excess)
        out.residual("p", VALUE, vn, weight=excess * self.porosity)
        if out.wants_jacobian:
            out.jacobian("p", VALUE, "p", VALUE, vn * slope * (self.porosity + change))


@dataclass(frozen=True)
class CompressibleFilm:
    """``squeeze`` None: the film's thickness stores nothing."""

    fluid: CompressibleFluid
    film: Film
    squeeze: Squeeze | None
    name: str = "compressible film"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["p"]

    def parts(self) -> list[Part]:
        return [Part(f"facets:{self.film.boundary}", self.flow, self._blocks())]

    def contents(self) -> list[Part]:
        if self.squeeze is None:
            return []
        return [Part(f"facets:{self.film.boundary}", self.content, self._blocks())]

    def _blocks(self) -> list[Block]:
        film = self.film
        return [("p", "p"), *film.plane.blocks("p", film.displacement, film.approach)]

    def content(self, at: Points, out: Integrand) -> None:
        assert self.squeeze is not None
        excess, slope = self.fluid.excess_density(at.value("p"))
        self.squeeze.content(at, out, excess)
        if out.wants_jacobian:
            h, _ = film_thickness(self.squeeze.plane.gap(at))
            out.jacobian("p", VALUE, "p", VALUE, slope * h)

    def flow(self, at: Points, out: Integrand) -> None:
        excess, slope = self.fluid.excess_density(at.value("p"))
        self.film.transport(at, out, excess)
        if out.wants_jacobian:
            out.jacobian("p", GRAD, "p", VALUE, self.film.flux(at), weight=-slope)
