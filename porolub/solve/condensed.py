"""The preconditioner of the coupled system: eliminate, split, substitute back.

1. The approach borders the rest: one more solve per matrix gives its column, and its equation is
   then met exactly.
2. Contact pressure leaves the system by an exact step (eliminated.py), volume change and velocity
   by a mass matrix (projected.py).
3. What is left is Biot's problem for u and p, held where it touches: PETSc's fieldsplit on a
   nested matrix, with the Schur matrix of schur.py (splitting.py).

All of PETSc's options for pc_fieldsplit apply, under their usual names; a scene without pressure
(or without displacement) has one block, which reads the options of that split alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.solve.eliminated import ContactRows, index_set
from porolub.solve.model import Model
from porolub.solve.projected import ENTERS, Projected
from porolub.solve.splitting import Splitting

Array = NDArray[np.float64]
SPLITS = ("u", "p")  # what the fieldsplit sees


class Condensed:
    """Context of a PC of type python for the matrix of a model.

    ``linearise`` is to be called with the state whenever the matrix is computed.
    """

    def __init__(self, model: Model) -> None:
        self.model, self.dofs = model, model.dofs
        fields = model.dofs.fields
        self.numbers = {name: model.dofs.owned_numbers(name) for name in fields}
        self.splits = [name for name in SPLITS if name in fields]
        if missed := set(fields) - {*SPLITS, *ENTERS, "l", "v0"}:
            raise ValueError(f"no split holds {missed}: its unknowns would stay 0")
        self.contact = ContactRows(model) if "l" in fields else None
        self.drags = "l" in fields and bool(model.scene.contact.friction_traction)
        self.splitting = Splitting(model, self.splits)
        self.projected: list[Projected] = []
        self._made: list[Any] = []
        self._border: tuple[PETSc.Vec, PETSc.Vec, float] | None = None

    def linearise(self, x: PETSc.Vec) -> None:
        """Take note of the state the matrix belongs to. Collective."""
        if self.splitting.schur is not None:
            self.splitting.schur.linearise(x)

    # -- set-up -----------------------------------------------------------------------------
    def setUp(self, pc: PETSc.PC) -> None:
        """Take the matrix apart. Collective."""
        self._free()
        matrix = pc.getOperators()[0]
        self._first = np.int32(matrix.getOwnershipRange()[0])
        self.rows = {name: self.numbers[name] for name in self.splits}
        held = np.zeros(len(self.numbers.get("u", ())), bool)
        if self.contact is not None:
            self.rows["u"] = self.contact.take_from(matrix, self.numbers["u"])
            held = self.rows["u"] != self.numbers["u"]
        self._place = {name: self.numbers[name] - self._first for name in self.splits}
        blocks = self._blocks(matrix)
        self._inner = self.splitting.set_up(blocks, held)
        self._reduced = self._keep(blocks.createVecLeft())
        self._answer = self._keep(blocks.createVecRight())
        self._parts = {name: self._keep(blocks.getNestSubMatrix(k, k).createVecRight())
                       for k, name in enumerate(self.splits)}
        self._set_border(matrix)

    def _keep(self, thing: Any) -> Any:
        self._made.append(thing)
        return thing

    def _blocks(self, matrix: PETSc.Mat) -> PETSc.Mat:
        """The nested matrix over u and p, all else eliminated."""
        comm = matrix.comm
        columns = {name: self._keep(index_set(self.numbers[name], comm)) for name in self.splits}
        rows = {name: self._keep(index_set(self.rows[name], comm)) for name in self.splits}
        block = {(r, c): self._keep(matrix.createSubMatrix(rows[r], columns[c]))
                 for r in self.splits for c in self.splits}
        if self.contact is not None:
            self.contact.couple(matrix, rows["u"], columns["u"], columns.get("p"))
            if self.drags:
                self.contact.drag(block["u", "u"], block.get(("u", "p")))
        for name, enters in ENTERS.items():
            if name in self.numbers:
                field = Projected(name, matrix, self.numbers[name], columns["u"], rows[enters])
                self.projected.append(self._keep(field))
                if name == "w":  # w is the rate of u
                    block["u", "u"].axpy(self.model.system.rate, field.forces,
                                         PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
        nest = [[block[r, c] for c in self.splits] for r in self.splits]
        return self._keep(PETSc.Mat().createNest(nest, comm=comm))

    def _set_border(self, matrix: PETSc.Mat) -> None:
        """Solve for the column of the approach."""
        if "v0" not in self.numbers:
            return
        one, column, row, z = (self._keep(matrix.createVecLeft()) for _ in range(4))
        one.set(0.0)
        self.dofs.set_scalar("v0", one, 1.0)
        matrix.mult(one, column)
        matrix.multTranspose(one, row)
        own = self.dofs.scalar_value("v0", row)
        self.dofs.set_scalar("v0", row, 0.0)
        self.dofs.set_scalar("v0", column, 0.0)
        self._interior(column, z)
        self._border = row, z, own - row.dot(z)

    # -- use --------------------------------------------------------------------------------
    def apply(self, pc: PETSc.PC, r: PETSc.Vec, z: PETSc.Vec) -> None:
        """z = P^-1 r. Collective."""
        self._interior(r, z)
        if self._border is not None:
            row, response, stiffness = self._border
            approach = (self.dofs.scalar_value("v0", r) - row.dot(z)) / stiffness
            z.axpy(-approach, response)
            self.dofs.set_scalar("v0", z, approach)

    def _interior(self, r: PETSc.Vec, z: PETSc.Vec) -> None:
        """All but the approach, which is left at 0."""
        known, found = r.array_r, np.zeros(r.getLocalSize())
        part = {name: known[self.rows[name] - self._first] for name in self.splits}
        if self.contact is not None:
            self.contact.forward(known, found, part["u"])
        for field in self.projected:
            part[field.enters] -= field.forward(known)
        self._reduced.array[:] = np.concatenate([part[name] for name in self.splits])
        self._inner.apply(self._reduced, self._answer)
        ends = np.cumsum([len(self.numbers[name]) for name in self.splits])
        for name, values in zip(self.splits, np.split(self._answer.array_r, ends[:-1]),
                                strict=True):
            self._parts[name].array[:] = values
            found[self._place[name]] = values
        if self.contact is not None:
            self.contact.backward(found, self._parts["u"], self._parts.get("p"))
        for field in self.projected:
            found[field.place] = field.backward(known, self._parts["u"])
        z.array[:] = found

    # -- end --------------------------------------------------------------------------------
    def _free(self) -> None:
        for thing in reversed(self._made):
            thing.destroy()
        self._made, self.projected, self._border = [], [], None

    def destroy(self, pc: PETSc.PC | None = None) -> None:
        """Free all that PETSc holds."""
        self._free()
        self.splitting.destroy()
        if self.contact is not None:
            self.contact.destroy()
