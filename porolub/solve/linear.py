"""The linear solver of Newton's steps on one model: which preset, and what it is told."""

from __future__ import annotations

import atexit
from typing import Any
from weakref import WeakSet

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
        self._pc: PETSc.PC | None = None
        _in_use.add(self)

    def attach(self, ksp: PETSc.KSP) -> None:
        """To be called when the KSP has read its options."""
        if self.context is not None:
            self._pc = ksp.getPC()
            self._pc.setType(PETSc.PC.Type.PYTHON)
            self._pc.setPythonContext(self.context)

    def detach(self) -> None:
        """Take the preconditioner out of the KSP."""
        if self._pc is not None:
            self._pc.setType(PETSc.PC.Type.NONE)

    def linearise(self, x: PETSc.Vec) -> None:
        """The matrix has been computed anew at x. Collective."""
        if self.context is not None:
            self.context.linearise(x)

    def destroy(self) -> None:
        """Free what PETSc holds; the KSP may be gone already, or be kept by PETSc to the end."""
        self.detach()
        if self._pc is not None:
            self._pc.destroy()
            self._pc = None
        if self.context is not None:
            self.context.destroy()
            self.context = None


_in_use: WeakSet[Linear] = WeakSet()


@atexit.register
def _let_go() -> None:
    """PETSc is finalised after this: it must not call Python, which is going, to destroy."""
    for linear in list(_in_use):
        linear.detach()


def preset_of(scene: Any, unknowns: int) -> str:
    """The preset a scene asks for, on a mesh with so many unknowns."""
    return preset_used(scene.solver.preset, scene.dimension, unknowns)


def final_preset(scene: Any) -> str:
    """The preset on the scene's own mesh."""
    return preset_of(scene, estimate_unknowns(scene)["total"])
