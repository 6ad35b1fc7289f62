"""The steady hard cases: Case 1 with one thing at a time taken to its extremes, on both bases.

Sliding: frictionless base, friction does not shear the layer; bonded: it does.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tests.hard.case import MESH, Bounds, Case

BASES = {"sliding": "case1", "bonded": "case1_bonded"}
FINER = (f"mesh.along={2 * MESH[0]}", f"mesh.across={2 * MESH[1]}")
WIDE = (120, 6)
FINER_WIDE = ("mesh.along=240", "mesh.across=12")
OPEN = (", but on the sliding base not a resolved one: what enters is open (conventions.entering) "
        "and hangs on the little that drains, of which these elements make too much.")
CLOSE = ", within 5 % of a finer mesh."
UNRESOLVED = {"within": 0.6, "bounds": Bounds(steady=1e-6, across=0.1)}
"""A layer on a sliding base comes with the J it leaves with, but for what drains on the way, so
that alone sets its level. At 1e-18 m2 that happens 10 um below the surface; elements are 167 um
high and drain too much: the approach is 178, 143, 130 um on 30 x 3, 60 x 6, 120 x 12. The matrix
determines the level to six digits only. A warning says that the mesh does not resolve it."""
THICK = (", but on the sliding base not a resolved one: thick fluid hardly drains into the film, "
         "so that the level of J and with it approach and friction hang on the elements.")
VISCOUS = {"within": 0.9, "bounds": Bounds(steady=1e-6)}
"""Film of 1 Pa s: the last nodes in contact decide the friction, 2.14, 1.75, 1.35 on 60 x 6 to
240 x 24; of 10 Pa s: the approach is 23.5, 2.6, -11.6 um under a film of 80 to 96 um. Film and
pores of 10 Pa s: J = 0.14 at a suction of 8.8 MPa, which no fluid bears: there is no cavitation
model."""
CARRIES = {(300, 1): {"refined": (), "stable": "A steady state, all of the load in the fluid."},
           (500, 1): {"refined": (), "fails": "Newton's steps stay implausibly long",
                      "stable": "Exit code 3: no step leads on to such a load."}}

NO_LEVEL = Case(
    "permeability", "1e-20 m2, sliding",
    "Exit code 3: the start-up settles, but no Newton step determines the level of J any more.",
    "case1", ("pores.permeability=1e-20 m^2",), fails="The steady solve failed", slow=True)
"""Updates wander by 1e-6 to 1e-4 of the volume, which is rounding over what drains: too much to be
taken for convergence (Newton._rounding). Each of up to 400 start-up steps tries again, 40 s."""


def steady_cases() -> list[Case]:
    return [*speeds(), *permeabilities(), *poisson_ratios(), *approaches(), *viscosities(),
            *frictions(), *layers()]


def both(group: str, name: str, stable: str, overrides: tuple[str, ...],
         fast: tuple[str, ...] = (), bases: tuple[str, ...] = tuple(BASES),
         **of_base: Any) -> Iterator[Case]:
    """A case on either base; ``fast``: the bases that are in the fast suite; what a base has of
    its own goes under its name."""
    for base in bases:
        job = BASES[base]
        own = {k: v for k, v in of_base.items() if k not in BASES} | of_base.get(base, {})
        own.setdefault("refined", FINER)
        yield Case(group, f"{name}, {base}", own.pop("stable", stable), job, overrides,
                   slow=base not in fast, **own)


def speeds() -> Iterator[Case]:
    """1e-3 rad/s is 0.1 mm/s at the surface, 20 rad/s 2 m/s: Peclet numbers 0.1 to 2000."""
    for speed in (0.001, 0.01, 0.1, 1.0, 5.0, 20.0):
        yield from both("speed", f"{speed:g} rad/s",
                        "A steady state; loads, friction and approach within 6 % of a finer mesh.",
                        (f"motion.speed={speed} rad/s",), within=0.06,
                        fast=("sliding", "bonded") if speed in (0.001, 20.0) else ())
    for speed in (0.001, 1.0, 20.0):
        yield from both("speed", f"{-speed:g} rad/s", "The mirror image of the other sense.",
                        (f"motion.speed={-speed} rad/s",), within=1e-8,
                        refined=(f"motion.speed={speed} rad/s",),
                        fast=("bonded",) if speed == 20.0 else ())


def permeabilities() -> Iterator[Case]:
    for power in range(13, 21):
        hardly = power >= 18
        if power == 20:
            yield NO_LEVEL
        yield from both("permeability", f"1e-{power} m2",
                        "A steady state" + (OPEN if hardly else CLOSE),
                        (f"pores.permeability=1e-{power} m^2",), within=0.05,
                        sliding=UNRESOLVED if hardly else {},
                        fast=("sliding", "bonded") if power in (13, 17) else (),
                        bases=("bonded",) if power == 20 else tuple(BASES))
    yield Case("permeability", "1e-19 m2, sliding, fresh layer enters",
               "A steady state; known inflow takes the approach to within 3 % of a finer mesh.",
               "case1", ("pores.permeability=1e-19 m^2", "conventions.entering=fresh"),
               refined=FINER, within=0.2, slow=True)


def poisson_ratios() -> Iterator[Case]:
    """Shear modulus 0.5 MPa; bulk modulus 0.33 MPa to 250 MPa."""
    shear = 0.5
    for ratio in (0.0, 0.3, 0.45, 0.49, 0.499):
        bulk = 2.0 * shear * (1.0 + ratio) / (3.0 * (1.0 - 2.0 * ratio))
        yield from both("Poisson ratio", f"{ratio:g}",
                        "A steady state that does not lock: within 8 % of a finer mesh.",
                        (f"solid.bulk_modulus={bulk:.6g} MPa",), within=0.08,
                        fast=("sliding", "bonded") if ratio in (0.0, 0.499) else ())
        if ratio > 0.3:
            yield Case("Poisson ratio", f"{ratio:g}, dry",
                       "Dry contact that does not lock: within 0.1 % of a finer mesh.",
                       "dry_contact", (f"solid.poisson_ratio={ratio}",), refined=FINER,
                       within=1e-3, slow_reference=ratio != 0.499)


def approaches() -> Iterator[Case]:
    """On 20 degrees, 35 mm, as at 0.5 mm the layer is in contact on 20 mm of its surface.

    Bonded and rolling at 1 rad/s, 0.3 mm carry 75 kN/m in fluid alone: 2000 Newton steps, and no
    finer mesh to compare with.
    """
    for speed in (0.001, 1):
        for depth in (-10, 0, 100, 300, 500):
            yield from both("approach", f"{depth} um at {speed} rad/s",
                            "A steady state whose load is within 5 % of a finer mesh.",
                            (f"load={{approach='{depth} um'}}", f"motion.speed={speed} rad/s",
                             "geometry.half_angle=10 deg"), mesh=WIDE, refined=FINER_WIDE,
                            bonded=CARRIES.get((depth, speed), {}),
                            within=0.05, fast={(-10, 1): ("bonded",), (500, 0.001): ("sliding",)
                                               }.get((depth, speed), ()))


def viscosities() -> Iterator[Case]:
    """Of the film alone, and of the pores, too: 10 Pa s is there what 1e-19 m2 is at 1 mPa s."""
    for viscosity in ("1e-6", "1e-4", "1e-2", "1", "10"):
        for where in ("film", "film and pores"):
            overrides = tuple(f"{k}.viscosity={viscosity} Pa*s" for k in where.split(" and "))
            hard = viscosity in ("1", "10")
            yield from both("viscosity", f"{viscosity} Pa s in {where}",
                            "A steady state" + (THICK if hard else CLOSE),
                            overrides, within=0.05, sliding=VISCOUS if hard else {},
                            fast=("sliding", "bonded") if viscosity in ("1e-6", "1e-2") else ())


def frictions() -> Iterator[Case]:
    for friction in (0, 0.1, 0.45, 1):
        for shears in (False, True):
            yield from both("friction", f"{friction} that {'shears' * shears or 'is counted'}",
                            "A steady state, within 8 % of a finer mesh.",
                            (f"contact.friction={friction}",
                             f"contact.friction_traction={str(shears).lower()}"), within=0.08,
                            fast=("bonded",) if friction == 1 and shears else
                            ("sliding",) if friction == 1 else ())


def layers() -> Iterator[Case]:
    """A layer of 10 mm takes 100 times as long to drain as one of 1 mm."""
    for thickness in (0.1, 0.3, 3, 10):
        thick = thickness > 1
        thin = ", its approach within 15 % of a finer mesh."
        yield from both("layer", f"{thickness} mm",
                        "A steady state" + (OPEN if thick else thin if thickness == 0.1 else CLOSE),
                        (f"geometry.thickness={thickness} mm",),
                        within={0.1: 0.15, 0.3: 0.05}.get(thickness, 0.08),
                        sliding=UNRESOLVED if thick else {},
                        fast=("sliding", "bonded") if thickness in (0.1, 10) else ())
