"""The film alone over a smooth gap: order degree + 1 in L2 for a manufactured pressure.

Of an incompressible fluid in a steady state, and of a compressible one in a step from p = 0.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from porolub.fem.constraints import Constraints
from porolub.fem.points import VALUE
from porolub.laws.fluid import CompressibleFluid
from porolub.laws.lubricant import Newtonian
from porolub.terms.compressibility import CompressibleFilm
from porolub.terms.film import Film
from porolub.terms.plane import Plane
from porolub.terms.squeeze import Squeeze
from porolub.terms.term import Part
from tests.fem import meshes
from tests.terms.manufactured import STEP, solve
from tests.terms.support import everywhere, field_values, operation, system

ETA, SPEED, LIFTED = 2e-2, 0.7, 0.1
R = meshes.RADIUS


@dataclass(frozen=True)
class Source:
    """What the manufactured pressure needs: div_s (r (- k grad p + h U / 2)) + (r - 1) h / dt."""

    boundary: str
    density: Callable
    name: str = "source"

    def fields(self):
        return []

    def reads(self):
        return ["p"]

    def parts(self):
        return [Part(f"facets:{self.boundary}", self.add)]

    def add(self, at, out):
        out.residual("p", VALUE, -self.density(at.position))


def flux(h, slope, speed):
    return -(h**3) / (12 * ETA) * slope + h / 2 * speed


def derivative(function, at):
    return function(at + 1j * STEP).imag / STEP


def angle(X):
    return np.arctan2(X[..., 0], R - X[..., 1])


def wavy(phase):
    return 0.4 + 0.3 * np.sin(phase + 0.5)


def arc_pressure(X):
    return wavy(3 * angle(X))


def arc_source(X, chi, rate):
    """Along the arc s = R t, over the gap h = LIFTED + R (1 - cos t)."""
    def gap(t):
        return LIFTED + R * (1 - np.cos(t))

    def flow(t):
        return np.exp(chi * wavy(3 * t)) * flux(gap(t), 0.9 * np.cos(3 * t + 0.5) / R, SPEED * R)

    stored = (np.exp(chi * arc_pressure(X)) - 1) * gap(angle(X))
    return derivative(flow, angle(X)) / R + rate * stored


def flat_pressure(X):
    return wavy(1.1 * X[..., 0] + 0.9 * X[..., 2])


def flat_source(X, chi, rate):
    """Over a flat top under a tilted plane: h = LIFTED + 0.1 (1.5 - x), U along x."""
    x, z = X[..., 0], X[..., 2]

    def gap(x):
        return LIFTED + 0.1 * (1.5 - x)

    def flow(x, z, k, speed):
        phase = 1.1 * x + 0.9 * z
        return np.exp(chi * wavy(phase)) * flux(gap(x), 0.3 * k * np.cos(phase + 0.5), speed)

    stored = (np.exp(chi * flat_pressure(X)) - 1) * gap(x)
    return (derivative(lambda t: flow(t, z, 1.1, SPEED), x)
            + derivative(lambda t: flow(x, t, 0.9, 0.0), z) + rate * stored)


def error(kind, counts, degree, chi=0.0, rate=0.0):
    mesh, boundary = meshes.mesh(kind, *counts), meshes.surface(kind)
    curved = kind in meshes.CURVED
    at = operation("rotation" if curved else "sliding", SPEED, approach=-LIFTED,
                   direction=(1.0, 0.0, 0.0)[: mesh.dim])
    plane = Plane((0.0, -1.0), 0.0, at) if curved else Plane((0.1, 1.0, 0.0), 1.15, at)
    pressure, density = (arc_pressure, arc_source) if curved else (flat_pressure, flat_source)
    film = Film(Newtonian(ETA, 1e-3), plane, at, boundary, False, False, degree, alone=True)
    terms = [film, Source(boundary, lambda X: density(X, chi, rate))]
    if chi:
        squeeze = Squeeze(plane, boundary, False, False)
        terms += [squeeze, CompressibleFilm(CompressibleFluid(chi), film, squeeze)]
    dofs = system(mesh, terms, boundary=boundary).dofs
    nodes = dofs.nodes["p"]
    on_rim = np.zeros(len(nodes), bool)
    for side in mesh.boundary_names:
        if side != boundary:
            on_rim |= np.isin(nodes, mesh.boundary_nodes(side))
    rim, none = nodes[on_rim], np.zeros(0, dtype=np.int64)
    given = Constraints(dofs.base["p"][rim].astype(np.int64), pressure(mesh.coordinates[rim]),
                        none, np.zeros((0, mesh.dim, mesh.dim)))
    of = system(mesh, terms, boundary=boundary, points=5, constraints=given)
    start = np.zeros(of.dofs.size_local)
    if rate:
        of.backward_euler(start, 1.0 / rate)
    field_values(of.dofs, "p", lambda X: np.full(len(X), 0.4), start)
    state, norms = solve(of, start)
    assert 0.0 < norms[-1] < 1e-11 < norms[0]
    assert (len(norms) == 3) == (chi == 0.0), "the film of a rigid body is linear in p, but for r"
    seen = everywhere(of, f"facets:{boundary}", state)
    return np.sqrt((seen.weights * (seen.value("p") - pressure(seen.position)) ** 2).sum())


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize("fluid", [(0.0, 0.0), (0.8, 5.0)], ids=["incompressible", "compressible"])
@pytest.mark.parametrize(
    ("kind", "refinement"),
    [("sector", [(10, 2), (20, 2), (40, 2)]), ("sector of triangles", [(10, 2), (20, 2), (40, 2)]),
     ("cuboid", [(4, 1, 4), (8, 1, 8), (16, 1, 16)])],
)
def test_order_of_the_film(kind, refinement, fluid, degree):
    errors = np.array([error(kind, counts, degree, *fluid) for counts in refinement])
    assert errors.min() > 1e-9
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:])[-1], degree + 1, atol=0.1)
