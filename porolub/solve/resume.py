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
from porolub.solve.report import StateData

Array = NDArray[np.float64]
SAME_PLACE = 1e-9  # of the layer's thickness: nodes nearer than this are the same


class Gathered:
    """Entries as plain data; each is gathered once. Collective."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._known: dict[float, StateData | None] = {}

    def states(self, entries: list[Entry]) -> tuple[StateData, ...] | None:
        """The entries on rank 0, in the same order; None elsewhere."""
        found = {e.time: self._known[e.time] if e.time in self._known else self._gather(e)
                 for e in entries}
        self._known = found
        states = [found[e.time] for e in entries]
        return None if states[0] is None else tuple(s for s in states if s is not None)

    def _gather(self, entry: Entry) -> StateData | None:
        x = self.model.dofs.vector()
        x.array[:] = entry.x
        state = gather_state(self.model, x, entry.time * self.model.scales.time)
        x.destroy()
        return state


def owned_values(model: Model, state: StateData | None) -> Array:
    """The owned part of the solution vector that a state holds. Collective; state on rank 0.

    Raises SceneError where the state belongs to another mesh or to other unknowns.
    """
    mesh, dofs, comm = model.mesh, model.dofs, model.mesh.comm
    state = comm.bcast(state, root=0)
    _refuse_other_mesh(model, state)
    local = np.zeros(dofs.size_local)
    scalars = {}
    for name, f in dofs.fields.items():
        numbers, values = state.fields[name]
        scaled = values / units_of(model)[name][0]
        if f.degree == 0:
            scalars[name] = float(scaled[0, 0])
            continue
        rows = np.searchsorted(numbers, mesh.natural_node[dofs.nodes[name]])
        dofs.field(name, local)[...] = scaled[rows]
    local = model.system.stored(local)
    x = dofs.vector()
    x.array[:] = local[dofs.owned]
    for name, value in scalars.items():
        dofs.set_scalar(name, x, value)
    owned = x.array.copy()
    x.destroy()
    return owned


def _refuse_other_mesh(model: Model, state: StateData) -> None:
    mesh = model.mesh
    same = set(state.fields) == set(model.dofs.fields)
    same = same and len(state.mesh_nodes) == mesh.global_node_count
    if same:
        places = state.mesh_nodes[mesh.natural_node] / model.scales.length
        same = bool(np.abs(places - mesh.coordinates).max(initial=0.0) < SAME_PLACE)
    if not mesh.comm.allreduce(same, op=MPI.LAND):
        raise SceneError("The checkpoint belongs to another mesh or to other effects than the "
                         "scene's; run the scene anew.")
