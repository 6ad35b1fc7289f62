"""What a term sees at quadrature points, and where it puts its contributions.

``Points`` evaluates fields lazily and once; ``Integrand`` sums the pointwise fluxes and tangents
of all terms of a domain, so each matrix block is contracted once however many terms fill it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from porolub.fem import kernels
from porolub.fem.dofs import Dofs
from porolub.fem.domains import Domain
from porolub.laws.kinematics import Deformation
from porolub.laws.tensors import combine

Array = NDArray[np.float64]

VALUE, GRAD = False, True
Slot = tuple[str, bool]


class Points:
    """Fields at the points of a slice of a domain.

    Shapes: ``value`` (ne, nq) for one component, else (ne, nq, nc); ``grad`` (ne, nq, dim) or
    (ne, nq, nc, dim).
    """

    def __init__(self, domain: Domain, dofs: Dofs, local: Array, rows: slice,
                 finite: bool) -> None:
        self.domain, self.dofs, self.local, self.rows = domain, dofs, local, rows
        self.finite = finite
        self.dim = domain.dim
        self.position = domain.position[rows]
        self.normal = domain.normal[rows]
        self.weights = domain.weights[rows]
        self._cache: dict[Slot, Array] = {}

    def has(self, name: str) -> bool:
        return name in self.dofs.fields

    def _evaluate(self, name: str, grad: bool) -> Array:
        if (name, grad) not in self._cache:
            f, d = self.dofs.fields[name], self.domain
            tables = d.tables(f.degree)
            a = kernels.evaluate(tables.gradient if grad else tables.value, grad,
                                 d.variant[self.rows], d.inverse[self.rows],
                                 self.dofs.entity_dofs(name, d)[self.rows], f.components,
                                 self.local)
            self._cache[name, grad] = a[:, :, 0] if f.components == 1 else a
        return self._cache[name, grad]

    def value(self, name: str) -> Array:
        return self._evaluate(name, VALUE)

    def grad(self, name: str) -> Array:
        return self._evaluate(name, GRAD)

    @cached_property
    def deformation(self) -> Deformation:
        """Kinematics of ``u``; the undeformed state where the scene has no displacement."""
        if self.has("u"):
            return Deformation(self.grad("u"), self.finite)
        return Deformation(np.zeros((*self.weights.shape, self.dim, self.dim)), False)

    def kept(self, name: str, depends_on: object, compute: Callable[[], Array]) -> Array:
        """An array of these points that depends on no unknown, computed anew only when the
        value ``depends_on`` has changed; whoever asks for the same name means the same array."""
        store = self.domain.__dict__.setdefault("_kept", {})
        key = (name, self.rows.start, self.rows.stop)
        if key not in store or store[key][0] != depends_on:
            store[key] = (depends_on, compute())
        return store[key][1]

    def constant(self, array: Array) -> Array:
        """A (dim,) vector or (dim, dim) tensor repeated at every point."""
        return np.broadcast_to(array, (*self.weights.shape, *np.shape(array)))


class Integrand:
    """Sums of pointwise residual fluxes and tangents, keyed by test (and trial) slot.

    ``weight`` multiplies an array: a number, or one (ne, nq) per point.  Terms may add what is
    not wanted; it is ignored.  ``factor`` multiplies all that is added while it is set.
    """

    def __init__(self, jacobian: bool, residual: bool = True) -> None:
        self.wants_jacobian, self.wants_residual = jacobian, residual
        self.factor = 1.0
        self.f: dict[Slot, Array] = {}
        self.g: dict[tuple[Slot, Slot], Array] = {}

    def residual(self, field: str, op: bool, array: Array, weight: Array | float = 1.0) -> None:
        if self.wants_residual:
            key = (field, op)
            self.f[key] = _add(self.f.get(key), array, self.factor * weight)

    def jacobian(self, test: str, op: bool, trial: str, trial_op: bool, array: Array,
                 weight: Array | float = 1.0) -> None:
        if self.wants_jacobian:
            key = ((test, op), (trial, trial_op))
            self.g[key] = _add(self.g.get(key), array, self.factor * weight)


def _add(total: Array | None, array: Array, weight: Array | float) -> Array:
    """total + weight array; never in place, since arrays may be shared or kept."""
    if total is None:
        return array if np.ndim(weight) == 0 and weight == 1.0 else combine(weight, array)
    return combine(1.0, total, weight, array)
