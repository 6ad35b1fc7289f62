"""Run by mpirun: where the body of a mesh file turns and what it passes.

Arguments: the mesh, axes. Prints a line for each axis.
"""

import sys

from mpi4py import MPI

from porolub.mesh import build_mesh
from porolub.scene import scene_from_dict
from porolub.solve.drive import operation_of
from porolub.solve.model import scales_of
from porolub.solve.moving import passing
from porolub.solve.surface import surface_circle


def main(path: str, axis: str) -> None:
    comm = MPI.COMM_WORLD
    scene = scene_from_dict({
        "scene": {"dimension": 3}, "geometry": {"shape": "file", "path": path},
        "film": {"viscosity": "1 mPa*s"}, "load": {"approach": "0 m"},
        "motion": {"kind": "rotation", "speed": "1 rad/s", "axis": axis},
    })
    mesh = build_mesh(scene, comm, length_scale=1e-3)
    circle = surface_circle(scene, mesh, "lubricated", 1e-3)
    assert circle is not None
    operation = operation_of(scene, scales_of(scene, 1e-3), circle)
    share = passing(mesh, operation, mesh.boundary_names)
    found = (*operation.centre, circle.radius, *share.values())
    assert len(set(comm.allgather(found))) == 1
    if comm.rank == 0:
        print("FOUND", *map(repr, found))


for axis in sys.argv[2:]:
    main(sys.argv[1], axis)
