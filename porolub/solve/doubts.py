"""Why a solution that converged may still be wrong: sentences that every result comes with."""

from __future__ import annotations

from typing import Any

from porolub.solve.estimate import Numbers

UNCERTAIN = 0.2
"""Estimated relative error from which a number is not resolved."""
VACUUM = -101325.0
"""Pa, beside the atmosphere's pressure, which is 0 here."""

NAMES = {"friction_coefficient": "friction", "load_solid": "load by contact",
         "load_fluid": "load by the fluid", "approach": "approach",
         "contact_length": "contact length"}


def doubts(scene: Any, numbers: Numbers, errors: Numbers) -> list[str]:
    """Sentences on the ``numbers`` of a summary and their absolute ``errors``, SI; none is good.

    Errors of loads count beside the total load.
    """
    found = []
    uncertain = _uncertain(numbers, errors)
    if uncertain:
        shown = {name: f"{100 * share:.0f}" for name, share in uncertain.items()}
        largest_first = sorted(shown, key=lambda name: -float(shown[name]))
        which = ", ".join(f"{NAMES[name]} by {shown[name]} %" for name in largest_first)
        steps = " or the time steps do" if scene.time is not None else " does"
        found.append(f"The mesh{steps} not resolve this state: uncertain are {which} (estimated). "
                     f"{_advice(scene)}")
    lowest = numbers.get("pressure_min")
    if lowest is not None and lowest < VACUUM:
        found.append(f"The fluid pressure falls to {lowest / 1e3:.0f} kPa, below vacuum "
                     f"({VACUUM / 1e3:.0f} kPa): there the fluid would cavitate, which is not "
                     "modelled.")
    return found


def _uncertain(numbers: Numbers, errors: Numbers) -> dict[str, float]:
    """Relative errors of NAMES that are UNCERTAIN or larger."""
    load = abs(numbers.get("load_total") or 0.0)
    found = {}
    for name in NAMES:
        value, error = numbers.get(name), errors.get(name)
        size = load if name.startswith("load") else abs(value or 0.0)
        if error is not None and size and error >= UNCERTAIN * size:
            found[name] = error / size
    return found


def _advice(scene: Any) -> str:
    finer = "mesh.along and mesh.across"
    if scene.mesh.grading == "none":
        finer += ' or mesh.grading = "contact"'
    if scene.time is not None:
        finer += " or a smaller time.tolerance"
    text = f"Try larger {finer}."
    solid, pores, film = scene.solid, scene.pores, scene.film
    if (solid is not None and solid.base == "sliding" and pores is not None and pores.carry
            and film is not None and scene.conventions.entering == "computed"):
        text += (' Where hardly anything drains, what enters a layer on a sliding base is hardly '
                 'determined: try conventions.entering = "fresh".')
    return text
