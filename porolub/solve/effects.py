"""Which section of a scene asks for which term; the only place that knows.

All numbers leave here scaled.
"""

from __future__ import annotations

from typing import Any

from porolub.laws.fluid import CompressibleFluid
from porolub.laws.lubricant import Newtonian
from porolub.laws.solid import LinearElastic, NeoHookean
from porolub.scene.conditions import Traction as Components
from porolub.scene.history import value_at
from porolub.solve.scales import Scales
from porolub.solve.surface import LubricatedSurface
from porolub.terms.carry import Carry
from porolub.terms.compressibility import CompressibleFilm, CompressiblePores
from porolub.terms.contact import Contact
from porolub.terms.drainage import Drainage
from porolub.terms.film import Film
from porolub.terms.inertia import Inertia
from porolub.terms.load import LoadBalance
from porolub.terms.operation import Operation
from porolub.terms.pores import Pores
from porolub.terms.skeleton import Skeleton
from porolub.terms.squeeze import Squeeze
from porolub.terms.storage import Storage
from porolub.terms.streamline import Streamline
from porolub.terms.surface_pressure import SurfacePressure
from porolub.terms.term import Term
from porolub.terms.traction import Traction

Law = LinearElastic | NeoHookean
CONTACT_STIFFNESS = 1.0  # one modulus per thickness: weighs pressure against gap
SEALED_FILM = 1e-7  # m; without pores a film closed by contact leaks like one as thin as this
OPEN_SURFACE_CONDUCTANCE = 1e6  # of the layer's own, at a gap of one thickness: p = 0 there


def solid_law(scene: Any, pressure: float) -> Law | None:
    """Skeleton law, moduli in units of ``pressure``; with pores the paper's weights a, 1 - a."""
    solid = scene.solid
    if solid is None:
        return None
    shear, bulk = solid.shear_modulus / pressure, solid.bulk_modulus / pressure
    if solid.law == "linear":
        return LinearElastic(shear, bulk)
    if scene.pores is None:
        return NeoHookean(shear, bulk)
    a = scene.pores.biot
    return NeoHookean(a * shear, (1.0 - a) * bulk)


def mobility_of(scene: Any, scales: Scales) -> float:
    """kappa / eta of the pores, scaled; 0 without pores."""
    if scene.pores is None:
        return 0.0
    return scene.pores.permeability / scene.pores.viscosity / scales.mobility


def compressible(scene: Any, scales: Scales) -> CompressibleFluid:
    """The law of a fluid with a compressibility, scaled."""
    return CompressibleFluid(scene.pores.compressibility * scales.pressure)


def body_terms(scene: Any, law: Law | None, scales: Scales, operation: Operation,
               ends: tuple[str, ...]) -> list[Term]:
    """Skeleton, pores, carry through ``ends`` and the tractions on named boundaries."""
    terms: list[Term] = []
    mesh = scene.mesh
    if law is not None:
        terms.append(Skeleton(law, scales.dim, mesh.degree))
        if scene.solid.inertia and scene.time is not None:
            terms.append(Inertia(scene.solid.density / scales.density, scales.dim, mesh.degree))
    if scene.pores is not None and law is not None:
        a, mobility = scene.pores.biot, mobility_of(scene, scales)
        spatial = scene.conventions.frame == "spatial"
        pores = Pores(a, mobility, spatial, mesh.pressure_degree)
        storage = Storage(a, scene.pores.storage * scales.pressure)
        terms += [pores, storage]
        carry = None
        if scene.pores.carry:
            fresh = scene.conventions.entering == "fresh"
            carry = Carry(a, operation, ends, fresh)
            capacity = a**2 / law.constrained_modulus
            terms += [carry, Streamline(a, capacity, mobility, operation, mesh.pressure_degree)]
        if scene.pores.compressibility is not None:
            fluid = compressible(scene, scales)
            terms.append(CompressiblePores(fluid, scene.pores.porosity, pores, storage, carry))
    for name, condition in scene.boundary.items():
        if condition.traction is not None:
            terms.append(_traction(name, condition.traction, scales, operation))
    return terms


def surface_terms(scene: Any, law: Law | None, scales: Scales, operation: Operation,
                  surface: LubricatedSurface) -> list[Term]:
    """Fluid pressure on the surface, film, contact, open surface and load balance."""
    terms: list[Term] = []
    mesh, plane, name = scene.mesh, surface.plane, surface.name
    pores, film, contact = scene.pores, scene.film, scene.contact
    solid, force = law is not None, operation.force is not None
    fluid = pores is not None or film is not None
    if solid and fluid:
        balanced = scene.conventions.surface_traction == "balanced" or pores is None
        spatial = scene.conventions.frame == "spatial"
        terms.append(SurfacePressure(1.0 if balanced else pores.biot, spatial, name))
    if film is not None:
        lubricant = Newtonian(film.viscosity / scales.viscosity,
                              film.shear_film_min / scales.length)
        leak = SEALED_FILM / scales.length if pores is None and contact is not None else 0.0
        softness = (law.constrained_modulus, mobility_of(scene, scales)) if law else None
        flow = Film(lubricant, plane, operation, name, solid, force, mesh.pressure_degree,
                    alone=pores is None, upwind=softness, leak=leak)
        squeeze = Squeeze(plane, name, solid, force) if scene.time is None or film.squeeze else None
        terms += [flow] if squeeze is None else [flow, squeeze]
        if pores is not None and pores.compressibility is not None:
            terms.append(CompressibleFilm(compressible(scene, scales), flow, squeeze))
    if contact is not None:
        friction = contact.friction if contact.friction_traction else 0.0
        terms.append(Contact(plane, operation, name, CONTACT_STIFFNESS, friction, force,
                             mesh.degree))
        if film is None and pores is not None:
            terms.append(Drainage(OPEN_SURFACE_CONDUCTANCE, plane, name, force))
    if force:
        terms.append(LoadBalance(operation, name, surface.area, contact is not None, fluid))
    return terms


def _traction(name: str, value: Any, scales: Scales, operation: Operation) -> Traction:
    """``value``: a normal traction or its components, each a number or a history."""
    def at(t: float) -> tuple[float, tuple[float, ...]]:
        if not isinstance(value, Components):
            return value_at(value, t) / scales.pressure, (0.0,) * scales.dim
        parts = [value_at(getattr(value, k), t) / scales.pressure for k in "xyz"[: scales.dim]]
        return 0.0, tuple(parts)

    return Traction(name, *at(0.0), operation, at)
