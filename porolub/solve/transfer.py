"""Carry a solution from one structured mesh to another through the shape's logical coordinates.

Each rank gets the old values in the box that its own nodes lie in and no more; what is carried
does not depend on the ranks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.interpolate import PchipInterpolator

from porolub.fem.dofs import Field
from porolub.mesh import lattice
from porolub.mesh.mesh import with_middles
from porolub.solve.model import Model
from porolub.solve.natural import from_blocks, to_blocks

Array = NDArray[np.float64]
Index = NDArray[np.int64]
MARGIN = 2  # old ticks beyond the new ones: the slope at a tick depends on both neighbours


@dataclass(frozen=True)
class Snapshot:
    """Fields on the tensor grids of a structured mesh, and scalars.

    ticks: logical positions of its vertices along each axis; rows: field -> (k, components), by
    the numbers of the field's nodes (porolub.mesh.lattice; fields of the lubricated surface have
    no "across" axis).  The rows are all on rank 0, or (``shared``) in blocks of equal size on the
    ranks that made the snapshot (porolub.solve.natural).
    """

    ticks: tuple[Array, ...]
    rows: dict[str, Array]
    scalars: dict[str, float]
    shared: bool

    def outline(self) -> Snapshot:
        """The same without its rows: what other ranks need to know of what rank 0 has."""
        return replace(self, rows={name: rows[:0] for name, rows in self.rows.items()})

    def gathered(self, comm: Any) -> Snapshot:
        """The same with all rows on rank 0. Collective."""
        if not self.shared:
            return self
        rows = {}
        for name, block in self.rows.items():
            blocks = comm.gather(block)
            rows[name] = block[:0] if blocks is None else np.concatenate(blocks)
        return replace(self, rows=rows, shared=False)


def _axes(dim: int, f: Field) -> list[int]:
    return [k for k in range(dim) if f.support == "body" or k != 1]


def _places(model: Model, f: Field) -> Index:
    """Fine indices (n, axes) of the field's nodes in its grid."""
    mesh = model.mesh
    if mesh.fine_index is None:
        raise ValueError("only solutions on structured meshes can be carried to another")
    return mesh.fine_index[model.dofs.nodes[f.name]][:, _axes(mesh.dim, f)]


def _ends(ticks: list[Array]) -> tuple[Index, Index]:
    """First and last fine index along each axis."""
    high = np.array([2 * (len(line) - 1) for line in ticks])
    return np.zeros_like(high), high


def snapshot(model: Model, x: PETSc.Vec) -> Snapshot:
    """Take up a solution. Collective. ValueError for a mesh from a file."""
    mesh, dofs = model.mesh, model.dofs
    local = model.system.physical(dofs.to_local(x))
    rows, scalars = {}, {}
    for name, f in dofs.fields.items():
        if f.degree == 0:
            scalars[name] = dofs.scalar_value(name, x)
            continue
        mine = mesh.owned[dofs.nodes[name]]
        places = _places(model, f)[mine]
        ends = _ends([mesh.vertex_ticks[k] for k in _axes(mesh.dim, f)])
        numbers = lattice.numbers(places, *ends)
        count = int(lattice.count(*ends, f.degree))
        rows[name] = to_blocks(mesh.comm, numbers, dofs.field(name, local)[mine], count)
    return Snapshot(mesh.vertex_ticks, rows, scalars, mesh.comm.size > 1)


def restore(model: Model, data: Snapshot) -> PETSc.Vec:
    """A global vector of ``model`` interpolated from the snapshot, essential conditions set.

    Collective; other ranks than 0 may have the outline of a snapshot that is not shared.
    """
    dofs = model.dofs
    local = np.zeros(dofs.size_local)
    for name, f in dofs.fields.items():
        if f.degree and name in data.rows:
            local[dofs.range[name]] = _interpolated(model, f, data).ravel()
    local = model.system.stored(local)
    x = dofs.vector()
    x.array[:] = local[dofs.owned]
    for name, value in data.scalars.items():
        if name in dofs.fields:
            dofs.set_scalar(name, x, value)
    model.system.apply_conditions(x)
    return x


def _interpolated(model: Model, f: Field, data: Snapshot) -> Array:
    """(nodes, components) of a field at this rank's nodes."""
    mesh = model.mesh
    step = 2 if f.degree == 1 else 1  # vertices have even fine indices
    axes = _axes(mesh.dim, f)
    old = [with_middles(data.ticks[k], f.degree) for k in axes]
    new = [with_middles(mesh.vertex_ticks[k], f.degree) for k in axes]
    index = _places(model, f) // step
    first = index.min(axis=0, initial=np.iinfo(np.int64).max)
    last = index.max(axis=0, initial=-1)
    wanted = [line[a : b + 1] for line, a, b in zip(new, first, last, strict=True)]
    boxes = [_around(line, at) for line, at in zip(old, wanted, strict=True)]
    grid = _box(mesh.comm, f, data, [data.ticks[k] for k in axes],
                [step * np.arange(part.start, part.stop) for part in boxes])
    if not len(index):
        return np.zeros((0, f.components))
    for axis, (line, part, at) in enumerate(zip(old, boxes, wanted, strict=True)):
        # monotone: no new extrema, so no spurious contact or film between old nodes
        grid = PchipInterpolator(line[part], grid, axis=axis)(at)
    return grid[tuple((index - first).T)]


def _around(old: Array, new: Array) -> slice:
    """The old ticks that say what is at the new ones."""
    if not len(new):
        return slice(0, 0)
    first = int(np.searchsorted(old, new[0], side="right")) - 1 - MARGIN
    last = int(np.searchsorted(old, new[-1], side="left")) + MARGIN
    return slice(max(0, first), min(len(old), last + 1))


def _box(comm: Any, f: Field, data: Snapshot, ticks: list[Array], fine: list[Index]) -> Array:
    """Old values (*box, components) at fine indices along each axis. Collective."""
    ends = _ends(ticks)
    count = int(lattice.count(*ends, f.degree))
    block = data.rows[f.name]
    if comm.size > 1 and not data.shared:
        block = to_blocks(comm, np.arange(len(block)), block, count)
    grid = np.meshgrid(*fine, indexing="ij")
    index = np.stack([axis.ravel() for axis in grid], axis=1).astype(np.int64)
    rows = from_blocks(comm, block, count, lattice.numbers(index, *ends))
    return rows.reshape(*grid[0].shape, f.components)
