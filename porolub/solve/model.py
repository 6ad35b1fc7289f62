"""From a scene and a mesh to the terms, domains and constraints of a system.

The one place that knows which section of a scene asks for which term.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.fem.dofs import Dofs
from porolub.fem.domains import Domain, NodalDomain
from porolub.laws.lubricant import Newtonian
from porolub.laws.solid import LinearElastic, NeoHookean
from porolub.solve.conditions import constraints_of
from porolub.solve.scales import Scales
from porolub.solve.surface import Circle, surface_circle
from porolub.solve.system import System, union_of_fields
from porolub.terms.carry import Carry
from porolub.terms.contact import Contact
from porolub.terms.drainage import Drainage
from porolub.terms.film import Film
from porolub.terms.load import LoadBalance
from porolub.terms.operation import Operation
from porolub.terms.plane import Plane
from porolub.terms.pores import Pores
from porolub.terms.skeleton import Skeleton
from porolub.terms.squeeze import Squeeze
from porolub.terms.storage import Storage
from porolub.terms.streamline import Streamline
from porolub.terms.surface_pressure import SurfacePressure
from porolub.terms.term import Term
from porolub.terms.traction import Traction

Array = NDArray[np.float64]
OPEN_SURFACE_CONDUCTANCE = 1e8  # in units of the layer's own, so p = 0 there to 1e-8
CELL_POINTS = {1: 2, 2: 3}  # Gauss points per direction by displacement degree
FACET_POINTS = 4  # h^3 p' q' with quadratic h is of degree 6: exact


def solid_law(scene: Any, pressure: float) -> LinearElastic | NeoHookean | None:
    """Skeleton law with moduli in units of ``pressure``; the paper's a, 1 - a weighting with pores."""
    solid = scene.solid
    if solid is None:
        return None
    shear, bulk = solid.shear_modulus / pressure, solid.bulk_modulus / pressure
    if solid.law == "linear":
        return LinearElastic(shear, bulk)
    if scene.pores is None:
        return NeoHookean(shear, bulk)
    a = scene.pores.biot
    return NeoHookean(a * shear, (1.0 - a) * bulk)


def scales_of(scene: Any, thickness: float) -> Scales:
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
    """A scene on a mesh, ready to be solved; everything scaled by ``scales``."""

    scene: Any
    mesh: Any
    scales: Scales
    law: LinearElastic | NeoHookean | None
    operation: Operation
    plane: Plane | None
    dofs: Dofs
    system: System
    lubricated: str | None
    nodal_weights: Array  # (nnode,) integral of the displacement basis over the surface
    circle: Circle | None  # the circle the lubricated surface lies on, if any

    def destroy(self) -> None:
        self.dofs.destroy()


def lubricated_name(scene: Any) -> str | None:
    """The surface that faces the plane, or None when nothing happens there."""
    if scene.film is None and scene.contact is None:
        return None
    return {"block": "top"}.get(scene.geometry.shape, "lubricated")


def _operation(scene: Any, scales: Scales, circle: Circle | None) -> Operation:
    op = Operation(centre=(0.0,) * scales.dim)
    if scene.motion is not None:
        speed = scene.motion.at(0.0)
        if scene.motion.kind == "rotation":
            if circle is None:
                raise SceneError('motion.kind = "rotation": the lubricated surface of this mesh is '
                                 "no circular arc, so there is no centre to turn about.")
            centre = [*circle.centre, 0.0][: scales.dim]
            op = Operation("rotation", speed * scales.time, tuple(centre))
        else:
            axis = {"x": 0, "z": 2}[getattr(scene.motion, "direction", "x")]
            direction = tuple(float(k == axis) for k in range(scales.dim))
            op = Operation("sliding", speed / scales.speed, (0.0,) * scales.dim, direction)
    if scene.load is not None:
        if scene.load.force is not None:
            op.force = scene.load.at(0.0) / scales.force
        else:
            op.approach = scene.load.at(0.0) / scales.length
    return op


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
    from mpi4py import MPI

    return Plane(tuple(m), mesh.comm.allreduce(reach, op=MPI.MAX), operation)


