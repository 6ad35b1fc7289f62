"""Through which boundaries the motion goes, measured on the mesh.

The carry term needs a body of revolution: where it turns through its own surface (v . n not 0)
the place it leaves is not the one it had. What passes the other boundaries enters and leaves.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from mpi4py import MPI

from porolub.errors import SceneError
from porolub.fem.domains import Domain
from porolub.terms.operation import Operation

PASSES = 1e-6  # share of the speed from which a boundary is passed
REVOLVED = 5e-3  # share up to which a faceted surface counts as one of revolution


def passing(mesh: Any, operation: Operation, names: tuple[str, ...]) -> dict[str, float]:
    """Root mean square of v . n over that of |v| on each of the boundaries. Collective.

    v is that of what moves, body or plane, whatever its speed. A facet counts by its mean: flat
    facets of a round surface are passed back and forth.
    """
    at_speed = replace(operation, speed=1.0)
    sums = np.zeros((len(names), 2))
    for k, name in enumerate(names):
        facets = Domain(f"facets:{name}", mesh, 2)
        v = at_speed.body_velocity(facets.position) + at_speed.plane_velocity(facets.position)
        w = facets.weights
        through = np.einsum("eq,eqd,eqd->e", w, v, facets.normal)
        sums[k] = (through**2 / w.sum(axis=1)).sum(), np.einsum("eq,eqd,eqd->", w, v, v)
    mesh.comm.Allreduce(MPI.IN_PLACE, sums)
    share = np.sqrt(sums[:, 0] / np.maximum(sums[:, 1], 1e-300))
    return dict(zip(names, share.tolist(), strict=True))


def ends_of_motion(scene: Any, mesh: Any, operation: Operation) -> tuple[str, ...]:
    """The boundaries through which the body carries its fluid in or out. Collective.

    Raises SceneError where the motion passes a symmetry plane, and where carry would take the
    body through its lubricated surface or its bone.
    """
    if operation.kind == "rest":
        return ()
    shape = scene.geometry
    share = passing(mesh, operation, mesh.boundary_names)
    crossed = [name for name in shape.symmetry if share.get(name, 0.0) > PASSES]
    if crossed:
        raise SceneError(f'geometry.symmetry: "{crossed[0]}" is passed by the motion (v . n is '
                         f"{100 * share[crossed[0]]:.2g} % of v): set another direction or axis, "
                         "or take it out of geometry.symmetry.")
    if scene.pores is None or not scene.pores.carry:
        return ()
    closed = (shape.lubricated, shape.bone)
    for name in closed:
        if share.get(name, 0.0) > REVOLVED:
            raise SceneError(
                f'pores.carry = true: the boundary "{name}" is no surface of revolution about '
                f"motion.axis (v . n is {100 * share[name]:.2g} % of v), so the body would turn "
                "through it: change motion.axis or motion.centre, or set pores.carry = false.")
    return tuple(name for name in mesh.boundary_names
                 if name not in closed and share[name] > PASSES)
