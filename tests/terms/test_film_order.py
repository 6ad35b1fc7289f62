"""The film alone over a smooth gap: order degree + 1 in L2 for a manufactured pressure."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from porolub.fem.constraints import Constraints
from porolub.fem.points import VALUE
from porolub.laws.lubricant import Newtonian
from porolub.terms.film import Film
from porolub.terms.plane import Plane
from porolub.terms.term import Part
from tests.fem import meshes
from tests.terms.manufactured import STEP, solve
from tests.terms.support import everywhere, field_values, operation, system

ETA, SPEED, LIFTED = 2e-2, 0.7, 0.1
R = meshes.RADIUS


@dataclass(frozen=True)
class Source:
    """What the manufactured pressure needs beside the wedge: div_s (- k grad p + h U / 2)."""

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


def arc_pressure(X):
    return 0.4 + 0.3 * np.sin(3 * angle(X) + 0.5)


def arc_source(X):
    """Along the arc s = R t, over the gap h = LIFTED + R (1 - cos t)."""
    def flow(t):
        h = LIFTED + R * (1 - np.cos(t))
        return flux(h, 0.9 * np.cos(3 * t + 0.5) / R, SPEED * R)

    return derivative(flow, angle(X)) / R


def flat_pressure(X):
    return 0.4 + 0.3 * np.sin(1.1 * X[..., 0] + 0.9 * X[..., 2] + 0.5)


def flat_source(X):
    """Over a flat top under a tilted plane: h = LIFTED + 0.1 (1.5 - x), U along x."""
    x, z = X[..., 0], X[..., 2]

    def flow(x, z, k, speed):
        h = LIFTED + 0.1 * (1.5 - x)
        return flux(h, 0.3 * k * np.cos(1.1 * x + 0.9 * z + 0.5), speed)

    return (derivative(lambda t: flow(t, z, 1.1, SPEED), x)
            + derivative(lambda t: flow(x, t, 0.9, 0.0), z))


def error(kind, counts, degree):
    mesh, boundary = meshes.mesh(kind, *counts), meshes.surface(kind)
    curved = kind in meshes.CURVED
    at = operation("rotation" if curved else "sliding", SPEED, approach=-LIFTED,
                   direction=(1.0, 0.0, 0.0)[: mesh.dim])
    plane = Plane((0.0, -1.0), 0.0, at) if curved else Plane((0.1, 1.0, 0.0), 1.15, at)
    pressure, density = (arc_pressure, arc_source) if curved else (flat_pressure, flat_source)
    film = Film(Newtonian(ETA, 1e-3), plane, at, boundary, False, False, degree, alone=True)
    terms = [film, Source(boundary, density)]
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
    field_values(of.dofs, "p", lambda X: np.full(len(X), 0.4), start)
    state, norms = solve(of, start)
    assert 0.0 < norms[-1] < 1e-11 < norms[0]
    assert len(norms) == 3, "the film of a rigid body is linear"
    seen = everywhere(of, f"facets:{boundary}", state)
    return np.sqrt((seen.weights * (seen.value("p") - pressure(seen.position)) ** 2).sum())


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize(
    ("kind", "refinement"),
    [("sector", [(10, 2), (20, 2), (40, 2)]), ("sector of triangles", [(10, 2), (20, 2), (40, 2)]),
     ("cuboid", [(4, 1, 4), (8, 1, 8), (16, 1, 16)])],
)
def test_order_of_the_film(kind, refinement, degree):
    errors = np.array([error(kind, counts, degree) for counts in refinement])
    assert errors.min() > 1e-9
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:])[-1], degree + 1, atol=0.1)
