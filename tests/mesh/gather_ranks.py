"""Run by mpirun: build a mesh, check what each rank must agree on, save it from rank 0.

Arguments: case name, mesh file, output .npz. Run alone it gives the serial reference.
"""

import sys

import numpy as np
from mpi4py import MPI

from porolub.mesh import build_mesh
from tests.mesh.scenes import scene


def main(case: str, path: str, output: str) -> None:
    cases = {
        "sector": lambda: scene("sector"),
        "triangle": lambda: scene("sector", element="triangle"),
        "barrel": lambda: scene("barrel", 3, crown_radius=0.2),
        "file": lambda: scene("file", path=path),
        "body": lambda: scene("file", 3, path=path),
    }
    comm = MPI.COMM_WORLD
    mesh = build_mesh(cases[case](), comm, length_scale=1e-3)
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
