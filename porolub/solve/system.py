"""The discrete system: terms on domains -> residual F(x) and exact Jacobian.

Everything is sized by the union of the terms: an effect that is absent has no unknown, no
block and no loop.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.fem import coo, kernels
from porolub.fem.constraints import Constraints
from porolub.fem.dofs import Dofs, Field
from porolub.fem.domains import Domain
from porolub.fem.points import Integrand, Points
from porolub.terms.term import Part, Term

Array = NDArray[np.float64]
CHUNK = 256  # entities at a time: pointwise arrays stay in cache


@dataclass
class BlockPlan:
    """Where one (test, trial) block of a domain stands in the COO value array."""

    start: int
    stop: int
    shape: tuple[int, ...]
    rotations: dict[str, list[tuple[int, NDArray[np.int64], Array]]] = field(default_factory=dict)


def union_of_fields(terms: list[Term]) -> list[Field]:
    """All fields the terms add, in canonical order; refuses a term whose input is missing."""
    fields: dict[str, Field] = {}
    for t in terms:
        for f in t.fields():
            if fields.setdefault(f.name, f) != f:
                raise ValueError(f"two terms define the field {f.name!r} differently")
    for t in terms:
        for name in t.reads():
            if name not in fields:
                raise ValueError(f"the term {t.name!r} needs the field {name!r}, which nobody adds")
    order = [n for n in ("u", "p", "l") if n in fields]
    rest = sorted(n for n in fields if n not in ("u", "p", "l"))
    return [fields[n] for n in [*order, *rest]]


class System:
    """Residual and Jacobian of a list of terms.

    ``domains`` maps the domain names the terms use to ``Domain`` objects.
    """

    def __init__(self, dofs: Dofs, terms: list[Term], domains: dict[str, Domain],
                 constraints: Constraints, finite: bool) -> None:
        self.dofs, self.terms, self.domains = dofs, terms, domains
        self.constraints, self.finite = constraints, finite
        self.parts: dict[str, list[Part]] = {}
        for t in terms:
            for part in t.parts():
                self.parts.setdefault(part.domain, []).append(part)
        self._rotated_dofs = self._rotation_dofs()
        self._free = np.ones(dofs.size_local, bool)
        self._free[constraints.fixed] = False
        self._plans: dict[str, dict[tuple[str, str], BlockPlan]] = {}
        self._values: Array | None = None
        self.lowest_jacobian = 1.0
        self.previous: Array | None = None  # physical local vector at the start of a step

    # -- state --------------------------------------------------------------------------
    def _rotation_dofs(self) -> NDArray[np.int64]:
        if not len(self.constraints.rotated):
            return np.zeros((0, self.dofs.mesh.dim), dtype=np.int64)
        base = self.dofs.base["u"][self.constraints.rotated].astype(np.int64)
        return base[:, None] + np.arange(self.dofs.mesh.dim)

    def physical(self, stored: Array) -> Array:
        """Local vector with rotated displacements turned into Cartesian ones (a copy)."""
        x = stored.copy()
        k = self._rotated_dofs
        x[k] = np.einsum("nij,nj->ni", self.constraints.frame, stored[k])
        return x

    def stored(self, physical: Array) -> Array:
        """Inverse of ``physical``; also turns Cartesian forces into frame forces."""
        x = physical.copy()
        k = self._rotated_dofs
        x[k] = np.einsum("nji,nj->ni", self.constraints.frame, physical[k])
        return x

    def apply_conditions(self, x: PETSc.Vec) -> None:
        """Set the essential values in a global vector."""
        c, d = self.constraints, self.dofs
        own = d.owned[c.fixed]
        first = x.getOwnershipRange()[0]
        x.array[d.global_numbers[c.fixed[own]] - first] = c.values[own]

    # -- residual -----------------------------------------------------------------------
    def _points(self, name: str, local: Array):
        domain = self.domains[name]
        for start in range(0, len(domain), CHUNK):
            yield Points(domain, self.dofs, local, slice(start, start + CHUNK), self.finite,
                         self.previous)

    def local_residual(self, x: Array, only: set[str] | None = None) -> Array:
        """Cartesian residual (size_local,) of this rank's entities, constraints not applied.

        ``x`` is the physical local vector; ``only`` limits to terms of these names.
        """
        r = np.zeros(self.dofs.size_local)
        for name, parts in self._selected(only).items():
            domain = self.domains[name]
            for at in self._points(name, x):
                out = Integrand(jacobian=False)
                for part in parts:
                    part.add(at, out)
                self._watch(name, at)
                for (fieldname, op), f in out.f.items():
                    self._contract_residual(domain, at.rows, fieldname, op, f, r)
        return r

    def _selected(self, only: set[str] | None) -> dict[str, list[Part]]:
        if only is None:
            return self.parts
        chosen: dict[str, list[Part]] = {}
        for t in self.terms:
            if t.name in only:
                for part in t.parts():
                    chosen.setdefault(part.domain, []).append(part)
        return chosen

    def _watch(self, name: str, at: Points) -> None:
        if name == "cells" and at.has("u"):
            self.lowest_jacobian = min(self.lowest_jacobian, float(at.deformation.J.min()))

    def _contract_residual(self, domain: Domain, rows: slice, name: str, op: bool, f: Array,
                           r: Array) -> None:
        fld = self.dofs.fields[name]
        tables = domain.tables(fld.degree)
        kernels.residual(tables.gradient if op else tables.value, op, domain.variant[rows],
                         domain.inverse[rows], domain.weights[rows], np.ascontiguousarray(f),
                         self.dofs.entity_dofs(name, domain)[rows], fld.components, r)

    def residual(self, X: PETSc.Vec, out: PETSc.Vec) -> None:
        """F(x), with x - value in constrained rows.  Sets ``lowest_jacobian`` (all ranks)."""
        stored = self.dofs.to_local(X)
        self.lowest_jacobian = np.inf
        r = self.stored(self.local_residual(self.physical(stored)))
        c = self.constraints
        r[c.fixed] = np.where(self.dofs.owned[c.fixed], stored[c.fixed] - c.values, 0.0)
        self.dofs.add_to_global(r, out)
        comm = self.dofs.mesh.comm
        self.lowest_jacobian = comm.allreduce(self.lowest_jacobian, op=_min())

    # -- Jacobian -----------------------------------------------------------------------
    def create_matrix(self) -> PETSc.Mat:
        """Matrix with the union pattern of all declared blocks; constrained rows are diagonal."""
        rows, cols, position = [], [], 0
        for name, parts in self.parts.items():
            domain, plans = self.domains[name], {}
            for test, trial in sorted({b for part in parts for b in part.blocks}):
                i, j = self._entity_numbers(test, domain), self._entity_numbers(trial, domain)
                ne = len(domain)
                shape = (ne, *i.shape[1:], *j.shape[1:])
                size = int(np.prod(shape))
                rows.append(np.broadcast_to(i[:, :, :, None, None], shape).ravel())
                cols.append(np.broadcast_to(j[:, None, None], shape).ravel())
                plans[test, trial] = BlockPlan(position, position + size, shape,
                                               self._plan_rotations(test, trial, domain))
                position += size
            self._plans[name] = plans
        diagonal = self._diagonal_rows()
        rows.append(diagonal)
        cols.append(diagonal)
        self._values = np.zeros(position + len(diagonal))
        self._values[position:] = 1.0
        n = (self.dofs.count_owned, self.dofs.size)
        mat = PETSc.Mat().create(comm=self.dofs.mesh.comm)
        mat.setSizes((n, n))
        mat.setType("aij")
        mat.setUp()
        coo.preallocate(mat, np.concatenate(rows), np.concatenate(cols))
        return mat

    def _diagonal_rows(self) -> NDArray[np.int32]:
        """Constrained owned rows, and every owned row once so the diagonal exists."""
        d = self.dofs
        fixed = self.constraints.fixed
        return d.global_numbers[fixed[d.owned[fixed]]]

    def _entity_numbers(self, name: str, domain: Domain) -> NDArray[np.int32]:
        """(ne, components, nodes) global numbers, -1 where absent or constrained."""
        base = self.dofs.entity_dofs(name, domain)
        dofs = base[:, None, :] + np.arange(self.dofs.fields[name].components)[None, :, None]
        present = np.broadcast_to(base[:, None, :] >= 0, dofs.shape)
        number = np.where(self._free, self.dofs.global_numbers, -1)
        return np.where(present, number[np.where(present, dofs, 0)], -1).astype(np.int32)

    def _plan_rotations(self, test: str, trial: str, domain: Domain) -> dict:
        """For each side that is ``u``: (node slot, entities, frames) of rotated nodes."""
        plan: dict[str, list[tuple[int, NDArray[np.int64], Array]]] = {}
        if not len(self.constraints.rotated) or "u" not in (test, trial):
            return plan
        lookup = np.full(self.dofs.size_local + 1, -1, dtype=np.int64)
        lookup[self._rotated_dofs[:, 0]] = np.arange(len(self._rotated_dofs))
        which = lookup[self.dofs.entity_dofs("u", domain)]  # -1 dof reads the last, unused slot
        slots = []
        for slot in range(which.shape[1]):
            entities = np.flatnonzero(which[:, slot] >= 0)
            if len(entities):
                slots.append((slot, entities, self.constraints.frame[which[entities, slot]]))
        for side, name in (("test", test), ("trial", trial)):
            if name == "u" and slots:
                plan[side] = slots
        return plan

    def jacobian(self, X: PETSc.Vec, mat: PETSc.Mat) -> None:
        """dF/dx into a matrix made by ``create_matrix``."""
        if self._values is None:
            raise RuntimeError("create_matrix first")
        x = self.physical(self.dofs.to_local(X))
        for name, parts in self.parts.items():
            plans = self._plans[name]
            if not plans:
                continue
            domain = self.domains[name]
            blocks = {}
            for key, plan in plans.items():
                blocks[key] = self._values[plan.start:plan.stop].reshape(plan.shape)
                blocks[key][...] = 0.0
            for at in self._points(name, x):
                out = Integrand(jacobian=True)
                for part in parts:
                    part.add(at, out)
                for ((test, top), (trial, rop)), g in out.g.items():
                    if (test, trial) not in blocks:
                        raise RuntimeError(f"undeclared block {(test, trial)} on {name}")
                    kernels.matrix(self._side(domain, test, top), self._side(domain, trial, rop),
                                   domain.variant[at.rows], domain.inverse[at.rows],
                                   domain.weights[at.rows], np.ascontiguousarray(g),
                                   blocks[test, trial][at.rows])
            for key, plan in plans.items():
                self._rotate(blocks[key], plan)
        coo.insert(mat, self._values)

    def _side(self, domain: Domain, name: str, op: bool) -> tuple[Array, bool, int, int]:
        f = self.dofs.fields[name]
        tables = domain.tables(f.degree)
        table = tables.gradient if op else tables.value
        return table, op, table.shape[-1], f.components

    @staticmethod
    def _rotate(block: Array, plan: BlockPlan) -> None:
        """K <- R^T K R at rotated nodes; block (ne, ci, ni, cj, nj)."""
        for slot, entities, frame in plan.rotations.get("test", []):
            part = block[entities, :, slot]
            block[entities, :, slot] = np.einsum("eki,ek...->ei...", frame, part)
        for slot, entities, frame in plan.rotations.get("trial", []):
            part = block[entities, ..., slot]
            block[entities, ..., slot] = np.einsum("eabk,ekj->eabj", part, frame)


def _min():
    from mpi4py import MPI

    return MPI.MIN
