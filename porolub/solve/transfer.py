"""Carry a solution from one structured mesh to another through the shape's logical coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.interpolate import PchipInterpolator

from porolub.fem.dofs import Field
from porolub.solve.model import Model

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Snapshot:
    """Fields on tensor grids of logical coordinates, the same on every rank.

    grids: field -> (ticks per axis, values (*grid, components)); scalars: field -> value.
    Fields of the lubricated surface have no "across" axis (the second one).
    """

    grids: dict[str, tuple[tuple[Array, ...], Array]]
    scalars: dict[str, float]


def _axes(dim: int, support: str) -> list[int]:
    return [k for k in range(dim) if support == "body" or k != 1]


def _grid_places(model: Model, f: Field, places: Array
                 ) -> tuple[tuple[Array, ...], tuple[NDArray[np.int64], ...]]:
    """Ticks of the field's tensor grid and the index of each logical place (n, dim) in it."""
    mesh = model.mesh
    all_ticks = mesh.ticks() if f.degree == mesh.degree else mesh.vertex_ticks
    axes = _axes(mesh.dim, f.support)
    ticks = tuple(np.asarray(all_ticks[k]) for k in axes)
    index = tuple(np.searchsorted((t[1:] + t[:-1]) / 2, places[:, k])
                  for t, k in zip(ticks, axes, strict=True))
    return ticks, index


def snapshot(model: Model, x: PETSc.Vec) -> Snapshot:
    """Gather a solution. Collective."""
    mesh, dofs = model.mesh, model.dofs
    local = model.system.physical(dofs.to_local(x))
    grids, scalars = {}, {}
    for name, f in dofs.fields.items():
        if f.degree == 0:
            scalars[name] = dofs.scalar_value(name, x)
            continue
        nodes = dofs.nodes[name]
        mine = mesh.owned[nodes]
        places = mesh.logical(mesh.coordinates[nodes[mine]])
        values = dofs.field(name, local)[mine]
        places = np.vstack(mesh.comm.allgather(places))
        values = np.vstack(mesh.comm.allgather(values))
        ticks, index = _grid_places(model, f, places)
        grid = np.zeros((*map(len, ticks), f.components))
        grid[index] = values
        grids[name] = (ticks, grid)
    return Snapshot(grids, scalars)


def restore(model: Model, data: Snapshot) -> PETSc.Vec:
    """A global vector of ``model`` interpolated from the snapshot, essential conditions set."""
    mesh, dofs = model.mesh, model.dofs
    local = np.zeros(dofs.size_local)
    for name, f in dofs.fields.items():
        if f.degree == 0 or name not in data.grids:
            continue
        ticks, grid = data.grids[name]
        places = mesh.logical(mesh.coordinates[dofs.nodes[name]])
        wanted, index = _grid_places(model, f, places)
        for axis, (old, new) in enumerate(zip(ticks, wanted, strict=True)):
            # monotone: no new extrema, so no spurious contact or film between old nodes
            grid = PchipInterpolator(old, grid, axis=axis)(new)
        values = grid[index]
        local[dofs.range[name]] = values.ravel()
    local = model.system.stored(local)
    x = dofs.vector()
    x.array[:] = local[dofs.owned]
    for name, value in data.scalars.items():
        if name in dofs.fields:
            dofs.set_scalar(name, x, value)
    model.system.apply_conditions(x)
    return x
