"""Blocks of the matrix on a domain: which dofs span them and where their entries go."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.fem.constraints import Constraints
from porolub.fem.dofs import Dofs
from porolub.fem.domains import Domain
from porolub.fem.kernels import Turned

Ints = NDArray[np.int32]


def entity_rows(dofs: Dofs, name: str, domain: Domain, free: NDArray[np.bool_]) -> Ints:
    """(ne, nodes * components) local dofs of a field, -1 where absent or not free."""
    base = dofs.entity_dofs(name, domain)[:, :, None]
    numbers = base + np.arange(dofs.fields[name].components, dtype=np.int32)
    numbers = np.where((base >= 0) & free[numbers], numbers, np.int32(-1))
    return numbers.reshape(len(base), base.shape[1] * numbers.shape[2])


def entity_columns(dofs: Dofs, name: str, domain: Domain, free: NDArray[np.bool_]) -> Ints:
    """(ne, nodes) local dof of a node's first component, -1 where absent or none is free."""
    base = dofs.entity_dofs(name, domain)
    some = np.zeros(base.shape, bool)
    for k in range(dofs.fields[name].components):
        some |= free[base + k]
    return np.where((base >= 0) & some, base, np.int32(-1))


def turned_entities(dofs: Dofs, domain: Domain, constraints: Constraints, test: str,
                    trial: str) -> Turned | None:
    """Where the displacements of a (test, trial) block are stored in rotated frames."""
    if "u" not in (test, trial) or not len(constraints.rotated):
        return None
    first = dofs.base["u"][constraints.rotated]
    lookup = np.full(dofs.size_local + 1, -1, dtype=np.int32)  # the absent dof -1 reads the end
    lookup[first] = np.arange(len(first), dtype=np.int32)
    frame_of = lookup[dofs.entity_dofs("u", domain)]
    entities = np.flatnonzero((frame_of >= 0).any(axis=1)).astype(np.int32)
    frame_of = np.ascontiguousarray(frame_of[entities])
    return Turned(entities, frame_of if test == "u" else None, frame_of if trial == "u" else None,
                  np.ascontiguousarray(constraints.frame))


@dataclass(frozen=True)
class Block:
    """One (test, trial) block of the matrix on a domain: where its entries go."""

    slots: Ints  # (ne, test nodes * components, trial nodes) of first components, -1: dropped
    turned: Turned | None

    def within(self, rows: slice) -> tuple[Turned | None, Ints]:
        """The same for a batch of entities."""
        turned = None if self.turned is None else self.turned.within(rows)
        return turned, self.slots[rows]
