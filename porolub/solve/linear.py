"""The linear solver of Newton's steps on one model: which preset, and what it is told."""

from __future__ import annotations

from petsc4py import PETSc

from porolub.scene.cost import preset_used
from porolub.scene.unknowns import estimate_unknowns
from porolub.solve.condensed import Condensed
from porolub.solve.model import Model
from porolub.solve.options import option, use


class Linear:
    """Brings the preset of a model into force and hangs its preconditioner into a KSP.

    From the moment it is made its options are those of the process; one is in use at a time.
    """

    def __init__(self, model: Model, preset: str = "") -> None:
        """``preset``: in place of the scene's."""
        self.preset = preset or preset_of(model.scene, model.dofs.size)
        use(self.preset)
        self.context = Condensed(model) if option("pc_type") == "fieldsplit" else None

    def attach(self, ksp: PETSc.KSP) -> None:
        """To be called when the KSP has read its options."""
        if self.context is not None:
            pc = ksp.getPC()
            pc.setType(PETSc.PC.Type.PYTHON)
            pc.setPythonContext(self.context)

    def linearise(self, x: PETSc.Vec) -> None:
        """The matrix has been computed anew at x. Collective."""
        if self.context is not None:
            self.context.linearise(x)

    def destroy(self) -> None:
        if self.context is not None:
            self.context.destroy()


def preset_of(scene: object, unknowns: int) -> str:
    """The preset a scene asks for, on a mesh with so many unknowns."""
    return preset_used(scene.solver.preset, scene.dimension, unknowns)  # type: ignore[attr-defined]


def final_preset(scene: object) -> str:
    """The preset on the scene's own mesh."""
    return preset_of(scene, estimate_unknowns(scene)["total"])  # type: ignore[arg-type]
