"""A linear biphasic block moving along x under a load on its top, built from terms.

A scene can only carry its fluid by rotation; here Skeleton, Pores, Carry and Streamline work
with a uniform velocity, the case that has a closed form (``travelling_wave``).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.fem.constraints import ConstraintBuilder, Constraints
from porolub.fem.dofs import Dofs, Field
from porolub.fem.domains import Domain
from porolub.fem.points import VALUE, Integrand, Points
from porolub.laws.solid import LinearElastic
from porolub.mesh import build_mesh
from porolub.scene import scene_from_dict
from porolub.solve.newton import Clock, Newton
from porolub.solve.options import set_options
from porolub.solve.system import System, union_of_fields
from porolub.terms.carry import Carry
from porolub.terms.operation import Operation
from porolub.terms.pores import Pores
from porolub.terms.skeleton import Skeleton
from porolub.terms.streamline import Streamline
from porolub.terms.term import Part, Term
from tests.physics.travelling_wave import Layer

Array = NDArray[np.float64]
Exact = Callable[[Array, Array], tuple[Array, Array, Array]]  # x, y -> ux, uy, p
POINTS = 5  # Gauss points per direction of the error norms


class Moving(Operation):
    """A body that moves along x with ``speed`` everywhere."""

    def body_velocity(self, X: Array) -> Array:
        v = np.zeros_like(X)
        v[..., 0] = self.speed
        return v


@dataclass(frozen=True)
class Load:
    """Total traction -pressure(x) normal to the top."""

    pressure: Callable[[Array], Array]
    name: str = "load on top"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u"]

    def parts(self) -> list[Part]:
        return [Part("facets:top", self.apply)]

    def apply(self, at: Points, out: Integrand) -> None:
        size = self.pressure(at.position[..., 0])
        out.residual("u", VALUE, size[..., None] * at.normal)


class MovingLayer:
    """The block [-width/2, width/2] x [0, 1] with `elements` per thickness, solved at once.

    pressure: the load on top, of x, in moduli; small, as J must stay positive.
    exact: values prescribed on the sides left and right, or None: sliding walls without Darcy
    flux, fresh material coming in.
    sealed: half-width about x = 0 within which the top of a drained layer is closed.
    """

    def __init__(self, layer: Layer, width: float, elements: int,
                 pressure: Callable[[Array], Array], exact: Exact | None = None,
                 stabilised: bool = True, sealed: float = 0.0) -> None:
        self.layer, self.exact, self.sealed = layer, exact, sealed
        scene = scene_from_dict({
            "geometry": {"shape": "block", "width": f"{width} m", "thickness": "1 m"},
            "mesh": {"along": round(width * elements), "across": elements},
            "solid": {"law": "linear", "young_modulus": "1 Pa", "poisson_ratio": 0.1}})
        self.mesh = build_mesh(scene, MPI.COMM_SELF)
        moving = Moving(speed=layer.speed)
        law = LinearElastic(layer.shear, layer.modulus - 4.0 / 3.0 * layer.shear)
        terms: list[Term] = [
            Skeleton(law, 2, 2),
            Pores(layer.biot, layer.mobility, False, 1),
            Carry(layer.biot, moving, ("left", "right"), fresh=exact is None),
            Load(pressure),
        ]
        if stabilised:
            capacity = layer.biot**2 / layer.modulus
            terms.append(Streamline(layer.biot, capacity, layer.mobility, moving, 1))
        self.dofs = Dofs(self.mesh, union_of_fields(terms))
        domains = {name: Domain(name, self.mesh, 5)
                   for name in ("cells", "facets:left", "facets:right", "facets:top")}
        self.system = System(self.dofs, terms, domains, self._constraints(), False)
        set_options("")
        newton = Newton(self.system, Clock())
        newton.limits = dict.fromkeys(newton.limits, np.inf)
        x = self.dofs.vector()
        result = newton.solve(x, max_iterations=3)
        assert result.converged, result.why
        self.local = self.dofs.to_local(x)
        newton.destroy()
        x.destroy()

    def _constraints(self) -> Constraints:
        build, mesh = ConstraintBuilder(self.dofs), self.mesh
        axes = np.eye(2)
        walls = np.union1d(mesh.boundary_nodes("left"), mesh.boundary_nodes("right"))
        for n in walls:
            node, where = np.array([n]), mesh.coordinates[n]
            values = (0.0,)
            if self.exact is not None:
                values = tuple(float(v[0]) for v in self.exact(where[:1], where[1:]))
                build.scalar("p", node, values[2])
            for axis, value in zip(axes, values, strict=False):
                build.direction(node, axis[None], value)
        base = mesh.boundary_nodes("bottom")
        if self.exact is not None:
            base = np.setdiff1d(base, walls)
        for axis in axes:
            build.direction(base, np.broadcast_to(axis, (len(base), 2)), 0.0)
        if self.layer.drained:
            top = mesh.boundary_nodes("top")
            build.scalar("p", top[np.abs(mesh.coordinates[top, 0]) >= self.sealed - 1e-9], 0.0)
        return build.build()

    def errors(self, exact: Exact) -> tuple[float, float]:
        """Relative L2 errors of u and p over the block."""
        at = Points(Domain("cells", self.mesh, POINTS), self.dofs, self.local, slice(None), False)
        ux, uy, p = exact(at.position[..., 0], at.position[..., 1])
        u = np.stack([ux, uy], axis=-1)

        def relative(found: Array, wanted: Array) -> float:
            return float(np.sqrt((at.weights * (found - wanted) ** 2).sum()
                                 / (at.weights * wanted**2).sum()))

        return (relative(np.moveaxis(at.value("u"), -1, 0), np.moveaxis(u, -1, 0)),
                relative(at.value("p"), p))

    def line(self, name: str, boundary: str) -> tuple[Array, Array]:
        """x (n,) and nodal values (n, components) along a boundary, sorted by x."""
        nodes = np.intersect1d(self.mesh.boundary_nodes(boundary), self.dofs.nodes[name])
        x = self.mesh.coordinates[nodes, 0]
        order = np.argsort(x)
        f = self.dofs.fields[name]
        rows = self.dofs.base[name][nodes[order], None] + np.arange(f.components)
        return x[order], self.local[rows]
