"""Case 1 on a small mesh and its relatives, as scenes turned into systems, with a state to try."""

from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.mesh import build_mesh
from porolub.scene import scene_from_dict
from porolub.solve.model import Model, build_model, scales_of
from tests.scene.scenes import ROLLING, changed
from tests.terms.support import smooth
from tests.terms.taylor import keep_off_kinks

Array = NDArray[np.float64]

CASE1 = changed(ROLLING, mesh={"along": 12, "across": 3})
BARREL = changed(
    CASE1,
    scene={"dimension": 3},
    geometry={"shape": "barrel", "width": "10 mm", "crown_radius": "40 mm"},
    mesh={"along": 6, "across": 2, "deep": 2},
    load={"force": "15 N"},
)
CUBOID = changed(
    CASE1,
    scene={"dimension": 3},
    geometry={"shape": "block", "width": "4 mm", "depth": "3 mm", "outer_radius": None,
              "half_angle": None},
    mesh={"along": 4, "across": 2, "deep": 3},
    pores={"carry": None},
    motion={"kind": "sliding", "speed": "0.1 m/s"},
    load={"force": "15 N"},
)
BONDED = changed(CASE1, solid={"base": "bonded"}, contact={"friction_traction": True})


def model(tables: dict[str, Any], comm: MPI.Intracomm = MPI.COMM_SELF) -> Model:
    """The scene on its own mesh, ready to be evaluated."""
    scene = scene_from_dict(tables)
    scales = scales_of(scene, scene.geometry.thickness)
    return build_model(scene, build_mesh(scene, comm, length_scale=scales.length), scales)


def restrained(of: Model, physical: Array) -> Array:
    """The stored form of a physical local state, with its essential values set."""
    stored = of.system.stored(physical)
    stored[of.system.constraints.fixed] = of.system.constraints.values
    return stored


def trial_state(of: Model) -> Array:
    """A stored local state that meets the conditions: part of the surface closed, part open."""
    stored = restrained(of, smooth(of.dofs))
    if of.plane is None or of.lubricated is None:
        return stored
    physical = of.system.physical(stored)
    return of.system.stored(keep_off_kinks(of.system, of.plane, of.lubricated, physical))
