"""A scene on a mesh, ready to be solved: terms, domains, dofs and constraints put together."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.fem.dofs import Dofs, nodal_points, sum_at_nodes
from porolub.fem.domains import Domain, NodalDomain, nodal_shares
from porolub.solve.conditions import constraints_of
from porolub.solve.drive import operation_of
from porolub.solve.effects import Law, body_terms, solid_law, surface_terms
from porolub.solve.moving import ends_of_motion
from porolub.solve.scales import Scales
from porolub.solve.surface import Circle, LubricatedSurface, surface_circle
from porolub.solve.system import System, contents_of, parts_of, union_of_fields
from porolub.terms.operation import Operation
from porolub.terms.plane import Plane
from porolub.terms.term import Term

Array = NDArray[np.float64]
CELL_POINTS = {1: 2, 2: 3}  # Gauss points per direction by displacement degree
FACET_POINTS = 4  # h^3 p' q' with quadratic h is of degree 6: exact


def scales_of(scene: Any, thickness: float) -> Scales:
    """Scaled units of a scene whose layer is ``thickness`` m thick."""
    law = solid_law(scene, 1.0)
    pressure = law.constrained_modulus if law is not None else 1e5
    if scene.pores is not None:
        time = thickness**2 * scene.pores.viscosity / (pressure * scene.pores.permeability)
    elif scene.film is not None:
        time = scene.film.viscosity / pressure * 1e6  # film thickness of order d/100 conducts O(1)
    else:
        time = 1.0
    return Scales(thickness, pressure, time, scene.scene.dimension)


@dataclass
class Model:
    """Everything scaled by ``scales``; ``surface`` is None where nothing faces a plane."""

    scene: Any
    mesh: Any
    scales: Scales
    law: Law | None
    operation: Operation
    surface: LubricatedSurface | None
    dofs: Dofs
    system: System

    @cached_property
    def cell_nodes(self) -> Domain:
        """The nodes of every cell as its points; made once, when fields are first asked for."""
        return Domain("nodes of cells", self.mesh, 0)

    @property
    def plane(self) -> Plane | None:
        return None if self.surface is None else self.surface.plane

    @property
    def lubricated(self) -> str | None:
        """Name of the lubricated surface."""
        return None if self.surface is None else self.surface.name

    def destroy(self) -> None:
        self.dofs.destroy()


def lubricated_name(scene: Any) -> str | None:
    """The surface that faces the plane, or None when nothing happens there."""
    if scene.film is None and scene.contact is None:
        return None
    return {"block": "top"}.get(scene.geometry.shape, "lubricated")


def _plane(scene: Any, mesh: Any, boundary: str, operation: Operation) -> Plane:
    dim = mesh.dim
    default = [0.0] * dim
    default[1] = 1.0 if scene.geometry.shape == "block" else -1.0
    m = np.asarray(getattr(scene.geometry, "plane_normal", None) or default, dtype=float)
    if len(m) != dim:
        raise SceneError(f"geometry.plane_normal needs {dim} components, not {len(m)}.")
    m = m / np.linalg.norm(m)
    X = mesh.coordinates[mesh.boundary_nodes(boundary)]
    reach = float((X @ m).max()) if len(X) else -np.inf
    return Plane(tuple(m), mesh.comm.allreduce(reach, op=MPI.MAX), operation)


def lubricated_surface(scene: Any, mesh: Any, name: str, circle: Circle | None,
                       operation: Operation) -> LubricatedSurface:
    """The surface with its plane and measures. Raises SceneError if the mesh does not name it."""
    if name not in mesh.boundary_names:
        raise SceneError(f"The mesh has no boundary {name!r}; it has "
                         f"{', '.join(sorted(mesh.boundary_names))}.")
    domain = Domain(f"facets:{name}", mesh, FACET_POINTS)
    area = mesh.comm.allreduce(float(domain.weights.sum()))
    plane = _plane(scene, mesh, name, operation)
    return LubricatedSurface(name, plane, domain, area, _nodal_weights(mesh, domain), circle)


def build_model(scene: Any, mesh: Any, scales: Scales) -> Model:
    """Wire a scene to a mesh (already in units of ``scales.length``).

    Raises SceneError for boundaries the mesh does not have and contradicting conditions.
    """
    law = solid_law(scene, scales.pressure)
    name = lubricated_name(scene)
    circle = surface_circle(scene, mesh, name, scales.length)
    operation = operation_of(scene, scales, circle)
    surface = None
    if name is not None:
        surface = lubricated_surface(scene, mesh, name, circle, operation)
    ends = ends_of_motion(scene, mesh, operation)
    terms = body_terms(scene, law, scales, operation, ends)
    if surface is not None:
        terms += surface_terms(scene, law, scales, operation, surface)
    if not terms:
        raise SceneError("The scene asks for nothing: give at least [solid] or [film].")
    dofs = Dofs(mesh, union_of_fields(terms))
    constraints = constraints_of(scene, mesh, dofs, scales, name)
    domains = _domains(terms, mesh, surface, scene.mesh.degree)
    system = System(dofs, terms, domains, constraints, law is not None and law.finite)
    return Model(scene, mesh, scales, law, operation, surface, dofs, system)


def _domains(terms: list[Term], mesh: Any, surface: LubricatedSurface | None,
             degree: int) -> dict[str, Domain]:
    """A domain for every name the terms' integrals use."""
    domains: dict[str, Domain] = {}
    for name in sorted({*parts_of(terms), *contents_of(terms)}):
        if surface is not None and name == surface.domain.name:
            domains[name] = surface.domain
        elif surface is not None and name.startswith("nodes:"):
            domains[name] = _nodal_domain(name, mesh, surface)
        else:
            domains[name] = Domain(name, mesh, CELL_POINTS[degree])
    return domains


def _nodal_weights(mesh: Any, surface: Domain) -> Array:
    """(nnode,) weights of nodal quadrature on the surface, summed over ranks."""
    weights = np.zeros((len(mesh.coordinates), 1))
    np.add.at(weights[:, 0], mesh.cells[surface.cells].ravel(), nodal_shares(surface).ravel())
    return sum_at_nodes(mesh, weights)[:, 0]


def _nodal_domain(name: str, mesh: Any, surface: LubricatedSurface) -> NodalDomain:
    nodes = nodal_points(mesh, surface.name)
    nodes = nodes[mesh.owned[nodes]]
    normal = np.broadcast_to(np.asarray(surface.plane.toward), (len(nodes), mesh.dim))
    return NodalDomain(name, mesh, nodes, surface.weights[nodes], normal)
