"""Sommerfeld number and lubrication regime of a solved case.

    Sommerfeld number   eta U / L      (de Boer et al. 2020, Section 3.2.2)

with the viscosity of the film, the surface speed and the load per width. The paper tells the
regimes apart by the film (hydrodynamic, elastohydrodynamic) and by the slope of the friction curve
(mixed, boundary). A slope needs neighbours; so that each case has a regime of its own, the latter
two are told apart by the film's friction coefficient beside the whole one. Along Case 1 by approach
the border lies where the slope d ln mu / d ln (eta U / L) has fallen to 0.1.
"""

from typing import Any

from porolub.io.summary import number
from porolub.scene import Scene
from porolub.scene.derived import surface_speed
from porolub.scene.geometry import Barrel, Block

HYDRODYNAMIC, ELASTOHYDRODYNAMIC = "hydrodynamic", "elastohydrodynamic"
MIXED, BOUNDARY = "mixed", "boundary"
REGIMES = (HYDRODYNAMIC, ELASTOHYDRODYNAMIC, MIXED, BOUNDARY)
"""From the thickest film to the closest contact."""

DEFORMED = 0.1
"""Of the least film thickness: where the surface gives way by more, it is not hydrodynamic."""
FILM_PART = 0.1
"""Of the friction coefficient: where the film's is less, lubrication is not mixed."""

CRITERIA = {
    HYDRODYNAMIC: f"no contact, $|h_{{min}} + v_0| \\leq {DEFORMED:g}\\,h_{{min}}$",
    ELASTOHYDRODYNAMIC: "no contact, surface deformed more",
    MIXED: f"contact, $μ_f \\geq {FILM_PART:g}\\,μ$",
    BOUNDARY: f"contact, $μ_f < {FILM_PART:g}\\,μ$",
}
"""What regime() asks for, as figures say it."""


def sommerfeld_number(scene: Scene, summary: dict[str, Any]) -> float | None:
    """Return eta U / L (dimensionless) of a finished case; None where it has no meaning.

    eta: viscosity of the film (Pa s); U: surface speed at t = 0 (m/s, without sign), of a rotating
    sector or barrel speed times outer radius; L: ``load_total`` of the summary, N/m, of a body
    over the width that is modelled (barrel, or block with a depth). None without film, motion or
    width, or where the load is not positive.
    """
    speed, load, width = surface_speed(scene), number(summary, "load_total"), modelled_width(scene)
    if scene.film is None or not speed or width is None or load is None or load <= 0:
        return None
    return scene.film.viscosity * speed * width / load


def modelled_width(scene: Scene) -> float | None:
    """Return the extent across the motion that loads refer to, m: 1 m of depth in 2D.

    Of a barrel cut in its middle plane half the width; None where the shape does not tell (a mesh
    file in 3D).
    """
    shape = scene.geometry
    if scene.dimension == 2:
        return 1.0
    if isinstance(shape, Barrel):
        return shape.width / 2 if shape.half else shape.width
    return shape.depth if isinstance(shape, Block) else None


def regime(summary: dict[str, Any]) -> str:
    """Return the lubrication regime of a finished case, one of REGIMES, from its summary (SI).

    - hydrodynamic: nothing touches and the surface is hardly deformed,
      |film_min - (-approach)| <= 0.1 film_min (at the approach v0 < 0 a rigid surface has the gap
      -v0);
    - elastohydrodynamic: nothing touches otherwise;
    - mixed: contact, and the friction coefficient of the film (its shear force over its load) is
      at least a tenth of that of the whole, friction_fluid >= 0.1 friction_coefficient;
    - boundary: contact otherwise.

    "" where there is nothing to tell: the case failed, or nothing touches and there is no film or
    no load on it.
    """
    film_min, approach = number(summary, "film_min"), number(summary, "approach")
    if summary.get("status") != "converged" or film_min is None:
        return ""
    lubricated = "film" in (summary.get("effects") or ())
    if film_min > 0:
        load = number(summary, "load_total")
        if not lubricated or approach is None or load is None or load <= 0:
            return ""
        stiff = abs(film_min + approach) <= DEFORMED * film_min
        return HYDRODYNAMIC if stiff else ELASTOHYDRODYNAMIC
    whole, film = number(summary, "friction_coefficient"), number(summary, "friction_fluid")
    if not lubricated or film is None or whole is None:
        return BOUNDARY
    return MIXED if abs(film) >= FILM_PART * abs(whole) and film else BOUNDARY
