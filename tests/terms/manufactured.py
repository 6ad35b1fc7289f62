"""A coupled finite-strain solution by choice: its sources, tractions and fluxes, and a solver.

u_i = 0.2 sin(k_i . X + c_i), p = 0.3 + 0.2 cos(k . X + c).  The strong form

    rho_s w / dt - Div P(F) + a B grad p = f,    w = u / dt,
    - Div(r K grad p) + Div(r (e + a (J - 1)) v) + m / dt = s,  m = r (e + a (J - 1) + S_s p) - e

(B = cof F, K = (kappa/eta) J C^-1 in the spatial frame, r = exp(chi p), S = e chi + S_s, a step
from rest) is differentiated by complex steps, so it shares no line with the weak form of the
terms.  Boundary conditions: u given but on the
lubricated surface, where the total traction (P - a p B) N acts; p given but at the ends, where
the flux K grad p . N enters.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.fem.constraints import Constraints
from porolub.fem.dofs import Dofs, Field
from porolub.fem.points import VALUE, Integrand, Points
from porolub.solve.system import System
from porolub.terms.operation import Operation
from porolub.terms.term import Part
from tests.terms.support import SHIFTS, WAVES, field_values, vector

Array = NDArray[np.float64]
CHOSEN = ("u", "p", "w")  # fields the exact solution gives
STEP = 1e-30  # of the complex step: no cancellation, so as small as we like


@dataclass(frozen=True)
class Exact:
    """The chosen solution and what it asks of the equations; X is (..., dim), also complex."""

    shear: float
    bulk: float
    biot: float
    mobility: float
    storage: float
    spatial: bool
    operation: Operation
    rate: float = 0.0  # 1 / time step, from an undeformed state
    density: float = 0.0  # of the skeleton
    compressibility: float = 0.0
    porosity: float = 0.0
    size: float = 0.2
    swing: float = 0.2  # of the pressure

    def u(self, X):
        dim = X.shape[-1]
        return self.size * np.sin(X @ WAVES[:dim, :dim].T + SHIFTS[:dim])

    def p(self, X):
        return 0.3 + self.swing * np.cos(X @ WAVES[2, : X.shape[-1]] + 0.4)

    def w(self, X):
        return self.rate * self.u(X)

    def ratio(self, X):
        """r = rho / rho_0."""
        return np.exp(self.compressibility * self.p(X))

    def grad_p(self, X):
        k = WAVES[2, : X.shape[-1]]
        return -self.swing * np.sin(X @ k + 0.4)[..., None] * k

    def deformation(self, X):
        """F, J and cof F."""
        dim = X.shape[-1]
        k = WAVES[:dim, :dim]
        F = np.eye(dim) + self.size * np.cos(X @ k.T + SHIFTS[:dim])[..., None] * k
        J = np.linalg.det(F)
        return F, J, J[..., None, None] * np.swapaxes(np.linalg.inv(F), -1, -2)

    def stress(self, X):
        """P = G J^(-2/3) (F - I1/3 F^-T) + K (J - 1) cof F."""
        F, J, cof = self.deformation(X)
        invariant = (F * F).sum(axis=(-2, -1)) + (3 - X.shape[-1])
        isochoric = F - (invariant / (3 * J))[..., None, None] * cof
        return (self.shear * (J ** (-2 / 3))[..., None, None] * isochoric
                + (self.bulk * (J - 1))[..., None, None] * cof)

    def coupling(self, X):
        """B."""
        return self.deformation(X)[2] if self.spatial else np.broadcast_to(
            np.eye(X.shape[-1]), (*X.shape, X.shape[-1]))

    def flow(self, X):
        """r K grad p."""
        g = self.mobility * self.ratio(X)[..., None] * self.grad_p(X)
        if not self.spatial:
            return g
        _, J, cof = self.deformation(X)
        return np.einsum("...ij,...ik,...k->...j", cof, cof, g) / J[..., None]

    def divergence(self, flux, X):
        """Sum over the last axis of d flux_j / d X_j."""
        total = 0.0
        for j, axis in enumerate(np.eye(X.shape[-1])):
            total = total + flux(X + 1j * STEP * axis)[..., j].imag / STEP
        return total

    def body_force(self, X):
        drag = self.biot * np.einsum("...ij,...j->...i", self.coupling(X), self.grad_p(X))
        return self.density * self.rate * self.w(X) + drag - self.divergence(self.stress, X)

    def pore_fluid(self, X):
        """r (e + a (J - 1))."""
        volume = self.porosity + self.biot * (self.deformation(X)[1] - 1)
        return self.ratio(X) * volume

    def source(self, X):
        v = self.operation.body_velocity(X)
        carried = self.divergence(lambda Z: self.pore_fluid(Z)[..., None] * v, X)
        grains = self.storage - self.porosity * self.compressibility
        content = self.pore_fluid(X) - self.porosity + self.ratio(X) * grains * self.p(X)
        return carried - self.divergence(self.flow, X) + self.rate * content

    def traction(self, X, N):
        """Total traction (P - a p B) N."""
        total = self.stress(X) - self.biot * self.p(X)[..., None, None] * self.coupling(X)
        return np.einsum("...ij,...j->...i", total, N)


@dataclass(frozen=True)
class Sources:
    """The right-hand sides of the manufactured solution, as a term."""

    exact: Exact
    loaded: str
    ends: tuple[str, ...]
    known: dict[tuple[str, str, int], Array] = field(default_factory=dict)
    name: str = "sources"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u", "p"]

    def parts(self) -> list[Part]:
        ends = [Part(f"facets:{end}", self.inflow) for end in self.ends]
        return [Part("cells", self.inside), Part(f"facets:{self.loaded}", self.load), *ends]

    def _add(self, at: Points, out: Integrand, name: str, values: Callable[[], Array]) -> None:
        """The points do not move: evaluate once."""
        key = (name, at.domain.name, at.rows.start)
        if key not in self.known:
            self.known[key] = -values()
        out.residual(name, VALUE, self.known[key])

    def inside(self, at: Points, out: Integrand) -> None:
        X = at.position
        self._add(at, out, "u", lambda: self.exact.body_force(X))
        self._add(at, out, "p", lambda: self.exact.source(X))

    def load(self, at: Points, out: Integrand) -> None:
        self._add(at, out, "u", lambda: self.exact.traction(at.position, at.normal))

    def inflow(self, at: Points, out: Integrand) -> None:
        X, N = at.position, at.normal
        self._add(at, out, "p", lambda: np.einsum("...d,...d->...", self.exact.flow(X), N))


def given(dofs: Dofs, exact: Exact, loaded: str, ends: tuple[str, ...]) -> Constraints:
    """Exact nodal values where a field is given."""
    mesh, fixed, values = dofs.mesh, [], []
    for name, free in (("u", (loaded,)), ("p", ends)):
        sides = [mesh.boundary_nodes(side) for side in mesh.boundary_names if side not in free]
        nodes = np.intersect1d(np.concatenate(sides), dofs.nodes[name])
        count = dofs.fields[name].components
        fixed.append((dofs.base[name][nodes][:, None] + np.arange(count)).ravel())
        values.append(getattr(exact, name)(mesh.coordinates[nodes]).ravel())
    none = np.zeros(0, dtype=np.int64)
    return Constraints(np.concatenate(fixed).astype(np.int64), np.concatenate(values), none,
                       np.zeros((0, mesh.dim, mesh.dim)))


def interpolated(dofs: Dofs, exact: Exact) -> Array:
    """Nodal values of the exact solution, a local state."""
    local = np.zeros(dofs.size_local)
    for name in CHOSEN:
        if name in dofs.fields:
            field_values(dofs, name, getattr(exact, name), local)
    return local


def solve(of: System, start: Array) -> tuple[Array, list[float]]:
    """Newton to a standstill: the local solution and the residual's norm at each iterate."""
    x, residual, update = vector(of.dofs, start), of.dofs.vector(), of.dofs.vector()
    of.apply_conditions(x)
    matrix = of.create_matrix()
    ksp = PETSc.KSP().create(of.dofs.mesh.comm)
    ksp.setType("preonly")
    ksp.getPC().setType("lu")
    ksp.getPC().setFactorSolverType("mumps")
    norms, change = [], np.inf
    for _ in range(12):
        of.residual(x, residual)
        norms.append(residual.norm())
        if change < 1e-8:
            break
        of.jacobian(x, matrix)
        ksp.setOperators(matrix)
        ksp.solve(residual, update)
        change = update.norm(PETSc.NormType.INFINITY)
        x.axpy(-1.0, update)
    local = of.physical(of.dofs.to_local(x))
    for o in (x, residual, update, matrix, ksp):
        o.destroy()
    return local, norms
