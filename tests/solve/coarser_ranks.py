"""Prints the estimated error of the approach: coarser meshes left to one rank, and shared."""

from mpi4py import MPI

import porolub.solve.coarser as coarser
from porolub.solve.options import set_options
from porolub.solve.steady import SteadySolver
from tests.solve.models import case1

set_options("")
for alone in (coarser.ALONE, {2: 0}):
    coarser.ALONE = alone
    outcome = SteadySolver(case1(48, 6), MPI.COMM_WORLD).solve()
    if MPI.COMM_WORLD.rank == 0:
        print(outcome.errors["approach"])
    outcome.destroy()
