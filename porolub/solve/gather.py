"""Fields and unknowns of a solved model as plain SI arrays, in blocks that no partition changes."""

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
from porolub.solve.natural import sorted_rows, to_blocks
from porolub.solve.profile import profile
from porolub.solve.report import FieldData, StateData, SurfaceData, SurfaceMap
from porolub.solve.surface_map import surface_map
from porolub.solve.surface_nodes import on_surface_nodes

Array = NDArray[np.float64]


def _blocks_of_nodes(mesh: Any, values: Array) -> Array:
    """This rank's block of nodal rows (nnode, k), in natural order."""
    return to_blocks(mesh.comm, mesh.natural_node[mesh.owned], values[mesh.owned],
                     mesh.global_node_count)


def nodal_average(d: Derived, domain: Domain, values: Array) -> Array:
    """(nnode, k) mean over the cells around each node of values (ncell, nn, k) at their nodes."""
    mesh = d.model.mesh
    k = values.shape[2]
    both = np.zeros((len(mesh.coordinates), k + 1))
    np.add.at(both, mesh.cells.ravel(),
              np.concatenate([values, np.ones((*values.shape[:2], 1))], axis=2).reshape(-1, k + 1))
    total = sum_at_nodes(mesh, both)
    return total[:, :k] / total[:, k:]


def gather_fields(model: Model, x: PETSc.Vec) -> FieldData:
    """This rank's block of the fields. Collective."""
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
    u = d.nodal("u") if "u" in model.dofs.fields else np.zeros_like(mesh.coordinates)
    pressure = pressure_everywhere(d) if "p" in model.dofs.fields else np.zeros((len(u), 1))
    table = _blocks_of_nodes(mesh, np.hstack([mesh.coordinates, u, pressure, mean]))
    connectivity = to_blocks(mesh.comm, mesh.natural_cell, mesh.natural_node[mesh.cells],
                             mesh.global_cell_count)
    dim = mesh.dim
    fluid = "p" in model.dofs.fields
    return FieldData(
        nodes=table[:, :dim] * s.length, cells=connectivity, cell_type=mesh.cell_type,
        degree=mesh.degree, displacement=table[:, dim:2 * dim] * s.length,
        pressure=table[:, 2 * dim] * s.pressure if fluid else None,
        jacobian=table[:, 2 * dim + 1], von_mises=table[:, 2 * dim + 2] * s.pressure,
        flux=table[:, 2 * dim + 3:] * s.speed if pores is not None else None)


def pressure_everywhere(d: Derived) -> Array:
    """(nnode, 1) pressure at all nodes of the mesh, interpolated where it has no unknown."""
    model = d.model
    field = model.dofs.fields["p"]
    if field.degree == model.mesh.degree:
        return d.nodal("p")
    if field.support != "body":
        return on_surface_nodes(d, d.nodal("p"))
    domain = model.cell_nodes
    return nodal_average(d, domain, d.at(domain).value("p")[..., None])


def gather_surface(model: Model, x: PETSc.Vec) -> SurfaceData | SurfaceMap | None:
    """The lubricated surface on rank 0: profiles along it in 2D, a map in 3D; None elsewhere and
    where there is no such surface. Collective."""
    if model.lubricated is None:
        return None
    d = Derived(model, x)
    return profile(d) if model.mesh.dim == 2 else surface_map(d)


def units_of(model: Model) -> dict[str, tuple[float, str]]:
    """SI size of the scaled unit of each unknown, and its name."""
    s = model.scales
    return {"u": (s.length, "m"), "p": (s.pressure, "Pa"), "l": (s.pressure, "Pa"),
            "v0": (s.length, "m"), "j": (1.0, "1"), "w": (s.speed, "m/s")}


def gather_state(model: Model, x: PETSc.Vec, time: float = 0.0) -> StateData:
    """This rank's block of all unknowns. Collective."""
    d, mesh = Derived(model, x), model.mesh
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
        fields[name] = sorted_rows(mesh.comm, mesh.natural_node[nodes[mine]],
                                   model.dofs.field(name, d.local)[mine] * scale,
                                   mesh.global_node_count)
    places = _blocks_of_nodes(mesh, mesh.coordinates) * model.scales.length
    return StateData(time, fields, units, places)
