"""Essential conditions in node-local frames: u . d = value for several directions d per node.

At a node with constrained directions the displacement is stored in an orthonormal frame whose
first axes span them, so every constraint fixes single dofs and the rest stay free.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.fem.dofs import Dofs

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Constraints:
    """fixed: local dofs and their values; frames: nodes whose ``u`` is stored rotated.

    rotated: (k,) mesh nodes; frame: (k, dim, dim), columns are the local axes, u = frame @ stored.
    """

    fixed: NDArray[np.int64]
    values: Array
    rotated: NDArray[np.int64]
    frame: Array


DEPENDENT = 1e-6  # of a unit direction, what is left of it beside the others
CONTRADICTION = 1e-9


def node_frames(directions: Array, values: Array) -> tuple[Array, Array, Array]:
    """Frames for n nodes with m conditions each: u . directions[:, k] = values[:, k].

    directions: (n, m, dim) of unit length; values: (n, m).  Returns the frames (n, dim, dim),
    the components (n, dim) along their axes, NaN where free, and (n,) whether the conditions of a
    node contradict each other.
    """
    n, _, dim = directions.shape
    axes, components = np.zeros((n, dim, dim)), np.full((n, dim), np.nan)
    count = np.zeros(n, dtype=np.int64)
    wrong = np.zeros(n, bool)
    for d, b in zip(directions.swapaxes(0, 1), values.T, strict=True):
        along = np.einsum("nki,ni->nk", axes, d)  # zero for axes not there yet
        rest = d - np.einsum("nk,nki->ni", along, axes)
        size = np.linalg.norm(rest, axis=1)
        remainder = b - np.einsum("nk,nk->n", along, np.nan_to_num(components))
        new = np.flatnonzero((size > DEPENDENT) & (count < dim))
        axes[new, count[new]] = rest[new] / size[new, None]
        components[new, count[new]] = remainder[new] / size[new]
        count[new] += 1
        repeated = np.ones(n, bool)
        repeated[new] = False
        wrong |= repeated & (np.abs(remainder) > CONTRADICTION * np.maximum(1.0, np.abs(b)))
    for given in range(1, dim):  # complete to an orthonormal frame
        some = np.flatnonzero(count == given)
        basis = axes[some, :given]
        unit = np.broadcast_to(np.eye(dim), (len(some), dim, dim))
        q, _ = np.linalg.qr(np.concatenate([basis, unit], axis=1).swapaxes(1, 2))
        axes[some, given:] = q[:, :, given:dim].swapaxes(1, 2)
    return axes.swapaxes(1, 2), components, wrong


class ConstraintBuilder:
    """Collects conditions per node, then fixes the frames."""

    def __init__(self, dofs: Dofs) -> None:
        self.dofs = dofs
        self._directions: list[tuple[NDArray[np.int64], Array, Array]] = []
        self._scalars: list[tuple[NDArray[np.int64], Array]] = []

    def direction(self, nodes: NDArray[np.int64], directions: Array, value: float) -> None:
        """u . direction = value at nodes (k,), directions (k, dim) of unit length."""
        self._directions.append((nodes, np.asarray(directions), np.full(len(nodes), value)))

    def scalar(self, field: str, nodes: NDArray[np.int64], value: float) -> None:
        """A one-component field equals value at nodes where it lives; the last word counts."""
        base = self.dofs.base[field][nodes].astype(np.int64)
        base = base[base >= 0]
        self._scalars.append((base, np.full(len(base), value)))

    def build(self) -> Constraints:
        """Raises SceneError when boundaries demand contradicting displacements of a node."""
        dim = self.dofs.mesh.dim
        nodes, frames, components = self._frames()
        held = ~np.isnan(components)
        base = self.dofs.base["u"][nodes].astype(np.int64) if len(nodes) else nodes
        fixed = [(base[:, None] + np.arange(dim))[held]]
        values = [components[held]]
        if self._scalars:
            dof, value = (np.concatenate(c) for c in zip(*self._scalars, strict=True))
            last, place = np.unique(dof[::-1], return_index=True)
            fixed.append(last)
            values.append(value[::-1][place])
        turned = (np.abs(frames - np.eye(dim)) > 1e-14).any(axis=(1, 2))
        return Constraints(np.concatenate(fixed), np.concatenate(values), nodes[turned],
                           frames[turned])

    def _frames(self) -> tuple[NDArray[np.int64], Array, Array]:
        """Nodes (n,) with conditions on u, ascending, their frames and components."""
        dim = self.dofs.mesh.dim
        if not self._directions:
            return np.zeros(0, np.int64), np.zeros((0, dim, dim)), np.zeros((0, dim))
        node, direction, value = (np.concatenate(c) for c in zip(*self._directions, strict=True))
        there = np.flatnonzero(self.dofs.base["u"][node] >= 0)
        order = there[np.argsort(node[there], kind="stable")]
        nodes, first, many = np.unique(node[order], return_index=True, return_counts=True)
        frames, components = np.empty((len(nodes), dim, dim)), np.empty((len(nodes), dim))
        for m in np.unique(many):
            of = np.flatnonzero(many == m)
            rows = order[first[of][:, None] + np.arange(m)]
            frames[of], components[of], wrong = node_frames(direction[rows], value[rows])
            if wrong.any():
                place = self.dofs.mesh.coordinates[nodes[of[wrong.argmax()]]]
                X = ", ".join(f"{x:.4g}" for x in place)
                raise SceneError(f"Boundary conditions contradict each other at the node ({X}).")
        return nodes.astype(np.int64), frames, components
