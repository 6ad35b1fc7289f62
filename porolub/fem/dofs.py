"""Numbering of the unknowns: fields on mesh nodes and global scalars, local and global.

Local vectors hold every dof a rank touches (ghosts included), field by field.  Globally each
rank owns a contiguous block, field by field; scalars (the rigid approach) sit on the last rank.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.errors import SolveError
from porolub.mesh import Mesh

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Field:
    """One unknown: ``degree`` 1 or 2 on nodes, 0 for a global scalar.

    support: ``body`` (all nodes of that degree), or the name of a boundary (its nodes only).
    nodal: of a boundary, only the points of nodal quadrature on it.
    differential: its equation holds a time derivative (counts in the time error norm).
    """

    name: str
    components: int
    degree: int
    support: str = "body"
    differential: bool = False
    nodal: bool = False


def sum_at_nodes(mesh: Mesh, shares: Array) -> Array:
    """Add up this rank's nodal shares (nnode, k) over the ranks, the same on all. Collective."""
    k = shares.shape[1]
    dofs = Dofs(mesh, [Field("share", k, mesh.degree)])
    nodes = dofs.nodes["share"]
    total = np.zeros_like(shares)
    total[nodes] = dofs.sum_local(shares[nodes].ravel()).reshape(-1, k)
    dofs.destroy()
    return total


def nodal_points(mesh: Mesh, boundary: str) -> NDArray[np.int64]:
    """Local nodes (k,) of a boundary that nodal quadrature of its degree uses, see nodal_weights.

    All of them, but for quadratic triangles: there the middles of the sides, whose weights A/3
    are exact to degree 2, while the corners' would be zero.
    """
    nodes = mesh.boundary_nodes(boundary)
    if mesh.cell_type == "tet" and mesh.degree == 2:
        return nodes[nodes >= mesh.nvertices]
    return nodes


