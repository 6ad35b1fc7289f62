"""Terms by themselves: a system of a term and the fields it needs, states, vectors, an operation.

All numbers are scaled, as inside the terms.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.fem.constraints import Constraints
from porolub.fem.dofs import Dofs, Field
from porolub.fem.domains import Domain, NodalDomain
from porolub.fem.points import Points
from porolub.mesh import Mesh
from porolub.solve.system import System, contents_of, parts_of, union_of_fields
from porolub.terms.operation import Operation
from porolub.terms.plane import Plane
from porolub.terms.term import Part, Term
from tests.fem import meshes

Array = NDArray[np.float64]
WAVES = np.array([[1.3, 0.7, -0.5], [-0.6, 1.1, 0.9], [0.8, -0.4, 1.2]])  # of u, per component
SHIFTS = np.array([0.3, 1.1, 2.0])
STRAIN = np.array([[0.11, -0.07, 0.05], [0.04, -0.16, 0.08], [-0.06, 0.03, 0.09]])


def operation(kind: str = "rest", speed: float = 0.0, **others: object) -> Operation:
    """An operating point; the body turns about the centre of the curved meshes.

    Here is the only place where tests name the knobs of continuation.
    """
    settings: dict[str, object] = {"centre": (0.0, meshes.RADIUS, 0.0), "force": 0.8} | others
    return Operation(kind=kind, speed=speed, **settings)  # type: ignore[arg-type]


def plane_below(mesh: Mesh, boundary: str, at: Operation) -> Plane:
    """The rigid plane under an arc, or a slightly tilted one over a flat top."""
    m = np.array([0.0, -1.0, 0.0]) if boundary == "lubricated" else np.array([0.4, 1.0, 0.2])
    m = m[: mesh.dim] / np.linalg.norm(m[: mesh.dim])
    reach = (mesh.coordinates[mesh.boundary_nodes(boundary)] @ m).max()
    return Plane(tuple(m), float(reach), at)


@dataclass(frozen=True)
class Unknowns:
    """Adds fields and no equation."""

    added: tuple[Field, ...]
    name: str = "unknowns"

    def fields(self) -> list[Field]:
        return list(self.added)

    def reads(self) -> list[str]:
        return []

    def parts(self) -> list[Part]:
        return []


def every_field(mesh: Mesh, boundary: str, pressure_degree: int = 1) -> dict[str, Field]:
    fields = [Field("u", mesh.dim, mesh.degree, differential=True),
              Field("p", 1, pressure_degree, differential=True),
              Field("l", 1, mesh.degree, support=boundary), Field("v0", 1, 0)]
    return {f.name: f for f in fields}


def unconstrained(dim: int) -> Constraints:
    none = np.zeros(0, dtype=np.int64)
    return Constraints(none, np.zeros(0), none, np.zeros((0, dim, dim)))


def nodal_domain(mesh: Mesh, boundary: str) -> NodalDomain:
    """Nodes with the integral of their basis function as weight, normal as the facets have it."""
    facets = Domain(f"facets:{boundary}", mesh, 4)
    table = facets.tables(mesh.degree).value[facets.variant]
    weight, normal = np.zeros(len(mesh.coordinates)), np.zeros((len(mesh.coordinates), mesh.dim))
    cells = mesh.cells[facets.cells]
    np.add.at(weight, cells, np.einsum("eq,eqi->ei", facets.weights, table))
    np.add.at(normal, cells, np.einsum("eq,eqi,eqd->eid", facets.weights, table**2, facets.normal))
    nodes = mesh.boundary_nodes(boundary)
    normal = normal[nodes] / np.linalg.norm(normal[nodes], axis=1, keepdims=True)
    return NodalDomain(f"nodes:{boundary}", mesh, nodes, weight[nodes], normal)


def system(mesh: Mesh, terms: Sequence[Term], fields: Sequence[str] = (), finite: bool = True,
           *, boundary: str = "", pressure_degree: int = 1, points: int = 3,
           constraints: Constraints | None = None) -> System:
    """The terms' system, with the further `fields` they need but none of them adds."""
    own = {f.name for term in terms for f in term.fields()}
    known = every_field(mesh, boundary, pressure_degree)
    extra = Unknowns(tuple(known[name] for name in fields if name not in own))
    dofs = Dofs(mesh, union_of_fields([extra, *terms]))
    domains = {}
    for name in {*parts_of(list(terms)), *contents_of(list(terms))}:
        kind, _, side = name.partition(":")
        domains[name] = nodal_domain(mesh, side) if kind == "nodes" else Domain(name, mesh, points)
    return System(dofs, list(terms), domains, constraints or unconstrained(mesh.dim), finite)


def smooth(dofs: Dofs, size: float = 0.05, v0: float = 0.1) -> Array:
    """A local, physical state that depends on the coordinates only; nothing in it vanishes."""
    local = np.zeros(dofs.size_local)
    X = dofs.mesh.coordinates
    for name, nodes in dofs.nodes.items():
        if name == "v0":
            local[dofs.range[name]] = v0
            continue
        phase = X[nodes] @ WAVES[:, : X.shape[1]].T
        values = {"u": size * np.sin(phase + SHIFTS),
                  "p": 0.3 + 0.2 * np.sin(phase + 0.5), "l": 0.3 * np.sin(2 * phase + 0.9)}
        others = 0.1 * np.sin(phase + 1.7)
        dofs.field(name, local)[...] = values.get(name, others)[:, : dofs.fields[name].components]
    return local


def vector(dofs: Dofs, local: Array) -> PETSc.Vec:
    """Global vector of a local array that is the same on every rank that shares a dof."""
    x = dofs.vector()
    x.array[:] = local[dofs.owned]
    return x


def field_values(dofs: Dofs, name: str, function: Callable[[Array], Array], local: Array) -> None:
    """Set a field to a function of the positions (n, dim)."""
    values = function(dofs.mesh.coordinates[dofs.nodes[name]])
    dofs.field(name, local)[...] = values.reshape(-1, dofs.fields[name].components)


def affine(of: System, pressure: Callable[[Array], Array] | None = None) -> tuple[Array, Array]:
    """u = A X and a pressure of the positions (0.2 by default), as a local state; also A."""
    dim = of.dofs.mesh.dim
    A, local = STRAIN[:dim, :dim], np.zeros(of.dofs.size_local)
    field_values(of.dofs, "u", lambda X: X @ A.T, local)
    if "p" in of.dofs.fields:
        field_values(of.dofs, "p", pressure or (lambda X: np.full(len(X), 0.2)), local)
    return local, A


def everywhere(of: System, name: str, local: Array) -> Points:
    """All points of one of the system's domains, in a local state."""
    domain = of.domains[name]
    return Points(domain, of.dofs, local, slice(0, len(domain)), of.finite)


def inner_nodes(mesh: Mesh) -> NDArray[np.bool_]:
    """(nnode,) True away from all boundaries."""
    inner = np.ones(len(mesh.coordinates), bool)
    for name in mesh.boundary_names:
        inner[mesh.boundary_nodes(name)] = False
    return inner


def dense_jacobian(of: System, local: Array) -> Array:
    """The matrix (size, size) at an unconstrained local state, rows and columns as in `local`."""
    x, matrix = vector(of.dofs, local), of.create_matrix()
    of.jacobian(x, matrix)
    numbers = of.dofs.global_numbers
    full = np.asarray(matrix[:, :])[np.ix_(numbers, numbers)]
    x.destroy()
    matrix.destroy()
    return full
