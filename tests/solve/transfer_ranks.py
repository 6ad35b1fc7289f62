"""Run by mpirun: carry a state to another mesh, save it from rank 0. Argument: the .npz to write.

Fields are saved in the natural order of the nodes, which no partition changes.
"""

import sys

import numpy as np
from mpi4py import MPI

from porolub.solve.gather import gather_state
from porolub.solve.transfer import restore, snapshot
from tests.solve.models import case1, model_of, vector, waves


def main(path: str) -> None:
    comm, scene = MPI.COMM_WORLD, case1(10, 4)
    graded = {"along": 24, "across": 7, "edges": (-4.0, 4.5), "edge_size": 0.4}
    with model_of(scene, comm) as coarse, model_of(scene, comm, **graded) as fine:
        x = vector(coarse, waves(coarse.dofs))
        state = gather_state(fine, restore(fine, snapshot(coarse, x)))
    if state is not None:
        np.savez(path, **{name: values for name, (_, values) in state.fields.items()})


main(*sys.argv[1:])
