"""Run by mpirun: build meshes, print how unevenly cells and lubricated facets lie on the ranks.

Arguments: mesh files. Each line: name, cells and facets of the fullest rank over the mean.
"""

import sys

import numpy as np
from mpi4py import MPI

from porolub.mesh import Mesh, build_mesh
from tests.mesh.scenes import scene


def excess(mesh: Mesh, count: int) -> float:
    counts = np.array(mesh.comm.allgather(count))
    return float(counts.max() / counts.mean())


def main(paths: list[str]) -> None:
    comm = MPI.COMM_WORLD
    built = scene("barrel", 3)
    meshes = {"barrel": build_mesh(built, comm, along=48, across=3)}
    meshes |= {path: build_mesh(scene("file", 3, path=path), comm) for path in paths}
    for name, mesh in meshes.items():
        cells = excess(mesh, len(mesh.cells))
        facets = excess(mesh, len(mesh.facets("lubricated").cells))
        if comm.rank == 0:
            print(f"balance {name} {cells:.4f} {facets:.4f}", flush=True)


main(sys.argv[1:])
