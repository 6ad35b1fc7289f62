"""Where a failing solve is worst: for messages only, so called once at the end."""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from porolub.fem.dofs import Dofs

Place = tuple[float, ...]


def place_of_largest(dofs: Dofs, name: str, v: PETSc.Vec) -> Place | None:
    """Node (mesh units) where a field of a global vector is largest in size. Collective.

    None for a scalar, which has no place.
    """
    f = dofs.fields[name]
    if f.degree == 0:
        return None
    sizes = np.abs(dofs.field(name, dofs.to_local(v))).max(axis=1, initial=0.0)
    sizes = np.where(np.isnan(sizes), np.inf, sizes)
    here: tuple[float, Place] = (-1.0, ())
    if len(sizes):
        k = int(sizes.argmax())
        here = (float(sizes[k]), tuple(dofs.mesh.coordinates[dofs.nodes[name][k]].tolist()))
    return max(dofs.mesh.comm.allgather(here))[1]


def place_in_words(place: Place, length: float) -> str:
    """``x = 4.51 mm, y = 0.1 mm`` of a place in mesh units of ``length`` metres."""
    return ", ".join(f"{axis} = {1e3 * length * value:.3g} mm"
                     for axis, value in zip("xyz", place, strict=False))
