"""Scenes on meshes, without the mesh sequence: the parts of the solver one by one."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.fem.dofs import Dofs
from porolub.mesh import build_mesh
from porolub.scene import Scene, load_scene, scene_from_dict
from porolub.solve.model import Model, build_model, scales_of
from porolub.solve.newton import Clock, Newton
from porolub.solve.options import set_options
from porolub.solve.report import NewtonRecord

Array = NDArray[np.float64]
JOBS = Path(__file__).resolve().parents[2] / "jobs"

BLOCK: dict[str, Any] = {
    "geometry": {"shape": "block", "width": "4 mm", "thickness": "1 mm"},
    "mesh": {"along": 4, "across": 3},
    "solid": {"law": "neo-hookean", "shear_modulus": "0.5 MPa", "bulk_modulus": "2 MPa"},
}
PORES: dict[str, Any] = {
    "biot": 0.9, "permeability": "1 um^3/mm", "viscosity": "1 mPa*s", "carry": False,
}


def case1(along: int, across: int, *overrides: str, job: str = "case1") -> Scene:
    """A shipped scene on a small uniform mesh."""
    return load_scene(JOBS / f"{job}.toml",
                      [f"mesh.along={along}", f"mesh.across={across}", *overrides])


def block(**sections: Any) -> Scene:
    """A 4 x 1 mm block of 4 x 3 elements, its sides and bottom on rollers unless overridden."""
    return scene_from_dict(BLOCK | sections)


@contextmanager
def model_of(scene: Scene, comm: MPI.Intracomm = MPI.COMM_SELF, **mesh: Any) -> Iterator[Model]:
    """The scene's model on its own mesh, in units of the layer's thickness."""
    scales = scales_of(scene, scene.geometry.thickness)
    built = build_mesh(scene, comm, length_scale=scales.length, **mesh)
    model = build_model(scene, built, scales)
    try:
        yield model
    finally:
        model.destroy()


class Watched:
    """Newton on a model, with the records of its iterations."""

    def __init__(self, model: Model) -> None:
        self.records: list[NewtonRecord] = []
        set_options("")
        self.newton = Newton(model.system, Clock(), self.records.append)

    def largest_updates(self) -> list[float]:
        """Of each iteration, the largest update of any field before it was shortened."""
        return [max(r.updates.values()) for r in self.records]


@contextmanager
def newton_on(model: Model) -> Iterator[tuple[Watched, PETSc.Vec]]:
    """Newton and a zero vector to start it from."""
    watched, x = Watched(model), model.dofs.vector()
    try:
        yield watched, x
    finally:
        x.destroy()
        watched.newton.destroy()


def waves(dofs: Dofs, size: float = 0.05) -> Array:
    """A local, physical state: every field a smooth function of the coordinates, of its own.

    Scalars are set to ``size``. The same on every mesh and on any number of ranks.
    """
    local = np.zeros(dofs.size_local)
    for k, (name, f) in enumerate(dofs.fields.items()):
        if f.degree == 0:
            local[dofs.range[name]] = size
            continue
        X = dofs.mesh.coordinates[dofs.nodes[name]]
        for c in range(f.components):
            phase = X @ np.array([0.6 + 0.2 * k, 1.1 - 0.3 * c, 0.8])[: X.shape[1]]
            dofs.field(name, local)[:, c] = size * (1.0 + np.sin(phase + k + 2.0 * c))
    return local


def vector(model: Model, physical: Array, conditions: bool = False) -> PETSc.Vec:
    """Global vector of a local, physical state; with the essential conditions if asked for."""
    x = model.dofs.vector()
    x.array[:] = model.system.stored(physical)[model.dofs.owned]
    if conditions:
        model.system.apply_conditions(x)
    return x


def physical(model: Model, x: PETSc.Vec) -> Array:
    """Local state of a global vector, displacements along the axes."""
    return model.system.physical(model.dofs.to_local(x))
