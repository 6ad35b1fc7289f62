"""The numbers of a scene on meshes coarser than its own: what the estimate of its errors compares.

Each coarser mesh leaves out every other line of vertices of the one before, so that it differs by
nothing but its elements' size, and Newton starts on it from the solution there is: some steps on a
quarter (3D: an eighth) of the cells.  Where it fails there is no number.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

from mpi4py import MPI
from petsc4py import PETSc

from porolub.mesh import Mesh, coarsened
from porolub.solve.derived import scalars
from porolub.solve.estimate import MESHES, Numbers
from porolub.solve.levels import ALONE
from porolub.solve.linear import Linear
from porolub.solve.model import Model, build_model
from porolub.solve.newton import Clock, Newton
from porolub.solve.startup import Starter
from porolub.solve.transfer import Snapshot, restore, snapshot

ITERATIONS = 40  # of Newton, at most


def with_coarser(model: Model, x: PETSc.Vec, known: Sequence[Numbers], clock: Clock,
                 stop: Callable[[Any], str] = lambda comm: "") -> list[Numbers]:
    """The numbers of a solution x and of coarser meshes, coarsest first. Collective.

    ``known``: x's own and, each on a mesh of half the elements of the one before, others that
    have been found already.  There are MESHES or more, fewer where Newton fails or a mesh is too
    coarse to be halved or from a file.  ``clock``: gets the time it takes; ``stop``: as for Newton.
    """
    found = list(known)
    if model.mesh.shape is None or len(found) >= MESHES:
        return found[::-1]
    data = snapshot(model, x)
    for times in range(len(found), MESHES):
        numbers = _numbers(model, times, data, clock, stop)
        if not numbers:
            break
        found.append(numbers)
    return found[::-1]


def _numbers(model: Model, times: int, data: Snapshot, clock: Clock,
             stop: Callable[[Any], str]) -> Numbers:
    """Those of the model's scene on its mesh coarsened so many times; none where that or Newton
    fails. Collective."""
    mesh = model.mesh
    comm, cells = mesh.comm, mesh.global_cell_count // 2 ** (mesh.dim * times)
    if comm.size == 1 or cells >= ALONE[mesh.dim]:
        return _solved(model, coarsened(mesh, times, comm), data, clock, stop)
    data = data.gathered(comm)
    told: Numbers | Exception = {}
    if comm.rank == 0:  # as in the mesh sequence: too small to share
        try:
            told = _solved(model, coarsened(mesh, times, MPI.COMM_SELF), data, clock, stop)
        except Exception as error:  # raised by all ranks together
            told = error
    told = comm.bcast(told)
    if isinstance(told, Exception):
        raise told
    return told


def _solved(model: Model, mesh: Mesh | None, data: Snapshot, clock: Clock,
            stop: Callable[[Any], str]) -> Numbers:
    """Numbers on a mesh, by Newton from the solution on a finer one; none where it fails."""
    if mesh is None:
        return {}
    start = time.perf_counter()
    coarse = build_model(model.scene, mesh, model.scales)
    clock.add("setup", start)
    newton = Newton(coarse.system, clock, stop=stop, linear=Linear(coarse))
    starter = Starter(coarse, newton)
    x = restore(coarse, data)
    found = starter.straight(x, "error estimate", ITERATIONS)
    numbers = scalars(coarse, x) if found.converged else {}
    newton.destroy()
    x.destroy()
    coarse.destroy()
    return numbers
