"""Every term by itself, as the tests need it: on a mesh, with the fields it reads."""

from collections.abc import Callable
from dataclasses import dataclass

from porolub.laws.fluid import CompressibleFluid
from porolub.laws.lubricant import Newtonian
from porolub.laws.solid import LinearElastic, NeoHookean
from porolub.mesh import Mesh
from porolub.terms.carry import Carry
from porolub.terms.compressibility import CompressibleFilm, CompressiblePores
from porolub.terms.contact import Contact
from porolub.terms.drainage import Drainage
from porolub.terms.film import Film
from porolub.terms.inertia import Inertia
from porolub.terms.load import LoadBalance
from porolub.terms.operation import Operation
from porolub.terms.plane import Plane
from porolub.terms.pores import Pores
from porolub.terms.skeleton import Skeleton
from porolub.terms.squeeze import Squeeze
from porolub.terms.storage import Storage
from porolub.terms.streamline import Streamline
from porolub.terms.surface_pressure import SurfacePressure
from porolub.terms.term import Term
from tests.terms.support import operation, plane_below

LINEAR, NEO = LinearElastic(0.45, 0.7), NeoHookean(0.45, 0.7)
LUBRICANT = Newtonian(viscosity=1e-3, shear_film_min=1e-3)
BIOT, MOBILITY, STORAGE, POROSITY = 0.9, 0.7, 0.6, 0.8
FLUID = CompressibleFluid(0.6)


@dataclass(frozen=True)
class Setting:
    """Where a term is tried: mesh, lubricated surface, operating point, plane."""

    mesh: Mesh
    boundary: str
    operation: Operation
    plane: Plane

    @property
    def ends(self) -> tuple[str, str]:
        return ("inlet", "outlet") if self.boundary == "lubricated" else ("left", "right")


def setting(mesh: Mesh, boundary: str, kind: str = "rotation", **others: object) -> Setting:
    at = operation(kind, 0.7, **{"direction": (1.0, 0.0, 0.3)[: mesh.dim]} | others)
    return Setting(mesh, boundary, at, plane_below(mesh, boundary, at))


@dataclass(frozen=True)
class Case:
    """A term, the fields it needs, and the pairs of fields its Jacobian fills.

    finite: kinematics it is tried with; also: pairs that are filled for finite strain only.
    """

    build: Callable[[Setting], Term]
    fields: tuple[str, ...]
    pairs: set[tuple[str, str]]
    finite: tuple[bool, ...] = (True, False)
    also: frozenset[tuple[str, str]] = frozenset()
    surface: bool = False
    kind: str = "rotation"


def film(upwind: tuple[float, float] | None = None, displacement: bool = True,
         approach: bool = True, alone: bool = False) -> Callable[[Setting], Term]:
    return lambda s: Film(LUBRICANT, s.plane, s.operation, s.boundary, displacement, approach, 1,
                          alone, upwind)


def contact(friction: float) -> Callable[[Setting], Term]:
    return lambda s: Contact(s.plane, s.operation, s.boundary, 1.0, friction, True, s.mesh.degree)


def squeeze(displacement: bool, approach: bool) -> Callable[[Setting], Term]:
    return lambda s: Squeeze(s.plane, s.boundary, displacement, approach)


def compressible_pores(spatial: bool, fresh: bool | None) -> Callable[[Setting], Term]:
    """``fresh`` None: nothing is carried."""
    def build(s: Setting) -> Term:
        carry = None if fresh is None else Carry(BIOT, s.operation, s.ends, fresh)
        return CompressiblePores(FLUID, POROSITY, Pores(BIOT, MOBILITY, spatial, 1),
                                 Storage(BIOT, STORAGE), carry)

    return build


def compressible_film(displacement: bool, approach: bool,
                      squeezed: bool = True) -> Callable[[Setting], Term]:
    def build(s: Setting) -> Term:
        film = Film(LUBRICANT, s.plane, s.operation, s.boundary, displacement, approach, 1, False)
        store = Squeeze(s.plane, s.boundary, displacement, approach) if squeezed else None
        return CompressibleFilm(FLUID, film, store)

    return build


UU, UP, PU, PP = ("u", "u"), ("u", "p"), ("p", "u"), ("p", "p")
SURFACE_PAIRS = {PP, PU, ("p", "v0")}

