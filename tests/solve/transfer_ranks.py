"""Run by mpirun: carry states to other meshes, save them from rank 0. Argument: the .npz to write.

Fields are saved in the natural order of the nodes, which no partition changes.
"""

import sys

import numpy as np
from mpi4py import MPI

from porolub.scene.read import scene_from_dict
from porolub.solve.gather import gather_state
from porolub.solve.transfer import restore, snapshot
from tests.scene.scenes import changed
from tests.solve.models import case1, model_of, vector, waves
from tests.terms.case1 import BARREL

CASES = {
    "plane": (case1(10, 4), {"along": 24, "across": 7, "edges": (-4.0, 4.5), "edge_size": 0.4}),
    "barrel": (
        scene_from_dict(changed(BARREL, mesh={"along": 5, "across": 2, "deep": 3})),
        {"along": 7, "across": 3},
    ),
}


def main(path: str) -> None:
    comm = MPI.COMM_WORLD
    found = {}
    for case, (scene, finer) in CASES.items():
        with model_of(scene, comm) as coarse, model_of(scene, comm, **finer) as fine:
            data = snapshot(coarse, vector(coarse, waves(coarse.dofs)))
            assert data.shared == (comm.size > 1)
            counts = {name: comm.allreduce(len(rows)) for name, rows in data.rows.items()}
            assert counts == {n: k // coarse.dofs.fields[n].components
                              for n, k in coarse.dofs.counts().items() if n in counts}
            told = {"shared": data}
            if comm.rank == 0:  # a coarse mesh that rank 0 solves alone
                with model_of(scene) as alone:
                    told["alone"] = snapshot(alone, vector(alone, waves(alone.dofs)))
            outline = comm.bcast(told["alone"].outline() if comm.rank == 0 else None)
            told.setdefault("alone", outline)
            for way, what in told.items():
                state = gather_state(fine, restore(fine, what))
                for name, (numbers, values) in state.fields.items():
                    numbers = np.concatenate(comm.allgather(numbers))
                    whole = np.vstack(comm.allgather(values))
                    assert (np.diff(numbers) > 0).all()
                    found[f"{case} {way} {name}"] = whole if len(numbers) else values
    if comm.rank == 0:
        np.savez(path, **found)


main(*sys.argv[1:])
