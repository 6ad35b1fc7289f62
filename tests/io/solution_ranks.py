"""Run by mpirun: write a made-up state from this many ranks, read those there are, blend them.

Argument: a directory for files named after the number of ranks that wrote them.
"""

import sys
from pathlib import Path

import numpy as np
from mpi4py import MPI

from porolub.io.solution import read_solution, write_solution
from porolub.solve.neighbours import Neighbour, blended, solution_of
from tests.solve.models import case1, model_of, vector, waves

COMM = MPI.COMM_WORLD


def main(directory: Path) -> None:
    with model_of(case1(16, 3), COMM) as model:
        x = vector(model, waves(model.dofs), conditions=True)
        made = solution_of(model, x)
        write_solution(directory / f"{COMM.size}.h5", made, COMM)
        again = read_solution(directory / f"{COMM.size}.h5", COMM)
        for name, rows in made.data.rows.items():
            np.testing.assert_array_equal(again.data.rows[name], rows)
        for path in sorted(directory.glob("?.h5")):
            found = read_solution(path, COMM)
            assert found.data.shared == (COMM.size > 1)
            y = blended(model, [Neighbour(found, 1.0)])
            y.axpy(-1.0, x)
            assert max(model.dofs.field_norms(y, np.inf).values()) < 1e-13
    if COMM.rank == 0:
        print("all alike", flush=True)


main(Path(sys.argv[1]))
