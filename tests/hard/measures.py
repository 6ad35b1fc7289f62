"""What is measured of a state, steady or within a run: numbers that the bounds are about."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.solve.derived import Derived
from porolub.solve.model import Model
from tests.hard.stable import sawtooth

Array = NDArray[np.float64]
LEAST = 1e-6  # of the layer's modulus: pressures below are measured by it
CONTACT = 1e-3, 1.0  # of it: what contact pressures are measured by is kept between


@dataclass(frozen=True)
class Measures:
    """contact: see ``complementarity``; along, across: oscillation of the fluid pressure along the
    surface and, on built meshes, over every line through the thickness; largest: its largest
    value, all scaled by the layer's modulus."""

    contact: float
    along: float
    across: float
    largest: float


def measured(model: Model, x: PETSc.Vec) -> Measures:
    d = Derived(model, x)
    contact = complementarity(d) if "l" in model.dofs.fields else 0.0
    if "p" not in model.dofs.fields or model.surface is None:
        return Measures(contact, 0.0, 0.0, LEAST)
    pressure = d.nodal("p")[:, 0]
    nodes = d.nodes[np.isin(d.nodes, model.dofs.nodes["p"])]
    line = pressure[nodes[np.argsort(d.arc()[nodes])]]
    across = max((sawtooth(column) for column in through_thickness(d, pressure)), default=0.0)
    return Measures(contact, sawtooth(line), across, max(float(np.abs(pressure).max()), LEAST))


def through_thickness(d: Derived, pressure: Array) -> list[Array]:
    """Nodal pressures along the lines through the thickness; none for a mesh from a file."""
    mesh, nodes = d.model.mesh, d.model.dofs.nodes["p"]
    if mesh.shape is None or d.model.dofs.fields["p"].support != "body":
        return []
    place = np.round(mesh.logical(mesh.coordinates[nodes]), 9)
    order = np.lexsort((place[:, 1], place[:, 0]))
    return np.split(pressure[nodes[order]], np.flatnonzero(np.diff(place[order, 0])) + 1)


def complementarity(d: Derived) -> float:
    """Largest violation of p_c >= 0, gap >= 0, p_c gap = 0 at the nodes.

    Pressures as shares of the largest contact pressure (within CONTACT), gaps of the thickness.
    The pressures are the unknowns themselves, nothing is cut off.
    """
    gap, pressure = d.gap()[d.mine], d.nodal("l")[d.mine, 0]
    share = pressure / np.clip(np.abs(pressure).max(), *CONTACT)
    return float(max(-gap.min(), -share.min(), np.minimum(np.abs(gap), np.abs(share)).max(), 0.0))
