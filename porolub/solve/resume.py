"""From the states a stepper looks back on to plain data for a checkpoint, and back.

The data does not depend on the partition: values are in natural order, in SI.
"""

from __future__ import annotations

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.solve.gather import gather_state, units_of
from porolub.solve.lookback import Entry
from porolub.solve.model import Model
from porolub.solve.natural import from_blocks, to_blocks
from porolub.solve.report import StateData

Array = NDArray[np.float64]
SAME_PLACE = 1e-9  # of the layer's thickness: nodes nearer than this are the same


class Gathered:
    """Entries as plain data, each rank its block; each is gathered once. Collective."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._known: dict[float, StateData] = {}

    def states(self, entries: list[Entry]) -> tuple[StateData, ...]:
        """The entries, in the same order."""
        self._known = {e.time: self._known[e.time] if e.time in self._known else self._gather(e)
                       for e in entries}
        return tuple(self._known[e.time] for e in entries)

    def _gather(self, entry: Entry) -> StateData:
        x = self.model.dofs.vector()
        x.array[:] = entry.x
        state = gather_state(self.model, x, entry.time * self.model.scales.time)
        x.destroy()
        return state


def owned_values(model: Model, state: StateData) -> Array:
    """The owned part of the solution vector that a state holds. Collective.

    Raises SceneError where the state belongs to another mesh or to other unknowns.
    """
    mesh, dofs, comm = model.mesh, model.dofs, model.mesh.comm
    count = mesh.global_node_count
    _refuse_other_mesh(model, state)
    local = np.zeros(dofs.size_local)
    scalars = {}
    for name, f in dofs.fields.items():
        numbers, values = state.fields[name]
        scaled = values / units_of(model)[name][0]
        if f.degree == 0:
            scalars[name] = float(scaled[0, 0])
            continue
        block = to_blocks(comm, numbers, scaled, count)
        wanted = mesh.natural_node[dofs.nodes[name]]
        dofs.field(name, local)[...] = from_blocks(comm, block, count, wanted)
    local = model.system.stored(local)
    x = dofs.vector()
    x.array[:] = local[dofs.owned]
    for name, value in scalars.items():
        dofs.set_scalar(name, x, value)
    owned = x.array.copy()
    x.destroy()
    return owned


def _refuse_other_mesh(model: Model, state: StateData) -> None:
    mesh, comm = model.mesh, model.mesh.comm
    count = mesh.global_node_count
    same = set(state.fields) == set(model.dofs.fields)
    same = same and comm.allreduce(len(state.mesh_nodes)) == count  # both alike on all ranks
    if same:
        places = from_blocks(comm, state.mesh_nodes, count, mesh.natural_node)
        apart = np.abs(places / model.scales.length - mesh.coordinates).max(initial=0.0)
        same = comm.allreduce(bool(apart < SAME_PLACE), op=MPI.LAND)
    if not same:
        raise SceneError("The checkpoint belongs to another mesh or to other effects than the "
                         "scene's; run the scene anew.")