class Dofs:
    """Dof numbers of a list of fields on a mesh."""

    def __init__(self, mesh: Mesh, fields: list[Field]) -> None:
        self.mesh = mesh
        self.fields = {f.name: f for f in fields}
        comm = mesh.comm
        last = comm.rank == comm.size - 1
        self.nodes: dict[str, NDArray[np.int64]] = {}
        self.base: dict[str, NDArray[np.int32]] = {}  # node -> local dof of component 0, or -1
        self.range: dict[str, slice] = {}
        owned_parts: list[NDArray[np.bool_]] = []
        start = 0
        for f in fields:
            nodes = self._field_nodes(f)
            if f.degree == 0:
                count, owned = 1, np.array([last])
            else:
                count, owned = len(nodes) * f.components, np.repeat(mesh.owned[nodes], f.components)
            base = np.full(len(mesh.coordinates) if f.degree else 1, -1, dtype=np.int32)
            base[nodes] = start + f.components * np.arange(len(nodes), dtype=np.int32)
            self.nodes[f.name], self.base[f.name] = nodes, base
            self.range[f.name] = slice(start, start + count)
            owned_parts.append(owned)
            start += count
        self.size_local = start
        self.owned = np.concatenate(owned_parts) if owned_parts else np.zeros(0, bool)
        self.count_owned = int(self.owned.sum())
        self.global_numbers = self._number(comm)
        self.size = comm.allreduce(self.count_owned)
        self._scatter: PETSc.Scatter | None = None
        self._entity_dofs: WeakKeyDictionary = WeakKeyDictionary()  # domain -> field -> numbers

    def _field_nodes(self, f: Field) -> NDArray[np.int64]:
        mesh = self.mesh
        if f.degree == 0:
            return np.zeros(1, dtype=np.int64)
        cells = mesh.cells if f.degree == mesh.degree else mesh.vertices_of_cells
        nodes = np.unique(cells)
        if f.support != "body":
            of_surface = nodal_points if f.nodal else Mesh.boundary_nodes
            nodes = np.intersect1d(nodes, of_surface(mesh, f.support))
        return nodes.astype(np.int64)

    def _number(self, comm: PETSc.Comm) -> NDArray[np.int32]:
        """Global number of every local dof: owners number, ghosts are told."""
        mesh = self.mesh
        first = comm.exscan(self.count_owned) or 0
        numbers = np.full(self.size_local, -1, dtype=np.int64)
        numbers[self.owned] = first + np.arange(self.count_owned)
        for f in self.fields.values():
            dofs = np.arange(self.range[f.name].start, self.range[f.name].stop)
            if f.degree == 0:
                root = comm.size - 1
                numbers[dofs] = comm.bcast(numbers[dofs], root=root)
                continue
            nodes = self.nodes[f.name]
            numbers_of_nodes = np.zeros(len(mesh.coordinates))
            numbers_of_nodes[nodes] = numbers[dofs[:: f.components]]
            known = self._owners_value(numbers_of_nodes)[nodes].astype(np.int64)
            numbers[dofs] = (known[:, None] + np.arange(f.components)).ravel()
        if np.any(numbers < 0):
            raise RuntimeError("a dof has no global number: boundary nodes differ between ranks")
        if numbers.max(initial=0) > np.iinfo(np.int32).max:
            raise SolveError("More than 2^31 unknowns: this PETSc counts them in 32 bits.")
        return numbers.astype(np.int32)

    def _owners_value(self, values: Array) -> Array:
        """Per-node array (nnode,) with every ghost node set to its owner's value."""
        mesh = self.mesh
        v = PETSc.Vec().createMPI((int(mesh.owned.sum()), PETSc.DETERMINE), comm=mesh.comm)
        first = v.getOwnershipRange()[0]
        v.array[mesh.global_node[mesh.owned] - first] = values[mesh.owned]
        wanted = PETSc.IS().createGeneral(mesh.global_node.astype(np.int32), PETSc.COMM_SELF)
        local = PETSc.Vec().createSeq(len(values), comm=PETSc.COMM_SELF)
        scatter = PETSc.Scatter().create(v, wanted, local, None)
        scatter.scatter(v, local)
        result = local.array.copy()
        for o in (v, wanted, local, scatter):
            o.destroy()
        return result

    # -- vectors ------------------------------------------------------------------------
    def vector(self) -> PETSc.Vec:
        v = PETSc.Vec().createMPI((self.count_owned, self.size), comm=self.mesh.comm)
        v.set(0.0)
        return v

    def _plan(self) -> tuple[PETSc.Scatter, PETSc.Vec]:
        if self._scatter is None:
            self._work = PETSc.Vec().createSeq(self.size_local, comm=PETSc.COMM_SELF)
            self._template = self.vector()
            source = PETSc.IS().createGeneral(self.global_numbers, comm=PETSc.COMM_SELF)
            self._scatter = PETSc.Scatter().create(self._template, source, self._work, None)
            source.destroy()
        return self._scatter, self._work

    def to_local(self, x: PETSc.Vec) -> Array:
        """Local copy (size_local,) of a global vector, ghosts filled."""
        scatter, work = self._plan()
        scatter.scatter(x, work, addv=PETSc.InsertMode.INSERT, mode=PETSc.ScatterMode.FORWARD)
        return work.array.copy()

    def add_to_global(self, local: Array, out: PETSc.Vec) -> None:
        """out = sum over ranks of the local contributions."""
        scatter, work = self._plan()
        work.array[:] = local
        out.set(0.0)
        scatter.scatter(work, out, addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)

    def sum_local(self, local: Array) -> Array:
        """Local array of contributions summed over ranks, consistent on every rank."""
        total = self.vector()
        self.add_to_global(local, total)
        result = self.to_local(total)
        total.destroy()
        return result

    def entity_dofs(self, name: str, domain: Any) -> NDArray[np.int32]:
        """(ne, nn) local number of component 0 at the nodes of each entity, -1 where absent."""
        known = self._entity_dofs.setdefault(domain, {})
        if name not in known:
            known[name] = self._number_entities(name, domain)
        return known[name]

    def _number_entities(self, name: str, domain: Any) -> NDArray[np.int32]:
        f, base = self.fields[name], self.base[name]
        if f.degree == 0:
            return np.full((len(domain), 1), base[0], dtype=np.int32)
        if domain.name.startswith("nodes:"):
            return np.ascontiguousarray(base[domain.cells][:, None])
        cells = self.mesh.cells if f.degree == self.mesh.degree else self.mesh.vertices_of_cells
        return np.ascontiguousarray(base[cells[domain.cells]])

    def field(self, name: str, local: Array) -> Array:
        """View (nodes, components) of one field in a local vector, in the order of ``nodes``."""
        return local[self.range[name]].reshape(-1, self.fields[name].components)

    def field_norms(self, v: PETSc.Vec, order: float) -> dict[str, float]:
        """Norm of each field's owned part over all ranks: order 2, or infinity for the maximum."""
        first = v.getOwnershipRange()[0]
        parts = []
        for r in self.range.values():
            mine = v.array_r[self.global_numbers[r][self.owned[r]] - first]
            parts.append(np.abs(mine).max(initial=0.0) if np.isinf(order) else mine @ mine)
        total = np.array(parts)
        self.mesh.comm.Allreduce(MPI.IN_PLACE, total, MPI.MAX if np.isinf(order) else MPI.SUM)
        if not np.isinf(order):
            total = np.sqrt(total)
        return dict(zip(self.range, total.tolist(), strict=True))

    def scalar_value(self, name: str, v: PETSc.Vec) -> float:
        """Value of a global scalar, on every rank."""
        k = self.range[name].start
        mine = None
        if self.owned[k]:
            mine = float(v.array_r[self.global_numbers[k] - v.getOwnershipRange()[0]])
        return self.mesh.comm.bcast(mine, root=self.mesh.comm.size - 1)

    def set_scalar(self, name: str, v: PETSc.Vec, value: float) -> None:
        """Set a global scalar in a global vector."""
        k = self.range[name].start
        if self.owned[k]:
            v.array[self.global_numbers[k] - v.getOwnershipRange()[0]] = value

    def owned_part(self, name: str, local: NDArray) -> NDArray:
        """Of values per local dof (size_local,), those of one field's owned dofs."""
        where = self.range[name]
        return np.asarray(local[where][self.owned[where]])

    def owned_numbers(self, name: str) -> NDArray[np.int32]:
        """Global numbers of one field's owned dofs, ascending."""
        return self.owned_part(name, self.global_numbers)

    def index_set(self, name: str) -> PETSc.IS:
        """Owned global dofs of one field."""
        return PETSc.IS().createGeneral(self.owned_numbers(name), comm=self.mesh.comm)

    def counts(self) -> dict[str, int]:
        """Global number of unknowns of each field."""
        comm = self.mesh.comm
        return {name: comm.allreduce(int(self.owned[r].sum())) for name, r in self.range.items()}

    def destroy(self) -> None:
        if self._scatter is not None:
            for o in (self._scatter, self._work, self._template):
                o.destroy()
            self._scatter = None
