"""Run by mpirun: build meshes, check what the ranks must agree on, save them from rank 0.

Arguments: the directory to write, then mesh files, .msh. Each mesh becomes an .npz there, named as
the case or the file. On one rank it gives the serial reference.
"""

import sys
from pathlib import Path

import numpy as np
from mpi4py import MPI

from porolub.mesh import Mesh, build_mesh
from tests.mesh.scenes import scene


def main(directory: str, *files: str) -> None:
    cases = {
        "sector": scene("sector"),
        "triangle": scene("sector", element="triangle"),
        "barrel": scene("barrel", 3, crown_radius=0.2),
    }
    for path in map(Path, files):
        dimension = 3 if path.stem.startswith("body") else 2
        cases[path.stem] = scene("file", dimension, path=str(path))
    for name, case in cases.items():
        save(build_mesh(case, MPI.COMM_WORLD, length_scale=1e-3), f"{directory}/{name}.npz")


def save(mesh: Mesh, output: str) -> None:
    comm = mesh.comm
    owned = mesh.global_node[mesh.owned]
    everything = {
        "owned": comm.gather(owned),
        "global": comm.gather(mesh.global_node),
        "natural": comm.gather(mesh.natural_node),
        "x": comm.gather(mesh.coordinates),
        "cell": comm.gather(mesh.natural_cell),
        "cells": comm.gather(mesh.natural_node[mesh.cells]),
    }
    for name in mesh.boundary_names:
        facets = mesh.facets(name)
        everything["facets " + name] = comm.gather(
            np.column_stack([mesh.natural_cell[facets.cells], facets.local_face])
        )
        nodes = mesh.boundary_nodes(name)
        everything["nodes " + name] = comm.gather(mesh.natural_node[nodes])
    assert (np.diff(owned) == 1).all(), "owned nodes are not contiguous"
    if comm.rank == 0:
        # each boundary node of a rank is listed on that rank, by the whole boundary's facets
        marks = {k[6:]: set(np.concatenate(v)) for k, v in everything.items() if k[:6] == "nodes "}
        for name, whole in marks.items():
            for natural, listed in zip(
                everything["natural"], everything["nodes " + name], strict=True
            ):
                assert set(natural) & whole == set(listed), f"{name} incomplete"
        np.savez(output, **{key: np.concatenate(value) for key, value in everything.items()})


main(*sys.argv[1:])