def build_terms(scene: Any, mesh: Any, law, scales: Scales, operation: Operation,
                plane: Plane | None, boundary: str | None, area: float) -> list[Term]:
    """The terms the scene asks for, and no other."""
    m, terms = scene.mesh, []
    spatial = scene.conventions.frame == "spatial"
    force = operation.force is not None
    displacement = law is not None
    stiffness = 1.0  # contact stiffness c: one modulus per thickness
    if displacement:
        terms.append(Skeleton(law, mesh.dim, m.degree))
    mobility = 0.0
    if scene.pores is not None:
        a = scene.pores.biot
        mobility = scene.pores.permeability / scene.pores.viscosity / scales.mobility
        terms.append(Pores(a, mobility, spatial, m.pressure_degree))
        storage = scene.pores.storage * scales.pressure
        terms.append(Storage(a, storage, operation))
        if scene.pores.carry:
            ends = tuple(e for e in ("inlet", "outlet") if e in mesh.boundary_names)
            terms.append(Carry(a, operation, ends, scene.conventions.entering == "fresh"))
            capacity = a**2 / law.constrained_modulus
            terms.append(Streamline(a, capacity, mobility, operation, m.pressure_degree))
    if boundary is not None and displacement and (scene.pores is not None or scene.film is not None):
        balanced = scene.conventions.surface_traction == "balanced" or scene.pores is None
        share = 1.0 if balanced else scene.pores.biot
        terms.append(SurfacePressure(share, spatial, boundary))
    if scene.film is not None:
        lubricant = Newtonian(scene.film.viscosity / scales.viscosity,
                              scene.film.shear_film_min / scales.length)
        terms.append(Film(lubricant, plane, operation, boundary, displacement, force,
                          m.pressure_degree, alone=scene.pores is None,
                          upwind=(law.constrained_modulus, mobility) if displacement else None))
        terms.append(Squeeze(plane, operation, boundary, displacement, force))
    if scene.contact is not None:
        friction = scene.contact.friction if scene.contact.friction_traction else 0.0
        terms.append(Contact(plane, operation, boundary, stiffness, friction, force, m.degree))
        if scene.film is None and scene.pores is not None:
            terms.append(Drainage(OPEN_SURFACE_CONDUCTANCE, plane, stiffness, boundary))
    if force:
        fluid = scene.pores is not None or scene.film is not None
        terms.append(LoadBalance(operation, boundary, area, scene.contact is not None, fluid))
    for name, condition in scene.boundary.items():
        if condition.traction is not None:
            terms.append(_traction(name, condition.traction, mesh.dim, scales.pressure))
    return terms


def _traction(name: str, value: Any, dim: int, pressure: float) -> Traction:
    if isinstance(value, (int, float)):
        return Traction(name, value / pressure, (0.0,) * dim)
    parts = [getattr(value, k, None) or 0.0 for k in "xyz"[:dim]]
    return Traction(name, 0.0, tuple(p / pressure for p in parts))


def build_model(scene: Any, mesh: Any, scales: Scales) -> Model:
    """Wire a scene to a mesh (already in units of ``scales.length``)."""
    law = solid_law(scene, scales.pressure)
    boundary = lubricated_name(scene)
    if boundary is not None and boundary not in mesh.boundary_names:
        raise SceneError(f"The mesh has no boundary {boundary!r}; it has "
                         f"{', '.join(sorted(mesh.boundary_names))}.")
    circle = surface_circle(scene, mesh, boundary, scales.length)
    operation = _operation(scene, scales, circle)
    plane = _plane(scene, mesh, boundary, operation) if boundary else None
    area, surface = 0.0, None
    if boundary:
        surface = Domain(f"facets:{boundary}", mesh, FACET_POINTS)
        area = mesh.comm.allreduce(float(surface.weights.sum()))
    terms = build_terms(scene, mesh, law, scales, operation, plane, boundary, area)
    if not terms:
        raise SceneError("The scene asks for nothing: give at least [solid] or [film].")
    dofs = Dofs(mesh, union_of_fields(terms))
    names = {p.domain for t in terms for p in t.parts()}
    weights = _nodal_weights(mesh, surface) if surface is not None else np.zeros(0)
    domains = {}
    for name in sorted(names):
        if name.startswith("nodes:"):
            domains[name] = _nodal_domain(name, mesh, boundary, weights, plane)
        elif surface is not None and name == surface.name:
            domains[name] = surface
        else:
            domains[name] = Domain(name, mesh, CELL_POINTS[scene.mesh.degree])
    constraints = constraints_of(scene, mesh, dofs, scales, boundary)
    system = System(dofs, terms, domains, constraints, law is not None and law.finite)
    return Model(scene, mesh, scales, law, operation, plane, dofs, system, boundary, weights,
                 circle)


def _nodal_weights(mesh: Any, surface: Domain) -> Array:
    """(nnode,) integral over the surface of each node's basis function, summed over ranks."""
    from porolub.fem.dofs import Field

    node = Dofs(mesh, [Field("w", 1, mesh.degree)])
    local = np.zeros(node.size_local)
    values = surface.tables(mesh.degree).value[surface.variant]
    shares = np.einsum("eq,eqi->ei", surface.weights, values)
    np.add.at(local, node.entity_dofs("w", surface).ravel(), shares.ravel())
    total = node.sum_local(local)
    weights = np.zeros(len(mesh.coordinates))
    weights[node.nodes["w"]] = total
    node.destroy()
    return weights


def _nodal_domain(name: str, mesh: Any, boundary: str, weights: Array, plane: Plane) -> NodalDomain:
    nodes = mesh.boundary_nodes(boundary)
    nodes = nodes[mesh.owned[nodes]]
    normal = np.broadcast_to(np.asarray(plane.toward), (len(nodes), mesh.dim))
    return NodalDomain(name, mesh, nodes, weights[nodes], normal)
