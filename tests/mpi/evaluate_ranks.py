"""Run by mpirun: residual and Jacobian action of small systems, saved from rank 0.

The state is a function of the coordinates; values are saved in the natural order of the nodes,
which no partition changes. Argument: the .npz to write.
"""

import sys

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.fem.dofs import Dofs
from porolub.solve.model import Model
from tests.scene.scenes import changed
from tests.terms.case1 import BARREL, BONDED, CASE1, CUBOID, model, restrained
from tests.terms.support import smooth, vector

Array = NDArray[np.float64]

SCENES = {
    "case 1": CASE1,
    "bonded triangles": changed(BONDED, mesh={"element": "triangle"}),
    "open surface": changed(CASE1, film=None),
    "impermeable": changed(CASE1, pores=None),
    "barrel": BARREL,
    "block": CUBOID,
    "fewer cells than ranks": changed(CASE1, mesh={"along": 2, "across": 1}),
}


def assert_numbered_once(dofs: Dofs) -> None:
    """Each global dof has one owner, and the fields' index sets cover them all."""
    comm = dofs.mesh.comm
    everyone = np.arange(dofs.size)
    owned = np.concatenate(comm.allgather(dofs.global_numbers[dofs.owned]))
    np.testing.assert_array_equal(np.sort(owned), everyone)
    sets = [dofs.index_set(name) for name in dofs.fields]
    covered = np.concatenate([np.concatenate(comm.allgather(s.indices)) for s in sets])
    np.testing.assert_array_equal(np.sort(covered), everyone)
    for s in sets:
        s.destroy()


def by_field(of: Model, v: PETSc.Vec) -> dict[str, Array]:
    """Cartesian values of a global vector on rank 0, nodes in natural order."""
    dofs, mesh = of.dofs, of.mesh
    local = of.system.physical(dofs.to_local(v))
    found = {}
    for name, f in dofs.fields.items():
        if f.degree == 0:
            found[name] = np.array([dofs.scalar_value(name, v)])
            continue
        nodes = dofs.nodes[name]
        mine = mesh.owned[nodes]
        numbers = mesh.comm.gather(mesh.natural_node[nodes[mine]])
        values = mesh.comm.gather(dofs.field(name, local)[mine])
        if mesh.comm.rank == 0:
            order = np.argsort(np.concatenate(numbers))
            found[name] = np.concatenate(values)[order]
    return found


def evaluate(tables: dict, comm: MPI.Intracomm) -> dict[str, Array]:
    of = model(tables, comm)
    dofs, system = of.dofs, of.system
    assert_numbered_once(dofs)
    state = restrained(of, smooth(dofs))
    system.backward_euler(system.physical(restrained(of, smooth(dofs, 0.03, 0.05))), 1 / 5.0)
    change = system.stored(smooth(dofs, 0.2, 0.3))
    change[system.constraints.fixed] = 0.0
    x, d, y = vector(dofs, state), vector(dofs, change), dofs.vector()
    # ghosts hold what their owner has: frames and essential values are the same on all ranks
    np.testing.assert_allclose(dofs.to_local(x), state, rtol=0, atol=1e-13)
    system.residual(x, y)
    found = {f"residual of {k}": v for k, v in by_field(of, y).items()}
    found["norm"] = np.array([y.norm()])
    found["lowest J"] = np.array([system.lowest_jacobian])
    matrix = system.create_matrix()
    system.jacobian(x, matrix)
    matrix.mult(d, y)
    found |= {f"J d of {k}": v for k, v in by_field(of, y).items()}
    found["norm of J d"] = np.array([y.norm()])
    matrix.multTranspose(d, y)
    found |= {f"J^T d of {k}": v for k, v in by_field(of, y).items()}
    for o in (x, d, y, matrix):
        o.destroy()
    of.destroy()
    return found


def all_scenes(comm: MPI.Intracomm) -> dict[str, Array]:
    found = {}
    for name, tables in SCENES.items():
        found |= {f"{name}: {key}": v for key, v in evaluate(tables, comm).items()}
    return found


if __name__ == "__main__":
    result = all_scenes(MPI.COMM_WORLD)
    if MPI.COMM_WORLD.rank == 0:
        np.savez(sys.argv[1], **result)
