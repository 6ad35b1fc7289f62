"""The discrete system: terms on domains -> residual F(x) and exact Jacobian.

Everything is sized by the union of the terms: an effect that is absent has no unknown, no
block and no loop.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.fem import kernels
from porolub.fem.blocks import Block, entity_columns, entity_rows, turned_entities
from porolub.fem.constraints import Constraints
from porolub.fem.dofs import Dofs, Field
from porolub.fem.domains import Domain
from porolub.fem.pattern import Pattern
from porolub.fem.points import Integrand, Points
from porolub.solve.place import Place
from porolub.terms.term import Part, Stores, Term

Array = NDArray[np.float64]
Ints = NDArray[np.int32]
BATCH = 9216  # points at a time: enough to forget NumPy's overhead, few enough for the cache
Parts = dict[str, list[Part]]  # by domain


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
    order = [n for n in ("u", "p", "j", "l") if n in fields]
    rest = sorted(n for n in fields if n not in order)
    return [fields[n] for n in [*order, *rest]]


def parts_of(terms: list[Term]) -> Parts:
    """The terms' integrals by domain."""
    parts: Parts = {}
    for t in terms:
        for part in t.parts():
            parts.setdefault(part.domain, []).append(part)
    return parts


def contents_of(terms: list[Term]) -> Parts:
    """What the terms store, by domain."""
    parts: Parts = {}
    for t in terms:
        if isinstance(t, Stores):
            for part in t.contents():
                parts.setdefault(part.domain, []).append(part)
    return parts


