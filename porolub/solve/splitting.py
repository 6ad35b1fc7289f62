"""PETSc's own preconditioner of displacement and pressure, configured by options.

What options alone cannot say is handed over here: the splits' index sets, the Schur matrix, the
interpolation between the levels of the displacement's multigrid, and which pressures are the
film's.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.solve.eliminated import index_set
from porolub.solve.model import Model
from porolub.solve.modes import near_nullspace, rigid_motions
from porolub.solve.schur import SchurMatrix
from porolub.solve.vertices import VertexSpace

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


class Displacements:
    """What the multigrid of the displacement block knows of the model."""

    def __init__(self, model: Model) -> None:
        self.dim, self.degree = model.mesh.dim, model.mesh.degree
        self._space = VertexSpace(model)
        self._motions = rigid_motions(model.system)
        fixed = np.zeros(model.dofs.size_local, bool)
        fixed[model.system.constraints.fixed] = True
        self._fixed = model.dofs.owned_part("u", fixed)
        self._held = self._fixed

    def prepare(self, K: PETSc.Mat, held: Mask) -> list[Any]:
        """Tell the matrix of blocks and rigid motions; ``held`` displacements are given, besides
        the scene's. Returns what is to be destroyed."""
        self._held = self._fixed | held
        K.setBlockSize(self.dim)
        return [near_nullspace(K, np.where(self._held, 0.0, self._motions))]

    def levels(self, pc: PETSc.PC, K: PETSc.Mat) -> list[Any]:
        """Set up a PC of type mg: quadratic, then linear displacements. Collective."""
        if self.degree == 1:
            pc.setMGLevels(1)
            pc.getMGCoarseSolve().setOperators(K)
            pc.setFromOptions()
            return []
        P = self._space.interpolation(self._held)
        coarse = K.ptap(P)
        coarse.setBlockSize(self.dim)
        motions = np.where(self._held, 0.0, self._motions)
        space = near_nullspace(coarse, motions[:, : self._space.count])
        pc.setMGLevels(2)
        pc.setMGInterpolation(1, P)
        pc.getMGSmoother(1).setOperators(K)
        pc.getMGCoarseSolve().setOperators(coarse)
        pc.setFromOptions()
        return [P, coarse, space]


class Splitting:
    """The preconditioner of a nested matrix over the fields ``splits`` of a model."""

    def __init__(self, model: Model, splits: list[str]) -> None:
        self.splits = splits
        self.schur = SchurMatrix(model) if len(splits) > 1 else None
        self.displacements = Displacements(model) if "u" in splits else None
        self._film = self._film_pressures(model) if "p" in splits else np.zeros(0, bool)
        self._pressures = model.dofs.owned_numbers("p") if "p" in splits else None
        self._made: list[Any] = []

    @staticmethod
    def _film_pressures(model: Model) -> Mask:
        """Which of this rank's pressures lie on the lubricated surface."""
        dofs = model.dofs
        on = np.zeros(dofs.size_local, bool)
        if model.lubricated is not None:
            base = dofs.base["p"][model.mesh.boundary_nodes(model.lubricated)]
            on[base[base >= 0]] = True
        return dofs.owned_part("p", on)

    def set_up(self, blocks: PETSc.Mat, held: Mask) -> PETSc.PC:
        """Factors, hierarchies and all; ``held`` displacements are given, besides the scene's.
        Collective."""
        self.free()
        if self.displacements is not None:
            K = blocks.getNestSubMatrix(0, 0)
            self._made += self.displacements.prepare(K, held)
        pc = PETSc.PC().create(blocks.comm)
        self._made.append(pc)
        if len(self.splits) == 1:
            pc.setOptionsPrefix(f"fieldsplit_{self.splits[0]}_")
            pc.setOperators(blocks.getNestSubMatrix(0, 0))
            pc.setFromOptions()
            self._complete(self.splits[0], pc, blocks.getNestSubMatrix(0, 0))
            pc.setUp()
            return pc
        pc.setOperators(blocks)
        pc.setType(PETSc.PC.Type.FIELDSPLIT)
        pc.setFieldSplitIS(*zip(self.splits, blocks.getNestISs()[0], strict=True))
        pc.setFieldSplitType(PETSc.PC.CompositeType.SCHUR)
        pc.setFieldSplitSchurPreType(PETSc.PC.SchurPreType.USER, self._schur(blocks))
        pc.setFromOptions()
        pc.setUp()
        for k, (name, ksp) in enumerate(zip(self.splits, pc.getFieldSplitSubKSP(), strict=True)):
            self._complete(name, ksp.getPC(), blocks.getNestSubMatrix(k, k))
        return pc

    def _schur(self, blocks: PETSc.Mat) -> PETSc.Mat:
        assert self.schur is not None
        assert self._pressures is not None
        rows = index_set(self._pressures, blocks.comm)
        matrix = self.schur.of(blocks.getNestSubMatrix(1, 1), rows)
        rows.destroy()
        self._made.append(matrix)
        return matrix

    def _complete(self, name: str, pc: PETSc.PC, block: PETSc.Mat) -> None:
        """Give a split's preconditioner what its options ask for."""
        kind = pc.getType()
        if name == "u" and kind == PETSc.PC.Type.MG:
            assert self.displacements is not None
            self._made += self.displacements.levels(pc, block)
        elif name == "p" and kind == PETSc.PC.Type.FIELDSPLIT:
            start = block.getOwnershipRange()[0]
            places = start + np.arange(len(self._film), dtype=np.int32)
            for part, chosen in (("layer", ~self._film), ("film", self._film)):
                numbers = index_set(places[chosen], pc.comm)
                self._made.append(numbers)
                if numbers.getSize():  # without a film, or without pores, there is one of them
                    pc.setFieldSplitIS((part, numbers))
            pc.setFromOptions()

    def free(self) -> None:
        """Destroy what the last set-up made."""
        for thing in reversed(self._made):
            thing.destroy()
        self._made = []

    def destroy(self) -> None:
        """Free all that PETSc holds."""
        self.free()
        if self.schur is not None:
            self.schur.destroy()
