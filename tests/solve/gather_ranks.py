"""Run by mpirun: gather a state on meshes of some elements, save it from rank 0.

Arguments: the directory to write, elements. Each element becomes an .npz.
"""

import sys
from dataclasses import fields as names_of

import numpy as np
from mpi4py import MPI

from porolub.scene import scene_from_dict
from porolub.solve.gather import gather_fields, gather_state, gather_surface
from tests.solve.models import case1, model_of, vector, waves
from tests.terms.case1 import BARREL


def main(directory: str, *elements: str) -> None:
    for element in elements:
        save(element, f"{directory}/{element}.npz", MPI.COMM_WORLD)


def save(element: str, path: str, comm: MPI.Intracomm) -> None:
    flat = element != "hex"
    scene = case1(14, 5, f"mesh.element={element}") if flat else scene_from_dict(BARREL)
    with model_of(scene, comm) as model:
        x = vector(model, waves(model.dofs))
        fields, surface = gather_fields(model, x), gather_surface(model, x)
        state = gather_state(model, x)
        nodes = comm.allgather(len(fields.nodes))
        assert max(nodes) - min(nodes) <= 1
        assert len(fields.cells) < model.mesh.global_cell_count / comm.size + 1
    assert (surface is None) == (comm.rank > 0)
    arrays = {f"fields {f.name}": getattr(fields, f.name) for f in names_of(fields)}
    arrays = {name: a for name, a in arrays.items() if isinstance(a, np.ndarray)}
    arrays["mesh nodes of the state"] = state.mesh_nodes
    for name, (numbers, values) in state.fields.items():
        arrays[f"nodes of {name}"] = numbers
        if name != "v0":
            arrays[f"state {name}"] = values
    blocks = {name: comm.gather(a) for name, a in arrays.items()}
    scalar = comm.allgather(state.fields["v0"][1].item())
    assert len(set(scalar)) == 1
    if comm.rank == 0:
        whole = {name: np.concatenate(parts) for name, parts in blocks.items()}
        columns = {f"surface {f.name}": getattr(surface, f.name) for f in names_of(surface)}
        whole |= {name: a for name, a in columns.items() if isinstance(a, np.ndarray)}
        np.savez(path, **whole, v0=scalar[0])


main(*sys.argv[1:])
