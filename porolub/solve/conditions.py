"""Essential conditions: those of the shape, replaced where the scene names a boundary."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.fem.constraints import ConstraintBuilder, Constraints
from porolub.fem.dofs import Dofs
from porolub.fem.domains import Domain
from porolub.scene.history import value_at

Array = NDArray[np.float64]
BASES = ("bone", "bottom")


def prescribed_values(scene: Any, mesh: Any, dofs: Dofs, scales: Any, lubricated: str | None,
                      t: float) -> Array:
    """The values (k,) of the constraints at time t (s), in the order of ``Constraints.fixed``."""
    return constraints_of(scene, mesh, dofs, scales, lubricated, t).values


def constraints_of(scene: Any, mesh: Any, dofs: Dofs, scales: Any, lubricated: str | None,
                   t: float = 0.0) -> Constraints:
    """Constraints in scaled units, with the values of time t (s).

    Raises SceneError for a boundary the mesh does not have.
    """
    symmetry = scene.geometry.symmetry
    for where, names in (("boundary.{}", scene.boundary), ('geometry.symmetry: "{}"', symmetry)):
        unknown = set(names) - set(mesh.boundary_names)
        if unknown:
            raise SceneError(f"{where.format(min(unknown))}: the mesh has no such boundary; it has "
                             f"{', '.join(sorted(mesh.boundary_names))}.")
    build = ConstraintBuilder(dofs)
    for name in mesh.boundary_names:
        condition = scene.boundary.get(name)
        if condition is not None:
            _given(build, condition, name, mesh, dofs, scales, t)
        elif "u" in dofs.fields and name != lubricated and name not in ("top", "lubricated"):
            if name in BASES and scene.solid.base == "bonded":
                for axis in np.eye(mesh.dim):
                    _fix(build, mesh, name, axis, 0.0)
            else:
                _fix_normal(build, mesh, dofs, name, 0.0)
    if scene.film is not None and lubricated is not None:
        _ambient_ends(build, mesh, dofs, lubricated, symmetry)
    return build.build()


def _given(build: ConstraintBuilder, condition: Any, name: str, mesh: Any, dofs: Dofs,
           scales: Any, t: float) -> None:
    displacement = condition.displacement
    if displacement is not None and "u" in dofs.fields:
        if displacement.normal is not None:
            normal = value_at(displacement.normal, t) / scales.length
            _fix_normal(build, mesh, dofs, name, normal)
        for k, axis in enumerate("xyz"[: mesh.dim]):
            value = getattr(displacement, axis)
            if value is not None:
                value = value_at(value, t) / scales.length
                _fix(build, mesh, name, np.eye(mesh.dim)[k], value)
    if condition.pressure is not None and "p" in dofs.fields:
        pressure = value_at(condition.pressure, t) / scales.pressure
        build.scalar("p", mesh.boundary_nodes(name), pressure)


def _fix(build: ConstraintBuilder, mesh: Any, name: str, axis: Array, value: float) -> None:
    nodes = mesh.boundary_nodes(name)
    build.direction(nodes, np.broadcast_to(axis, (len(nodes), mesh.dim)), value)


def _fix_normal(build: ConstraintBuilder, mesh: Any, dofs: Dofs, name: str, value: float) -> None:
    nodes = mesh.boundary_nodes(name)
    build.direction(nodes, nodal_normals(mesh, dofs, name)[nodes], value)


def nodal_normals(mesh: Any, dofs: Dofs, name: str) -> Array:
    """(nnode, dim) unit outward normals, averaged over the boundary's facets across ranks."""
    facets = Domain(f"facets:{name}", mesh, 3)
    local = np.zeros(dofs.size_local)
    base = dofs.entity_dofs("u", facets)
    values = facets.tables(mesh.degree).value[facets.variant]
    # squared weights keep corner nodes of quadratic triangles (zero mean basis) defined
    share = np.einsum("eq,eqi,eqd->eid", facets.weights, values**2, facets.normal)
    for d in range(mesh.dim):
        np.add.at(local, (base + d).ravel(), share[..., d].ravel())
    total = dofs.sum_local(local)
    normals = np.zeros((len(mesh.coordinates), mesh.dim))
    normals[dofs.nodes["u"]] = dofs.field("u", total)
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, size, out=np.zeros_like(normals), where=size > 0)


def _ambient_ends(build: ConstraintBuilder, mesh: Any, dofs: Dofs, lubricated: str,
                  symmetry: tuple[str, ...]) -> None:
    """The film meets the bath where its surface ends: p = 0 at the rim it shares with others.

    At a symmetry plane it does not end.
    """
    rim = np.zeros(0, dtype=np.int64)
    for name in mesh.boundary_names:
        if name not in (lubricated, *symmetry):
            shared = np.intersect1d(mesh.boundary_nodes(lubricated), mesh.boundary_nodes(name))
            rim = np.union1d(rim, shared)
    build.scalar("p", rim.astype(np.int64), 0.0)
