"""Run by mpirun: gather one state on rank 0 and save it. Arguments: element, the .npz to write."""

import sys
from dataclasses import fields as names_of

import numpy as np
from mpi4py import MPI

from porolub.solve.gather import gather_fields, gather_state, gather_surface
from tests.solve.models import case1, model_of, vector, waves


def main(element: str, path: str) -> None:
    comm = MPI.COMM_WORLD
    with model_of(case1(14, 5, f"mesh.element={element}"), comm) as model:
        x = vector(model, waves(model.dofs))
        everything = {"fields": gather_fields(model, x), "surface": gather_surface(model, x)}
        state = gather_state(model, x)
    assert all((value is None) == (comm.rank > 0) for value in (*everything.values(), state))
    if state is None:
        return
    arrays = {f"{kind} {f.name}": getattr(value, f.name)
              for kind, value in everything.items() for f in names_of(value)}
    arrays = {name: a for name, a in arrays.items() if isinstance(a, np.ndarray)}
    for name, (nodes, values) in state.fields.items():
        arrays[f"state {name}"], arrays[f"nodes of {name}"] = values, nodes
    np.savez(path, **arrays)


main(*sys.argv[1:])
