"""The preconditioner of the coupled system: eliminate, split, substitute back.

1. The approach borders the rest: one more solve per matrix gives its column, and its equation is
   then met exactly.
2. Contact pressure, volume change and velocity leave the system by exact steps (eliminated.py;
   the last two are mass matrices, "solved" to a few digits).
3. What is left is Biot's problem for u and p, held where it touches: PETSc's fieldsplit on a
   nested matrix, with the Schur matrix of schur.py.

All of PETSc's options for pc_fieldsplit apply, under their usual names; a scene without pressure
(or without displacement) has one block, which reads the options of that split alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.solve.eliminated import ContactRows, Ints, index_set, owned_numbers
from porolub.solve.modes import near_nullspace, rigid_motions
from porolub.solve.model import Model
from porolub.solve.schur import SchurMatrix
from porolub.solve.vertices import VertexSpace

Array = NDArray[np.float64]
SPLITS = ("u", "p")  # what the fieldsplit sees


class Condensed:
    """Context of a PC of type python for the matrix of a model.

    ``linearise`` is to be called with the state whenever the matrix is computed.
    """

    def __init__(self, model: Model) -> None:
        self.model, self.dofs, self.comm = model, model.dofs, model.mesh.comm
        fields = model.dofs.fields
        self.numbers = {name: owned_numbers(model, name) for name in fields}
        self.splits = [name for name in SPLITS if name in fields]
        self.contact = ContactRows(model) if "l" in fields else None
        self.schur = SchurMatrix(model) if "p" in fields else None
        self.vertices = VertexSpace(model) if "u" in fields else None
        self.motions = rigid_motions(model.system) if "u" in fields else None
        self.drags = "l" in fields and bool(model.scene.contact.friction_traction)
        self._made: list[Any] = []
        self._border: tuple[PETSc.Vec, PETSc.Vec, float] | None = None

    def linearise(self, x: PETSc.Vec) -> None:
        """Take note of the state the matrix belongs to. Collective."""
        if self.schur is not None and "u" in self.splits:
            self.schur.linearise(x)

    # -- set-up -----------------------------------------------------------------------------
    def setUp(self, pc: PETSc.PC) -> None:
        """Take the matrix apart. Collective."""
        self._free()
        matrix = pc.getOperators()[0]
        self._first = matrix.getOwnershipRange()[0]
        rows, sets = dict(self.numbers), {}
        if self.contact is not None:
            rows["u"] = self.contact.take_from(matrix, rows["u"])
        for name in {*self.splits, *({"j", "w"} & set(self.numbers))}:
            sets[name] = self._keep(index_set(self.numbers[name], matrix.comm))
        self.rows = rows
        blocks = self._blocks(matrix, sets)
        self._masses(matrix, sets)
        self._inner = self._split(blocks, sets)
        self._reduced = self._keep(blocks.createVecLeft())
        self._answer = self._keep(blocks.createVecRight())
        self._parts = {name: self._keep(matrix_vector) for name, matrix_vector in
                       self._part_vectors(blocks).items()}
        self._bordered(matrix)

    def _keep(self, thing: Any) -> Any:
        self._made.append(thing)
        return thing

    def _blocks(self, matrix: PETSc.Mat, sets: dict[str, PETSc.IS]) -> PETSc.Mat:
        """The nested matrix over u and p, contact eliminated."""
        stand = {name: self._keep(index_set(self.rows[name], matrix.comm)) for name in self.splits}
        block = {(r, c): self._keep(matrix.createSubMatrix(stand[r], sets[c]))
                 for r in self.splits for c in self.splits}
        if self.contact is not None:
            self.contact.couple(matrix, sets["u"], sets.get("p"))
            if self.drags:
                self.contact.drag(block["u", "u"], block.get(("u", "p")))
        if "u" in self.splits:
            K = block["u", "u"]
            if "w" in self.numbers:
                self._add_mass(matrix, K, stand["u"], sets["w"])
            K.setBlockSize(self.dofs.mesh.dim)
            self._hold_motions(K)
        nest = [[block[r, c] for c in self.splits] for r in self.splits]
        return self._keep(PETSc.Mat().createNest(nest, comm=matrix.comm))

    def _hold_motions(self, K: PETSc.Mat) -> None:
        assert self.motions is not None
        fixed = np.zeros(self.dofs.size_local, bool)
        fixed[self.model.system.constraints.fixed] = True
        where = self.dofs.range["u"]
        self.held = fixed[where][self.dofs.owned[where]]
        if self.contact is not None:
            self.held = self.held | (self.numbers["u"] != self.rows["u"])
        self._keep(near_nullspace(K, np.where(self.held, 0.0, self.motions)))

    def _add_mass(self, matrix: PETSc.Mat, K: PETSc.Mat, rows: PETSc.IS, w: PETSc.IS) -> None:
        """Inertia: w = rate u, so the forces of w act on u."""
        mass = matrix.createSubMatrix(rows, w)
        K.axpy(self.model.system.rate, mass, PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN)
        mass.destroy()

    def _masses(self, matrix: PETSc.Mat, sets: dict[str, PETSc.IS]) -> None:
        """Solvers of the mass matrices, and what couples their fields to u and p."""
        self.mass: dict[str, PETSc.KSP] = {}
        self.from_u: dict[str, PETSc.Mat] = {}
        self.into: dict[str, tuple[str, PETSc.Mat]] = {}
        for name, target in (("j", "p"), ("w", "u")):
            if name not in self.numbers:
                continue
            own = self._keep(matrix.createSubMatrix(sets[name], sets[name]))
            ksp = self._keep(PETSc.KSP().create(matrix.comm))
            ksp.setOptionsPrefix(f"fieldsplit_{name}_")
            ksp.setOperators(own)
            ksp.setFromOptions()
            self.mass[name] = ksp
            rows = index_set(self.rows[target], matrix.comm)
            self.from_u[name] = self._keep(matrix.createSubMatrix(sets[name], sets["u"]))
            self.into[name] = target, self._keep(matrix.createSubMatrix(rows, sets[name]))
            rows.destroy()

    def _split(self, blocks: PETSc.Mat, sets: dict[str, PETSc.IS]) -> PETSc.PC:
        """PETSc's own preconditioner of what is left, configured by options."""
        pc = self._keep(PETSc.PC().create(blocks.comm))
        if len(self.splits) == 1:
            name = self.splits[0]
            pc.setOperators(self._schur(blocks, sets) if name == "p" else
                            blocks.getNestSubMatrix(0, 0))
            pc.setOptionsPrefix(f"fieldsplit_{name}_")
        else:
            pc.setOperators(blocks)
            pc.setType(PETSc.PC.Type.FIELDSPLIT)
            places = blocks.getNestISs()[0]
            pc.setFieldSplitIS(*zip(self.splits, places, strict=True))
            pc.setFieldSplitType(PETSc.PC.CompositeType.SCHUR)
            pc.setFieldSplitSchurPreType(PETSc.PC.SchurPreType.USER, self._schur(blocks, sets))
        pc.setFromOptions()
        pc.setUp()
        of = {self.splits[0]: pc}
        if len(self.splits) > 1:
            of = {name: ksp.getPC() for name, ksp in
                  zip(self.splits, pc.getFieldSplitSubKSP(), strict=True)}
        if "u" in of and of["u"].getType() == PETSc.PC.Type.MG:
            self._two_levels(of["u"], blocks.getNestSubMatrix(0, 0))
        if "p" in of and of["p"].getType() == PETSc.PC.Type.FIELDSPLIT:
            self._layer_and_film(of["p"])
        return pc

    def _layer_and_film(self, pc: PETSc.PC) -> None:
        """Split the pressure into that of the film, on the surface, and the rest."""
        dofs, name = self.dofs, self.model.lubricated
        on = np.zeros(dofs.size_local, bool)
        if name is not None:
            nodes = self.model.mesh.boundary_nodes(name)
            base = dofs.base["p"][nodes]
            on[base[base >= 0]] = True
        where = dofs.range["p"]
        film = on[where][dofs.owned[where]]
        start = pc.getOperators()[1].getOwnershipRange()[0]
        places = start + np.arange(len(film), dtype=np.int32)
        for part, chosen in (("layer", ~film), ("film", film)):
            pc.setFieldSplitIS((part, self._keep(index_set(places[chosen], pc.comm))))
        pc.setFromOptions()
        pc.setUp()

    def _two_levels(self, pc: PETSc.PC, K: PETSc.Mat) -> None:
        """Multigrid from quadratic to linear displacements."""
        held = self.held
        P = self._keep(self.vertices.interpolation(held))
        coarse = self._keep(K.ptap(P))
        assert self.motions is not None
        coarse.setBlockSize(self.dofs.mesh.dim)
        motions = np.where(held, 0.0, self.motions)[:, self.vertices.rows_of_vertices]
        self._keep(near_nullspace(coarse, motions))
        pc.setMGLevels(2)
        pc.setMGInterpolation(1, P)
        pc.getMGSmoother(1).setOperators(K)
        pc.getMGCoarseSolve().setOperators(coarse)
        pc.setFromOptions()
        pc.setUp()

    def _schur(self, blocks: PETSc.Mat, sets: dict[str, PETSc.IS]) -> PETSc.Mat:
        assert self.schur is not None
        last = len(self.splits) - 1
        own = blocks.getNestSubMatrix(last, last)
        if last == 0:
            return own
        return self._keep(self.schur.of(own, sets["p"]))

    def _part_vectors(self, blocks: PETSc.Mat) -> dict[str, PETSc.Vec]:
        return {name: blocks.getNestSubMatrix(k, k).createVecRight()
                for k, name in enumerate(self.splits)}

    def _bordered(self, matrix: PETSc.Mat) -> None:
        """Solve for the column of the approach."""
        self._border = None
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
        part = {name: known[self.rows[name] - self._first].copy() for name in self.splits}
        if self.contact is not None:
            self.contact.forward(known, found, part["u"])
        for name, ksp in self.mass.items():
            mass = self._solve_mass(name, ksp, known[self._place(name)])
            target, block = self.into[name]
            force = block.createVecLeft()
            block.mult(mass, force)
            part[target] -= force.array_r
            force.destroy()
            mass.destroy()
        self._reduced.array[:] = np.concatenate([part[name] for name in self.splits])
        self._inner.apply(self._reduced, self._answer)
        start = 0
        for name in self.splits:
            size = len(self.numbers[name])
            self._parts[name].array[:] = self._answer.array_r[start:start + size]
            found[self._place(name)] = self._parts[name].array_r
            start += size
        if self.contact is not None:
            self.contact.backward(found, self._parts["u"], self._parts.get("p"))
        for name, ksp in self.mass.items():
            follows = self.from_u[name].createVecLeft()
            self.from_u[name].mult(self._parts["u"], follows)
            mass = self._solve_mass(name, ksp, known[self._place(name)] - follows.array_r)
            found[self._place(name)] = mass.array_r
            follows.destroy()
            mass.destroy()
        z.array[:] = found

    def _place(self, name: str) -> Ints:
        """Where this rank's unknowns of a field are in its part of a vector."""
        return self.numbers[name] - np.int32(self._first)

    @staticmethod
    def _solve_mass(name: str, ksp: PETSc.KSP, values: Array) -> PETSc.Vec:
        x, b = ksp.getOperators()[0].createVecs()
        b.array[:] = values
        ksp.solve(b, x)
        b.destroy()
        return x

    # -- end --------------------------------------------------------------------------------
    def _free(self) -> None:
        for thing in reversed(self._made):
            thing.destroy()
        self._made, self._border = [], None

    def destroy(self, pc: PETSc.PC | None = None) -> None:
        """Free all that PETSc holds."""
        self._free()
        if self.contact is not None:
            self.contact.destroy()
        if self.schur is not None:
            self.schur.destroy()
            self.schur = None
