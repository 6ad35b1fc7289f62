"""The pressure equation with the displacement eliminated, as the preconditioner needs it."""

from __future__ import annotations

from typing import Any

import numpy as np
from petsc4py import PETSc

from porolub.solve.model import Model
from porolub.solve.system import System
from porolub.terms.fixed_stress import FixedStress, WinklerFilm
from porolub.terms.term import Term

SOFTER = 1.4  # confined modulus over the one taken: the layer gives way sideways, too


def schur_terms(model: Model) -> list[Term]:
    """What the layer's deformation adds to the pressure block, estimated."""
    have: dict[str, Any] = {t.name: t for t in model.system.terms}
    if model.law is None:
        return []
    modulus = model.law.constrained_modulus
    terms: list[Term] = []
    if "storage" in have:
        terms.append(FixedStress(have["storage"], have.get("carry"),
                                 have.get("streamline stabilisation"), modulus / SOFTER))
    if "film" in have:
        terms.append(WinklerFilm(have["film"], "squeeze" in have, modulus))
    return terms


class SchurMatrix:
    """The block (p, p) of a model's matrix with ``schur_terms`` added."""

    def __init__(self, model: Model) -> None:
        dofs, full = model.dofs, model.system
        self._full = full
        self._extra = System(dofs, schur_terms(model), full.domains, full.constraints, full.finite)
        self._matrix = self._extra.create_matrix() if self._extra.terms else None
        fixed = np.zeros(dofs.size_local, bool)
        fixed[full.constraints.fixed] = True
        self._given = dofs.owned_part("p", fixed)

    def linearise(self, x: PETSc.Vec) -> None:
        """Estimate at a state. Collective."""
        if self._matrix is not None:
            self._extra.rate = self._full.rate
            self._extra.jacobian(x, self._matrix)

    def of(self, block: PETSc.Mat, rows: PETSc.IS) -> PETSc.Mat:
        """The Schur matrix to the system's own ``block``, whose global rows are ``rows``."""
        if self._matrix is None:
            return block.copy()
        total = self._matrix.createSubMatrix(rows, rows)
        diagonal = total.getDiagonal()
        diagonal.array[self._given] = 0.0  # ones stand in these rows of both
        total.setDiagonal(diagonal)
        total.axpy(1.0, block, PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN)
        diagonal.destroy()
        return total

    def destroy(self) -> None:
        if self._matrix is not None:
            self._matrix.destroy()
