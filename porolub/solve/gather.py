"""Fields and surface profiles of a solved model as plain SI arrays on rank 0."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.fem.dofs import sum_at_nodes
from porolub.fem.domains import Domain
from porolub.laws.solid import von_mises_stress
from porolub.solve.derived import Derived
from porolub.solve.model import Model
from porolub.solve.report import FieldData, StateData, SurfaceData

Array = NDArray[np.float64]


def _to_root(mesh: Any, nodes: NDArray[np.int64], count: int, values: Array) -> Array | None:
    """Owned nodal rows (nnode, k) collected in natural order on rank 0."""
    mine = nodes[mesh.owned[nodes]]
    parts = mesh.comm.gather((mesh.natural_node[mine], values[mine]), root=0)
    if parts is None:
        return None
    out = np.zeros((count, *values.shape[1:]))
    for index, rows in parts:
        out[index] = rows
    return out


def nodal_average(d: Derived, domain: Domain, values: Array) -> Array:
    """(nnode, k) mean over the cells around each node of values (ncell, nn, k) at their nodes."""
    mesh = d.model.mesh
    k = values.shape[2]
    both = np.zeros((len(mesh.coordinates), k + 1))
    np.add.at(both, mesh.cells.ravel(),
              np.concatenate([values, np.ones((*values.shape[:2], 1))], axis=2).reshape(-1, k + 1))
    total = sum_at_nodes(mesh, both)
    return total[:, :k] / total[:, k:]


def gather_fields(model: Model, x: PETSc.Vec) -> FieldData | None:
    """FieldData on rank 0, None elsewhere. Collective."""
    mesh, s = model.mesh, model.scales
    d = Derived(model, x)
    domain = model.cell_nodes
    at = d.at(domain)
    J = at.deformation.J
    with np.errstate(divide="ignore", invalid="ignore"):  # J at nodes may fall below 0 in a crush
        stress = (np.zeros_like(J) if model.law is None
                  else von_mises_stress(model.law, at.deformation))
    columns = [J[..., None], stress[..., None]]
    pores = model.scene.pores
    if pores is not None:
        mobility = pores.permeability / pores.viscosity / s.mobility
        g = at.grad("p")
        if model.scene.conventions.frame == "spatial":
            g = np.einsum("...ki,...i->...k", at.deformation.inverse_transposed, g)
        columns.append(-mobility * g)
    mean = nodal_average(d, domain, np.concatenate(columns, axis=2))
    everything = np.arange(len(mesh.coordinates))
    u = d.nodal("u") if "u" in model.dofs.fields else np.zeros_like(mesh.coordinates)
    pressure = _pressure_everywhere(d) if "p" in model.dofs.fields else np.zeros((len(u), 1))
    count = mesh.global_node_count
    table = _to_root(mesh, everything, count,
                     np.hstack([mesh.coordinates, u, pressure, mean]))
    cells = mesh.comm.gather((mesh.natural_cell, mesh.natural_node[mesh.cells]), root=0)
    if table is None:
        return None
    connectivity = np.zeros((sum(len(c[0]) for c in cells), mesh.cells.shape[1]), dtype=np.int64)
    for index, rows in cells:
        connectivity[index] = rows
    dim = mesh.dim
    fluid = "p" in model.dofs.fields
    return FieldData(
        nodes=table[:, :dim] * s.length, cells=connectivity, cell_type=mesh.cell_type,
        degree=mesh.degree, displacement=table[:, dim:2 * dim] * s.length,
        pressure=table[:, 2 * dim] * s.pressure if fluid else None,
        jacobian=table[:, 2 * dim + 1], von_mises=table[:, 2 * dim + 2] * s.pressure,
        flux=table[:, 2 * dim + 3:] * s.speed if pores is not None else None)


def _pressure_everywhere(d: Derived) -> Array:
    """(nnode, 1) pressure at all nodes of the mesh, interpolated where it has no unknown."""
    model = d.model
    field = model.dofs.fields["p"]
    if field.degree == model.mesh.degree:
        return d.nodal("p")
    if field.support != "body":
        return on_surface_nodes(d, d.nodal("p"))
    domain = model.cell_nodes
    return nodal_average(d, domain, d.at(domain).value("p")[..., None])


def on_surface_nodes(d: Derived, vertex_values: Array) -> Array:
    """(nnode, k) values given at the surface's vertices, interpolated to its other nodes."""
    mesh = d.model.mesh
    nodes = mesh.facets(d.model.lubricated).nodes
    out = vertex_values.copy()
    if mesh.degree == 1:
        return out
    corners = 2 if mesh.dim == 2 else (4 if mesh.cell_type == "hex" else 3)
    around = nodes[:, :corners]
    for k in range(corners if mesh.dim == 3 else 1):
        pair = around[:, [k, (k + 1) % corners]]
        out[nodes[:, corners + k]] = vertex_values[pair].mean(axis=1)
    if mesh.dim == 3 and mesh.cell_type == "hex":
        out[nodes[:, 8]] = vertex_values[around].mean(axis=1)
    return _complete(d, nodes, out)


