"""Rigid-body motions as vectors of displacement unknowns: what multigrid must keep exactly."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.solve.system import System

Array = NDArray[np.float64]


def rigid_motions(system: System) -> Array:
    """(modes, owned displacement dofs): translations, then rotations about the mesh's middle.

    In the frames displacements are stored in; zero where they are given.
    """
    dofs, constraints = system.dofs, system.constraints
    X = dofs.mesh.coordinates[dofs.nodes["u"]]
    X = X - dofs.mesh.comm.allreduce(X.sum(axis=0)) / dofs.mesh.comm.allreduce(len(X))
    dim = X.shape[1]
    motions = [np.tile(axis, (len(X), 1)) for axis in np.eye(dim)]
    for a, b in combinations(range(dim), 2):
        turn = np.zeros_like(X)
        turn[:, a], turn[:, b] = -X[:, b], X[:, a]
        motions.append(turn)
    where = dofs.range["u"]
    rows = []
    for motion in motions:
        local = np.zeros(dofs.size_local)
        local[where] = motion.ravel()
        local = system.stored(local)
        local[constraints.fixed] = 0.0
        rows.append(dofs.owned_part("u", local))
    return np.array(rows)


def near_nullspace(matrix: PETSc.Mat, motions: Array) -> PETSc.NullSpace:
    """The motions (modes, local rows), orthonormal, as the near-nullspace of a matrix."""
    vectors: list[PETSc.Vec] = []
    for motion in motions:
        v = matrix.createVecLeft()
        v.array[:] = motion
        for w in vectors:
            v.axpy(-v.dot(w), w)
        if v.norm() > 1e-8:
            v.normalize()
            vectors.append(v)
        else:
            v.destroy()
    space = PETSc.NullSpace().create(vectors=vectors, comm=matrix.comm)
    matrix.setNearNullSpace(space)
    for v in vectors:
        v.destroy()
    return space
