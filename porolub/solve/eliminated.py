"""Unknowns that leave the linear system by one exact step each, before any preconditioner.

Contact: an open node's row says l; a closed node's row says the gap, and the row of the
displacement that moves into the plane says l.  So the gap's row takes the place of that row, as
a prescribed displacement would: what is left is a layer held where it touches.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.solve.model import Model

Array = NDArray[np.float64]
Ints = NDArray[np.int32]


def index_set(numbers: Ints, comm: PETSc.Comm) -> PETSc.IS:
    """Global numbers as PETSc's index set."""
    return PETSc.IS().createGeneral(np.asarray(numbers, dtype=PETSc.IntType), comm=comm)


class ContactRows:
    """Contact pressure, eliminated from a matrix whose active nodes are known from its rows."""

    def __init__(self, model: Model) -> None:
        dofs, mesh = model.dofs, model.mesh
        assert model.plane is not None
        nodes = dofs.nodes["l"]
        nodes = nodes[mesh.owned[nodes]]
        self.rows = dofs.global_numbers[dofs.base["l"][nodes]]
        into = np.zeros(dofs.size_local)
        dofs.field("u", into)[...] = model.plane.toward
        into = model.system.stored(into)
        into[model.system.constraints.fixed] = 0.0
        first = dofs.base["u"][nodes]
        chosen = np.abs(into[first[:, None] + np.arange(mesh.dim)]).argmax(axis=1)
        self._partners = dofs.global_numbers[first + chosen]
        self._made: list[PETSc.Mat] = []

    def take_from(self, matrix: PETSc.Mat, u: Ints) -> Ints:
        """Note the active nodes; the global rows that stand for those ``u`` of displacement."""
        self._first, end = matrix.getOwnershipRange()
        diagonal = matrix.getDiagonal()
        self._own = diagonal.array_r[self.rows - self._first].copy()
        diagonal.destroy()
        self.active = self._own == 0.0
        self.partners = self._partners[self.active]
        stands = np.arange(self._first, end, dtype=np.int32)
        stands[self.partners - self._first] = self.rows[self.active]
        return stands[u - np.int32(self._first)]

    def couple(self, matrix: PETSc.Mat, stand_ins: PETSc.IS, u: PETSc.IS, p: PETSc.IS | None
               ) -> None:
        """Extract what leads to and from the contact pressure. Collective."""
        self.destroy()
        sets = [index_set(numbers, matrix.comm)
                for numbers in (self.rows, self.partners, self.rows[self.active])]
        contact, partners, active = sets
        self.push = matrix.createSubMatrix(stand_ins, contact)
        self.of_u = matrix.createSubMatrix(partners, u)
        self.of_p = matrix.createSubMatrix(partners, p) if p is not None else None
        own = matrix.createSubMatrix(partners, active)
        diagonal = own.getDiagonal()
        self._reacts = diagonal.array_r.copy()
        diagonal.destroy()
        own.destroy()
        for s in sets:
            s.destroy()
        self._made = [m for m in (self.push, self.of_u, self.of_p) if m is not None]
        self._pressure, self._force = self.push.createVecs()
        self._reaction = self.of_u.createVecLeft()
        self._made += [self._pressure, self._force, self._reaction]

    def drag(self, K: PETSc.Mat, G: PETSc.Mat | None) -> None:
        """Friction: rows along the plane follow the pressure, so they take over its rows, too."""
        scaled = self._active_columns()
        for block, rows in ((K, self.of_u), (G, self.of_p)):
            if block is not None and rows is not None:
                product = scaled.matMult(rows)
                block.axpy(-1.0, product, PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN)
                product.destroy()
        scaled.destroy()

    def _active_columns(self) -> PETSc.Mat:
        """Forces by the reaction of the active nodes' displacement rows; no zeros are stored."""
        begin = self.push.getOwnershipRangeColumn()[0]
        indptr, columns, values = self.push.getValuesCSR()
        row = np.repeat(np.arange(len(indptr) - 1), np.diff(indptr))
        number = np.cumsum(self.active) - 1  # of an active node among this rank's active ones
        mine = columns - begin  # forces act on their own node, so nodes are this rank's
        keep = (values != 0.0) & self.active[mine]
        count = np.bincount(row[keep], minlength=len(indptr) - 1)
        start = self.of_u.getOwnershipRange()[0]
        active = number[mine[keep]]
        csr = (np.concatenate([[0], np.cumsum(count)]).astype(PETSc.IntType),
               (start + active).astype(PETSc.IntType), values[keep] / self._reacts[active])
        sizes = (self.push.getSizes()[0], self.of_u.getSizes()[0])
        return PETSc.Mat().createAIJ(sizes, csr=csr, comm=self.push.comm)

    def forward(self, r: Array, z: Array, ru: Array) -> None:
        """What is known of the pressure so far into z, and its force off ``ru``, in place."""
        pressure = np.empty(len(self.rows))
        closed, opened = self.active, ~self.active
        pressure[opened] = r[self.rows[opened] - self._first] / self._own[opened]
        pressure[closed] = r[self.partners - self._first] / self._reacts
        z[self.rows - self._first] = pressure
        self._pressure.array[:] = pressure
        self.push.mult(self._pressure, self._force)
        ru -= self._force.array_r

    def backward(self, z: Array, zu: PETSc.Vec, zp: PETSc.Vec | None) -> None:
        """The pressure of the active nodes from the rows that gave way to theirs."""
        where = self.rows[self.active] - self._first
        for rows, part in ((self.of_u, zu), (self.of_p, zp)):
            if rows is not None and part is not None:
                rows.mult(part, self._reaction)
                z[where] -= self._reaction.array_r / self._reacts

    def destroy(self) -> None:
        for o in self._made:
            o.destroy()
        self._made = []
