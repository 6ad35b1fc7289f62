"""Fields that follow another by a mass matrix: volume change (j) and velocity (w).

j: M j = what u does to the volume; it enters the pressure's rows.  w: M w = rate of u; it enters
the displacement's rows, where with M's inverse it is a mass on u.  Both leave the system by
solving with M to a few digits.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.solve.eliminated import Ints, index_set

Array = NDArray[np.float64]
ENTERS = {"j": "p", "w": "u"}  # field -> whose rows it enters


class Projected:
    """One such field in one matrix; ``first`` is the rank's first global row."""

    def __init__(self, name: str, matrix: PETSc.Mat, numbers: Ints, u: PETSc.IS,
                 rows: PETSc.IS) -> None:
        """``numbers``: its unknowns; ``rows``: the global rows it enters. Collective."""
        self.enters = ENTERS[name]
        self.place = numbers - np.int32(matrix.getOwnershipRange()[0])
        own = index_set(numbers, matrix.comm)
        self._mass = matrix.createSubMatrix(own, own)
        self._follows = matrix.createSubMatrix(own, u)
        self.forces = matrix.createSubMatrix(rows, own)
        own.destroy()
        self._ksp = PETSc.KSP().create(matrix.comm)
        self._ksp.setOptionsPrefix(f"fieldsplit_{name}_")
        self._ksp.setOperators(self._mass)
        self._ksp.setFromOptions()
        self._x, self._b = self._mass.createVecs()
        self._force = self.forces.createVecLeft()

    def _solved(self, values: Array) -> PETSc.Vec:
        self._b.array[:] = values
        self._ksp.solve(self._b, self._x)
        return self._x

    def forward(self, r: Array) -> Array:
        """What its own right-hand side (of all of ``r``) adds to the rows it enters."""
        self.forces.mult(self._solved(r[self.place]), self._force)
        return np.asarray(self._force.array_r)

    def backward(self, r: Array, u: PETSc.Vec) -> Array:
        """The field itself, once u is known."""
        self._follows.mult(u, self._b)
        return np.asarray(self._solved(r[self.place] - self._b.array_r).array_r)

    def destroy(self) -> None:
        things: list[Any] = [self._ksp, self._mass, self._follows, self.forces, self._x, self._b,
                             self._force]
        for thing in things:
            thing.destroy()
