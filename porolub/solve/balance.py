"""Fluid balance of a state: what pores and film hold, and what enters through the boundaries."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.solve.model import Model

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FluidBalance:
    """Scaled volumes: content; its rate; entering and through: volume flows. Same on all ranks."""

    content: float
    rate: float
    entering: float
    through: float

    @property
    def error(self) -> float:
        """What appears from nowhere, relative to what passes through and is stored."""
        size = self.through + abs(self.rate)
        return abs(self.rate - self.entering) / size if size > 0 else 0.0


def fluid_balance(model: Model, local: Array, held: dict[str, Array]) -> FluidBalance:
    """Balance of a physical local vector whose contents (System.content) are ``held``.

    Tested with q = 1 the fluid rows keep only what crosses a boundary: material that carries its
    fluid through the ends, leaks of an open surface.  Nodes of prescribed pressure exchange their
    reaction.  In a steady state it all sums to zero.
    """
    dofs, system = model.dofs, model.system
    rows = np.zeros(dofs.size_local, bool)
    rows[dofs.range["p"]] = True
    fixed = np.zeros(dofs.size_local, bool)
    fixed[system.constraints.fixed] = True
    residual = system.local_residual(local)
    rates = system.rates(held)
    reaction = dofs.sum_local(residual)[rows & fixed & dofs.owned]
    # content and rates only count in rows of fluid mass; inertia stores momentum
    sums = np.array([sum((c[rows].sum() for c in held.values()), 0.0), rates[rows].sum(),
                     residual[rows].sum() - rates[rows].sum(), reaction.sum(),
                     np.abs(reaction).sum()])
    content, rate, leaving, supplied, exchanged = model.mesh.comm.allreduce(sums)
    return FluidBalance(float(content), float(rate), float(supplied - leaving),
                        float(exchanged + abs(leaving)))
