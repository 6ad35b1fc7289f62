"""One (test, trial) block of the matrix on a domain: element matrices and where they go."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.fem import kernels
from porolub.fem.constraints import Constraints
from porolub.fem.dofs import Dofs
from porolub.fem.domains import Domain

Array = NDArray[np.float64]
Ints = NDArray[np.int32]


def entity_numbers(dofs: Dofs, name: str, domain: Domain, free: NDArray[np.bool_],
                   across: bool = False) -> Ints:
    """(ne, nodes * components) local dofs of a field, -1 where absent or not free.

    In the order (node, component), ``across`` (columns): (component, node).
    """
    base = dofs.entity_dofs(name, domain)[:, :, None]
    numbers = base + np.arange(dofs.fields[name].components, dtype=np.int32)
    numbers = np.where((base >= 0) & free[numbers], numbers, np.int32(-1))
    count = numbers.shape[1] * numbers.shape[2]
    return (numbers.transpose(0, 2, 1) if across else numbers).reshape(len(numbers), count)


@dataclass(frozen=True)
class Rotations:
    """Entities (k,), ascending, with nodes in a rotated frame: their numbers (k, nn), -1: none."""

    entities: Ints
    frame_of: Ints
    frames: Array

    @classmethod
    def of(cls, dofs: Dofs, domain: Domain, constraints: Constraints) -> Rotations:
        first = dofs.base["u"][constraints.rotated]
        lookup = np.full(dofs.size_local + 1, -1, dtype=np.int32)  # the absent dof -1 reads the end
        lookup[first] = np.arange(len(first), dtype=np.int32)
        frame_of = lookup[dofs.entity_dofs("u", domain)]
        entities = np.flatnonzero((frame_of >= 0).any(axis=1)).astype(np.int32)
        return cls(entities, np.ascontiguousarray(frame_of[entities]),
                   np.ascontiguousarray(constraints.frame))


class Block:
    """``test`` and ``trial`` are (nodes, components); slots (ne, test nodes, row), -1: dropped."""

    def __init__(self, test: tuple[int, int], trial: tuple[int, int], slots: Ints, batch: int,
                 rotated: dict[str, Rotations]) -> None:
        self.test, self.trial, self._slots, self._rotated = test, trial, slots, rotated
        self.matrices = kernels.matrix_buffer(min(batch, len(slots)), test, trial)

    def insert(self, rows: slice, values: Array) -> None:
        """Rotate the element matrices of a batch (K <- R^T K R) and add them to the values."""
        for side, rotated in self._rotated.items():
            chosen = slice(*np.searchsorted(rotated.entities, (rows.start, rows.stop)))
            kernels.rotate(rotated.entities[chosen] - np.int32(rows.start),
                           rotated.frame_of[chosen], rotated.frames, side == "trial", self.test,
                           self.trial, self.matrices)
        kernels.scatter(self.matrices, self._slots[rows], values)
