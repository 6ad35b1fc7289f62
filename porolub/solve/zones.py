"""Where on the lubricated surface something ends: contact, and the pressure that carries load.

Positions are arc positions in mesh units, measured along the surface of a structured mesh.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from petsc4py import PETSc

from porolub.solve.derived import Derived
from porolub.solve.model import Model

EDGES_APART = 0.5  # thicknesses between two places to refine toward
PRESSURISED = 0.1  # of the largest pressure

Ends = tuple[float, float]


def zones(model: Model, x: PETSc.Vec) -> Iterator[tuple[str, Ends]]:
    """First and last position of the "closed" zone and of the "pressurised" one, if there is one.

    Collective. A film that carries load ends in its own steep necks.
    """
    dofs, mesh = model.dofs, model.mesh
    if mesh.shape is None or model.lubricated is None:
        return
    d = Derived(model, x)
    s = d.arc()[d.mine]
    marks = {}
    if "l" in dofs.fields:
        marks["closed"] = d.contact_pressure()[d.mine] > 0.0
    if "p" in dofs.fields:
        p = d.nodal("p")[d.mine, 0]
        marks["pressurised"] = p > PRESSURISED * d.extreme(p, True)
    for name, mark in marks.items():
        ends = d.extreme(s[mark], False), d.extreme(s[mark], True)
        if np.isfinite(ends).all():
            yield name, ends


def contact_edges(model: Model, x: PETSc.Vec) -> tuple[float, ...]:
    """Positions worth fine elements, increasing; empty without a surface. Collective."""
    found: list[float] = []
    for _, ends in zones(model, x):
        found += [e for e in ends if all(abs(e - f) > EDGES_APART for f in found)]
    return tuple(sorted(found))