def _complete(d: Derived, nodes: NDArray[np.int64], values: Array) -> Array:
    """Let ranks that own a surface node but none of its facets know its value."""
    mesh = d.model.mesh
    k = values.shape[1]
    known = np.zeros((len(values), k + 1))
    seen = np.unique(nodes)
    known[seen, :k], known[seen, k] = values[seen], 1.0
    total = sum_at_nodes(mesh, known)
    return total[:, :k] / np.maximum(total[:, k:], 1.0)


def gather_surface(model: Model, x: PETSc.Vec) -> SurfaceData | None:
    """Profiles along the lubricated surface on rank 0. Collective."""
    if model.lubricated is None:
        return None
    d, mesh, s = Derived(model, x), model.mesh, model.scales
    n = len(mesh.coordinates)
    columns = np.zeros((n, 7))
    columns[:, 0], columns[:, 1] = d.arc() * s.length, mesh.coordinates[:, 0] * s.length
    if "p" in model.dofs.fields:
        pair = np.column_stack([d.nodal("p")[:, 0], d.exchange()])
        pair = on_surface_nodes(d, pair) if model.dofs.fields["p"].degree < mesh.degree else pair
        columns[:, 2], columns[:, 6] = pair[:, 0] * s.pressure, pair[:, 1] * s.speed
    if "l" in model.dofs.fields:
        columns[:, 3] = d.contact_pressure() * s.pressure
    columns[:, 4] = d.thickness() * s.length
    if d.film is not None:
        columns[:, 5] = _film_rows(d) * s.volume_flow / s.length ** (mesh.dim - 2)
    table = _to_root(mesh, d.nodes, mesh.global_node_count, columns)
    wanted = mesh.comm.gather(mesh.natural_node[d.mine], root=0)
    corners = mesh.comm.gather(mesh.natural_node[d.mine[_carries_pressure(d)]], root=0)
    if table is None:
        return None
    if d.film is not None:
        _rows_to_flux(table, np.unique(np.concatenate(corners)))
    rows = table[np.unique(np.concatenate(wanted))]
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    return SurfaceData(*rows.T)


def _carries_pressure(d: Derived) -> NDArray[np.bool_]:
    return np.isin(d.mine, d.model.dofs.nodes["p"] if "p" in d.model.dofs.fields else [])


def _film_rows(d: Derived) -> Array:
    """(nnode,) the film's share of the fluid mass rows, summed over ranks (scaled)."""
    model = d.model
    out = np.zeros(len(model.mesh.coordinates))
    r = model.dofs.sum_local(model.system.local_residual(d.local, {"film"}))
    nodes = np.intersect1d(d.nodes, model.dofs.nodes["p"])
    out[nodes] = r[model.dofs.base["p"][nodes]]
    return out


def _rows_to_flux(table: Array, corners: NDArray[np.int64]) -> None:
    """Turn column 5 from film rows into film flux, in place (one profile along s).

    Row i of a linear film is Q right of node i minus Q left of it, so the running sum is the
    conservative mean flux of each element: what the scheme itself transports.
    """
    order = corners[np.argsort(table[corners, 0], kind="stable")]
    flux = np.cumsum(table[order, 5])[:-1]  # mean flux between neighbouring pressure nodes
    s = table[order, 0]
    centres = (s[1:] + s[:-1]) / 2.0
    table[:, 5] = np.interp(table[:, 0], centres, flux)



def units_of(model: Model) -> dict[str, tuple[float, str]]:
    """SI size of the scaled unit of each unknown, and its name."""
    s = model.scales
    return {"u": (s.length, "m"), "p": (s.pressure, "Pa"), "l": (s.pressure, "Pa"),
            "v0": (s.length, "m"), "j": (1.0, "1"), "w": (s.speed, "m/s")}


def gather_state(model: Model, x: PETSc.Vec, time: float = 0.0) -> StateData | None:
    """All unknowns on rank 0 in natural order, None elsewhere. Collective."""
    d, mesh, s = Derived(model, x), model.mesh, model.scales
    size = units_of(model)
    fields, units = {}, {}
    for name, f in model.dofs.fields.items():
        scale, units[name] = size[name]
        if f.degree == 0:
            value = model.dofs.scalar_value(name, x)
            fields[name] = (np.zeros(0, dtype=np.int64), np.array([[value * scale]]))
            continue
        nodes = model.dofs.nodes[name]
        mine = mesh.owned[nodes]
        part = (mesh.natural_node[nodes[mine]], model.dofs.field(name, d.local)[mine] * scale)
        parts = mesh.comm.gather(part, root=0)
        if parts is not None:
            numbers = np.concatenate([p[0] for p in parts])
            order = np.argsort(numbers)
            fields[name] = (numbers[order], np.vstack([p[1] for p in parts])[order])
    places = _to_root(mesh, np.arange(len(mesh.coordinates)), mesh.global_node_count,
                      mesh.coordinates)
    return None if places is None else StateData(time, fields, units, places * s.length)