CASES = {
    "linear skeleton": Case(lambda s: Skeleton(LINEAR, s.mesh.dim, 2), (), {UU}, (False,)),
    "neo-hookean skeleton": Case(lambda s: Skeleton(NEO, s.mesh.dim, 2), (), {UU}, (True,)),
    "pores, spatial": Case(lambda s: Pores(BIOT, MOBILITY, True, 1), ("u",), {UP, PP},
                           also=frozenset({UU, PU})),
    "pores, material": Case(lambda s: Pores(BIOT, MOBILITY, False, 1), ("u",), {UP, PP}),
    "storage": Case(lambda s: Storage(BIOT, 0.2), ("u", "p"), {PU, PP}),
    "carry": Case(lambda s: Carry(BIOT, s.operation, s.ends, False), ("u", "p"), {PU}),
    "carry, fresh": Case(lambda s: Carry(BIOT, s.operation, s.ends, True), ("u", "p"), {PU}),
    "streamline": Case(lambda s: Streamline(BIOT, 0.8, 0.05, s.operation, 1), ("u", "p"),
                       {("j", "j"), ("j", "u"), ("p", "j")}),
    "surface pressure, spatial": Case(lambda s: SurfacePressure(0.9, True, s.boundary),
                                      ("u", "p"), {UP}, also=frozenset({UU})),
    "surface pressure, material": Case(lambda s: SurfacePressure(0.9, False, s.boundary),
                                       ("u", "p"), {UP}),
    "rigid film": Case(film(displacement=False, alone=True), ("v0",), {PP, ("p", "v0")},
                       surface=True),
    "rigid film, given approach": Case(film(displacement=False, approach=False, alone=True), (),
                                       {PP}, surface=True),
    "film": Case(film(), ("u", "p", "v0"), SURFACE_PAIRS, surface=True),
    "film of a sliding plane": Case(film(), ("u", "p", "v0"), SURFACE_PAIRS, surface=True,
                                    kind="sliding"),
    "film on a porous layer": Case(film((1.3, 0.01)), ("u", "p", "v0"), SURFACE_PAIRS,
                                   surface=True),
    "film on a layer, given approach": Case(film((1.3, 0.01), approach=False), ("u", "p"),
                                            {PP, PU}, surface=True),
    "film on an impermeable layer": Case(film((1.3, 0.0), alone=True), ("u", "v0"), SURFACE_PAIRS,
                                         surface=True),
    "squeeze": Case(squeeze(True, True), ("u", "p", "v0"), {PU, ("p", "v0")}, surface=True),
    "squeeze, rigid": Case(squeeze(False, True), ("p", "v0"), {("p", "v0")}, surface=True),
    "contact": Case(contact(0.0), ("u", "v0"), {("u", "l"), ("l", "l"), ("l", "u"), ("l", "v0")},
                    surface=True),
    "contact, friction": Case(contact(0.45), ("u", "v0"),
                              {("u", "l"), ("l", "l"), ("l", "u"), ("l", "v0")}, surface=True),
    "inertia": Case(lambda s: Inertia(0.3, s.mesh.dim, s.mesh.degree), ("u",),
                    {("u", "w"), ("w", "u"), ("w", "w")}),
    "compressible pores, spatial": Case(compressible_pores(True, False), ("u", "p"), {PU, PP}),
    "compressible pores, material, fresh": Case(compressible_pores(False, True), ("u", "p"),
                                                {PU, PP}),
    "compressible pores at rest": Case(compressible_pores(False, None), ("u", "p"), {PU, PP}),
    "compressible film": Case(compressible_film(True, True), ("u", "p", "v0"), SURFACE_PAIRS,
                              surface=True),
    "compressible film of a sliding plane": Case(
        compressible_film(True, True), ("u", "p", "v0"), SURFACE_PAIRS, surface=True,
        kind="sliding"),
    "compressible film, rigid": Case(compressible_film(False, True, False), ("p", "v0"),
                                     {PP, ("p", "v0")}, surface=True),
    "compressible film, given approach": Case(compressible_film(True, False), ("u", "p"),
                                              {PP, PU}, surface=True),
    "open surface": Case(lambda s: Drainage(1e3, s.plane, s.boundary, True), ("u", "p", "v0"),
                         SURFACE_PAIRS, surface=True),
    "load": Case(lambda s: LoadBalance(s.operation, s.boundary, 2.0, True, True), ("p", "l"),
                 {("v0", "p"), ("v0", "l")}),
}