class System:
    """Residual G(x) + d/dt C(x) and Jacobian of a list of terms; C is what the terms store.

    ``domains`` maps the domain names the terms use to ``Domain`` objects.  In time, a scheme sets
    ``rate`` and ``known`` such that d/dt C = rate C(x) + known; in a steady solve rate is 0.
    """

    def __init__(self, dofs: Dofs, terms: list[Term], domains: dict[str, Domain],
                 constraints: Constraints, finite: bool) -> None:
        self.dofs, self.terms, self.domains = dofs, terms, domains
        self.constraints, self.finite = constraints, finite
        self.parts, self.contents = parts_of(terms), contents_of(terms)
        self._rotated_dofs = self._rotation_dofs()
        self._free = np.ones(dofs.size_local, bool)
        self._free[constraints.fixed] = False
        self._pattern: Pattern | None = None
        self._blocks: dict[str, dict[tuple[str, str], Block]] = {}
        self.lowest_jacobian = 1.0
        self._lowest_here: tuple[float, Place] = (np.inf, ())
        self.share = 1.0  # of the prescribed values that acts (continuation)
        self.rate = 0.0
        self.known: dict[str, Array] = {}  # by term: its share of d/dt C that x does not change

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
        x.array[d.global_numbers[c.fixed[own]] - first] = self.share * c.values[own]

    # -- assembly -----------------------------------------------------------------------
    @staticmethod
    def _batch(domain: Domain) -> int:
        return max(1, BATCH // domain.weights.shape[1])

    def _points(self, name: str, local: Array) -> Iterator[Points]:
        domain = self.domains[name]
        step = self._batch(domain)
        for start in range(0, len(domain), step):
            rows = slice(start, min(start + step, len(domain)))
            yield Points(domain, self.dofs, local, rows, self.finite)

    @np.errstate(divide="ignore", invalid="ignore", over="ignore")  # J <= 0 is seen by _watch
    def _add_residual(self, x: Array, r: Array, parts: Parts, contents: Parts) -> None:
        """One pass over the points: adds parts + rate contents to the local residual."""
        for name in sorted({*parts, *contents}):
            for at in self._points(name, x):
                out = Integrand(jacobian=False)
                self._evaluate(at, out, parts.get(name, []), contents.get(name, []))
                self._watch(name, at)
                self._contract_residual(at, out, r)

    @np.errstate(divide="ignore", invalid="ignore", over="ignore")
    def _add_matrix(self, x: Array, values: Array) -> None:
        """One pass over the points: adds the derivatives to the matrix values."""
        for name, blocks in self._blocks.items():
            contents = self.contents.get(name, []) if self.rate else []
            for at in self._points(name, x) if blocks else ():
                out = Integrand(jacobian=True, residual=False)
                self._evaluate(at, out, self.parts.get(name, []), contents)
                self._contract_matrix(at, out, blocks, values)

    def _evaluate(self, at: Points, out: Integrand, parts: list[Part],
                  contents: list[Part]) -> None:
        for part in parts:
            part.add(at, out)
        out.factor = self.rate
        for part in contents:
            part.add(at, out)

    def _selected(self, only: set[str] | None) -> list[Term]:
        return self.terms if only is None else [t for t in self.terms if t.name in only]

    def _watch(self, name: str, at: Points) -> None:
        if name == "cells" and at.has("u"):
            J = at.deformation.J
            if J.min() < self.lowest_jacobian:
                self.lowest_jacobian = float(J.min())
                worst = np.unravel_index(J.argmin(), J.shape)
                self._lowest_here = self.lowest_jacobian, tuple(at.position[worst].tolist())

    def lowest(self) -> tuple[float, Place]:
        """Lowest J of the last residual and where it is, in mesh units. Collective."""
        return min(self.dofs.mesh.comm.allgather(self._lowest_here))

    def _contract_residual(self, at: Points, out: Integrand, r: Array) -> None:
        d, rows = at.domain, at.rows
        for (name, op), f in out.f.items():
            table, _, _, components = self._side(d, name, op)
            kernels.residual(table, op, d.variant[rows], d.inverse[rows], d.weights[rows],
                             np.ascontiguousarray(f), self.dofs.entity_dofs(name, d)[rows],
                             components, r)

    def _contract_matrix(self, at: Points, out: Integrand, blocks: dict[tuple[str, str], Block],
                         values: Array) -> None:
        d, rows = at.domain, at.rows
        for ((test, top), (trial, rop)), g in out.g.items():
            if (test, trial) not in blocks:
                raise RuntimeError(f"undeclared block {(test, trial)} on {d.name}")
            kernels.matrix(self._side(d, test, top), self._side(d, trial, rop), d.variant[rows],
                           d.inverse[rows], d.weights[rows], np.ascontiguousarray(g),
                           *blocks[test, trial].within(rows), values)

    def _side(self, domain: Domain, name: str, op: bool) -> kernels.Side:
        f = self.dofs.fields[name]
        tables = domain.tables(f.degree)
        table = tables.gradient if op else tables.value
        return table, op, table.shape[-1], f.components

    # -- residual and Jacobian ----------------------------------------------------------
    def local_residual(self, x: Array, only: set[str] | None = None) -> Array:
        """Cartesian residual (size_local,) of this rank's entities, constraints not applied.

        ``x`` is the physical local vector; ``only`` limits to terms of these names.
        """
        r = np.zeros(self.dofs.size_local)
        terms = self._selected(only)
        self._add_residual(x, r, parts_of(terms), contents_of(terms) if self.rate else {})
        if self.rate:
            for t in terms:
                r += self.known.get(t.name, 0.0)
        return r

    def content(self, x: Array) -> dict[str, Array]:
        """What each term that stores something holds: name -> Cartesian (size_local,) shares of
        this rank's entities. ``x`` is the physical local vector."""
        rate, self.rate = self.rate, 1.0
        held = {}
        for t in self.terms:
            if isinstance(t, Stores):
                held[t.name] = np.zeros(self.dofs.size_local)
                self._add_residual(x, held[t.name], {}, contents_of([t]))
        self.rate = rate
        return held

    def rates(self, held: dict[str, Array]) -> Array:
        """d/dt of the contents ``held`` (see ``content``), all terms together (size_local,)."""
        total = np.zeros(self.dofs.size_local)
        if self.rate:
            for name, content in held.items():
                total += self.rate * content + self.known.get(name, 0.0)
        return total

    def backward_euler(self, x: Array, step: float) -> None:
        """Take the rate of contents as their difference to those of x, over a time step."""
        self.rate = 1.0 / step
        self.known = {name: -self.rate * c for name, c in self.content(x).items()}

    def steady(self) -> None:
        """Leave out the rate of contents."""
        self.rate, self.known = 0.0, {}

    def residual(self, X: PETSc.Vec, out: PETSc.Vec) -> None:
        """F(x), with x - value in constrained rows.  Sets ``lowest_jacobian`` (all ranks)."""
        stored = self.dofs.to_local(X)
        self.lowest_jacobian, self._lowest_here = np.inf, (np.inf, ())
        r = self.stored(self.local_residual(self.physical(stored)))
        c = self.constraints
        off = stored[c.fixed] - self.share * c.values
        r[c.fixed] = np.where(self.dofs.owned[c.fixed], off, 0.0)
        self.dofs.add_to_global(r, out)
        self.lowest_jacobian = self.dofs.mesh.comm.allreduce(self.lowest_jacobian, op=MPI.MIN)

    def jacobian(self, X: PETSc.Vec, mat: PETSc.Mat) -> None:
        """dF/dx into a matrix made by ``create_matrix``."""
        if self._pattern is None:
            raise RuntimeError("create_matrix first")
        x = self.physical(self.dofs.to_local(X))
        with self._pattern.values(mat) as values:
            self._add_matrix(x, values)

    # -- matrix -------------------------------------------------------------------------
    def create_matrix(self) -> PETSc.Mat:
        """Matrix with the union pattern of all declared blocks; constrained rows are diagonal."""
        if self._pattern is None:
            spans = {(name, *block): self._span(name, *block)
                     for name in sorted({*self.parts, *self.contents})
                     for block in sorted(self._blocks_on(name))}
            self._pattern = Pattern(self.dofs, list(spans.values()), self.constraints.fixed)
            self._blocks = {name: {} for name in sorted({*self.parts, *self.contents})}
            for (name, test, trial), (rows, cols, _) in spans.items():
                turned = turned_entities(self.dofs, self.domains[name], self.constraints, test,
                                         trial)
                block = Block(self._pattern.slots(rows, cols), turned)
                self._blocks[name][test, trial] = block
        return self._pattern.create()

    def _blocks_on(self, name: str) -> set[tuple[str, str]]:
        return {b for kind in (self.parts, self.contents) for part in kind.get(name, [])
                for b in part.blocks}

    def _span(self, name: str, test: str, trial: str) -> tuple[Ints, Ints, int]:
        domain, dofs = self.domains[name], self.dofs
        return (entity_rows(dofs, test, domain, self._free),
                entity_columns(dofs, trial, domain, self._free), dofs.fields[trial].components)
