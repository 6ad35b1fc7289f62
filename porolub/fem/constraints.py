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


def node_frame(directions: list[Array], values: list[float], where: str) -> tuple[Array, Array]:
    """Frame (dim, dim) and the fixed leading components for one node.

    Raises SceneError when two boundaries demand contradicting displacements.
    """
    dim = len(directions[0])
    axes: list[Array] = []
    components: list[float] = []
    for d, b in zip(directions, values, strict=True):
        along = np.array([a @ d for a in axes])
        rest = d - sum((c * a for c, a in zip(along, axes, strict=True)), np.zeros(dim))
        size = float(np.linalg.norm(rest))
        remainder = b - float(along @ np.array(components)) if axes else b
        if size > 1e-6:
            axes.append(rest / size)
            components.append(remainder / size)
        elif abs(remainder) > 1e-9 * max(1.0, abs(b)):
            raise SceneError(f"Boundary conditions contradict each other {where}.")
    fixed = np.array(components)
    basis = np.array(axes)
    if len(axes) < dim:  # complete to an orthonormal frame
        q, _ = np.linalg.qr(np.vstack([basis, np.eye(dim)]).T)
        basis = np.vstack([basis, q[:, len(axes):dim].T])
    return basis.T, fixed


class ConstraintBuilder:
    """Collects conditions per node, then fixes the frames."""

    def __init__(self, dofs: Dofs) -> None:
        self.dofs = dofs
        self._directions: dict[int, list[tuple[Array, float]]] = {}
        self._scalars: dict[int, float] = {}

    def direction(self, nodes: NDArray[np.int64], directions: Array, value: float) -> None:
        """u . direction = value at nodes (k,), directions (k, dim) of unit length."""
        for n, d in zip(nodes, directions, strict=True):
            self._directions.setdefault(int(n), []).append((d, value))

    def scalar(self, field: str, nodes: NDArray[np.int64], value: float) -> None:
        """A one-component field equals value at nodes where it lives."""
        base = self.dofs.base[field][nodes]
        self._scalars.update({int(b): value for b in base[base >= 0]})

    def build(self) -> Constraints:
        fixed, values, rotated, frames = [], [], [], []
        for n, conditions in sorted(self._directions.items()):
            base = int(self.dofs.base["u"][n])
            if base < 0:
                continue
            X = ", ".join(f"{x:.4g}" for x in self.dofs.mesh.coordinates[n])
            frame, components = node_frame([c[0] for c in conditions], [c[1] for c in conditions],
                                           f"at the node ({X})")
            fixed += [base + k for k in range(len(components))]
            values += list(components)
            if not np.allclose(frame, np.eye(len(frame)), atol=1e-14):
                rotated.append(n)
                frames.append(frame)
        fixed += list(self._scalars)
        values += list(self._scalars.values())
        dim = self.dofs.mesh.dim
        return Constraints(np.array(fixed, dtype=np.int64), np.array(values, dtype=float),
                           np.array(rotated, dtype=np.int64),
                           np.array(frames, dtype=float).reshape(-1, dim, dim))
