"""Run by mpirun: start scenes from neighbours, save them from rank 0. Argument: the .npz to write.

Fields are saved scaled, in the natural order of the nodes, which no partition changes.
"""

import sys

import numpy as np
from mpi4py import MPI

from porolub.scene import scene_from_dict
from porolub.solve.gather import gather_state, units_of
from porolub.solve.neighbours import Neighbour, solution_of
from porolub.solve.steady import SteadySolver
from tests.scene.scenes import changed
from tests.solve.models import case1
from tests.terms.case1 import BARREL

COMM = MPI.COMM_WORLD
CASES = {
    "plane": [case1(40, 4, f"load.force={f} kN/m", "mesh.grading=contact") for f in (1, 2, 1.5)],
    "far": [case1(100, 5, f"load={{approach='{v} um'}}") for v in (-8, 180, 20)],
    "barrel": [
        scene_from_dict(changed(
            BARREL, mesh={"along": 14, "across": 1, "deep": 2}, load={"force": f"{f} N"},
            geometry={"crown_radius": "200 mm"}))
        for f in (12, 18, 15)
    ],
}


def main(path: str) -> None:
    found = {}
    for case, (low, high, here) in CASES.items():
        neighbours = []
        for scene in (low, high):
            outcome = SteadySolver(scene, COMM).solve()
            neighbours.append(Neighbour(solution_of(outcome.model, outcome.x), 0.5))
            outcome.destroy()
        solver = SteadySolver(here, COMM, neighbours=neighbours)
        outcome = solver.solve()
        assert solver.warm == (case != "far")  # through the coarse mesh, which one rank solves
        sizes = units_of(outcome.model)
        for name, (_, values) in gather_state(outcome.model, outcome.x).fields.items():
            scalar = outcome.model.dofs.fields[name].degree == 0
            whole = values if scalar else np.vstack(COMM.allgather(values))
            found[f"{case} {name}"] = whole / sizes[name][0]
        found[f"{case} edges"] = np.array(neighbours[0].solution.edges) * 1e3
        if solver.warm:
            found[f"{case} iterations"] = np.array(outcome.newton_iterations)
        outcome.destroy()
    if COMM.rank == 0:
        np.savez(path, **found)


main(*sys.argv[1:])
