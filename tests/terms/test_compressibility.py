"""A compressible fluid: rows of mass that balance, and nothing at all without compressibility."""

from dataclasses import dataclass

import numpy as np
import pytest

from porolub.laws.fluid import CompressibleFluid
from porolub.terms.carry import Carry
from porolub.terms.compressibility import CompressibleFilm, CompressiblePores
from porolub.terms.film import Film
from porolub.terms.pores import Pores
from porolub.terms.squeeze import Squeeze
from porolub.terms.storage import Storage
from tests.fem import meshes
from tests.terms.cases import BIOT, FLUID, LUBRICANT, MOBILITY, POROSITY, STORAGE, setting
from tests.terms.support import (
    affine,
    dense_jacobian,
    everywhere,
    field_values,
    inner_nodes,
    smooth,
    system,
)

RATE = 5.0
CHI = FLUID.compressibility
GRAINS = STORAGE - POROSITY * CHI
each = pytest.mark.parametrize("kind", meshes.ALL)


@dataclass(frozen=True)
class Layer:
    """All terms of fluid mass on a mesh, with the compressible ones or without."""

    kind: str
    fresh: bool = False
    spatial: bool = True

    def terms(self, chi=CHI, *, carry=True, film=True, compressible=True):
        mesh, name = meshes.mesh(self.kind), meshes.surface(self.kind)
        at, fluid = setting(mesh, name), CompressibleFluid(chi)
        pores = Pores(BIOT, MOBILITY, self.spatial, 1), Storage(BIOT, STORAGE)
        terms, added = [*pores], []
        carried = Carry(BIOT, at.operation, at.ends, self.fresh) if carry else None
        terms += [carried] * carry
        added.append(CompressiblePores(fluid, POROSITY, *pores, carried))
        if film:
            thin = (Film(LUBRICANT, at.plane, at.operation, name, True, True, 1, False),
                    Squeeze(at.plane, name, True, True))
            terms += thin
            added.append(CompressibleFilm(fluid, *thin))
        return terms + added * compressible

    def system(self, chi=CHI, **which):
        return system(meshes.mesh(self.kind), self.terms(chi, **which), ["u", "p", "v0"])


def ratio(at):
    return np.exp(CHI * at.value("p"))


def pore_fluid(at):
    """Fluid mass in the pores per reference volume, over rho_0, but for what fills the grains."""
    return ratio(at) * (POROSITY + BIOT * (at.deformation.J - 1.0))


@each
@pytest.mark.parametrize("rate", [0.0, RATE])
def test_without_compressibility_nothing_changes_at_all(kind, rate):
    of, alone = Layer(kind).system(0.0), Layer(kind).system(compressible=False)
    state = smooth(of.dofs)
    found = []
    for one in (of, alone):
        if rate:
            one.backward_euler(smooth(of.dofs, 0.03, 0.05), 1.0 / rate)
        found.append((one.local_residual(state), dense_jacobian(one, state)))
    for with_terms, without in zip(*found, strict=True):
        np.testing.assert_array_equal(with_terms, without)
    assert np.abs(found[0][0]).max() > 1e-3


def test_a_little_compressibility_changes_little():
    """In proportion to it; the storage coefficient is the same, so only its meaning shifts."""
    def rows(**which):
        of = Layer("sector").system(**which)
        of.backward_euler(smooth(of.dofs, 0.03, 0.05), 1.0 / RATE)
        return of.local_residual(smooth(of.dofs))

    alone = rows(compressible=False)
    sizes = [np.abs(rows(chi=chi) - alone).max() for chi in (2e-4, 1e-4)]
    assert sizes[-1] > 1e-7
    assert np.log2(sizes[0] / sizes[1]) == pytest.approx(1.0, abs=0.01)


@each
def test_rows_add_up_to_the_change_of_the_fluid_mass(kind):
    """That of the pores, int r (e + a (J - 1) + S_s p), and of the film, int r h."""
    of = Layer(kind).system(carry=False)
    before, now = smooth(of.dofs, 0.03, 0.05), smooth(of.dofs)
    before[of.dofs.range["p"]] *= -0.5
    masses, surface = [], f"facets:{meshes.surface(kind)}"
    plane = next(t.plane for t in of.terms if isinstance(t, Film))
    for state in (before, now):
        inside, film = everywhere(of, "cells", state), everywhere(of, surface, state)
        grains = ratio(inside) * GRAINS * inside.value("p")
        thickness = np.maximum(plane.gap(film), 0.0)
        masses.append((inside.weights * (pore_fluid(inside) + grains)).sum()
                      + (film.weights * ratio(film) * thickness).sum())
    of.backward_euler(before, 1.0 / RATE)
    total = of.dofs.field("p", of.local_residual(now)).sum()
    assert total == pytest.approx(RATE * (masses[1] - masses[0]), rel=1e-10)
    assert abs(masses[1] - masses[0]) > 1e-3


@each
@pytest.mark.parametrize("fresh", [True, False])
def test_carry_passes_mass_through_the_ends_only(kind, fresh):
    """What enters is as it is there, or fresh: undeformed and at ambient pressure."""
    of = Layer(kind, fresh).system(film=False)
    local, passed = smooth(of.dofs), 0.0
    carry = next(t for t in of.terms if isinstance(t, Carry))
    for end in carry.ends:
        side = everywhere(of, f"facets:{end}", local)
        v = carry.operation.body_velocity(side.position)
        vn = np.einsum("eqd,eqd->eq", v, side.normal)
        content = np.where((vn < 0) & fresh, POROSITY, pore_fluid(side)) - POROSITY
        passed += (side.weights * content * vn).sum()
    total = of.dofs.field("p", of.local_residual(local)).sum()
    assert total == pytest.approx(passed, rel=1e-9)
    assert abs(passed) > 1e-5


@pytest.mark.parametrize("kind", ["sector", "sector of triangles"])
def test_the_carry_of_a_uniform_fluid_mass_takes_and_leaves_nothing(kind):
    """Constant J and p: what enters leaves.  Arcs are tangential but for O(h^4)."""
    mesh = meshes.mesh(kind, 8, 2)
    at = setting(mesh, "lubricated")
    pores, storage = Pores(BIOT, MOBILITY, True, 1), Storage(BIOT, STORAGE)
    term = CompressiblePores(FLUID, POROSITY, pores, storage,
                             Carry(BIOT, at.operation, at.ends, False))
    of = system(mesh, [term], ["u", "p"])
    local, A = affine(of)
    found = of.dofs.field("p", of.local_residual(local))
    inner = inner_nodes(mesh)[of.dofs.nodes["p"]]
    J = np.linalg.det(np.eye(mesh.dim) + A)
    through = np.expm1(CHI * 0.2) * (POROSITY + BIOT * (J - 1.0)) * 0.7 * meshes.RADIUS
    assert abs(through) > 0.05
    assert 0.0 < np.abs(found[inner]).max() < 1e-12
    np.testing.assert_allclose(found, 0.0, atol=1e-4 * abs(through))


@pytest.mark.parametrize("kind", ["sector", "barrel"])
def test_an_undeformed_body_carries_its_density_along(kind):
    """Without Darcy flow: int e (v . grad r) q, of q that vanish at the boundary."""
    mesh = meshes.mesh(kind, 8, 4, 4)
    at = setting(mesh, "lubricated")
    term = CompressiblePores(FLUID, POROSITY, Pores(BIOT, 0.0, True, 1), Storage(BIOT, STORAGE),
                             Carry(BIOT, at.operation, at.ends, False))
    of = system(mesh, [term], ["u", "p"])
    local, slope = np.zeros(of.dofs.size_local), np.array([0.7, -0.4, 1.3])[: mesh.dim]
    field_values(of.dofs, "p", lambda X: 0.2 + X @ slope, local)
    tried = np.zeros(of.dofs.size_local)
    free = inner_nodes(mesh)[of.dofs.nodes["p"]]
    X = mesh.coordinates[of.dofs.nodes["p"]]
    of.dofs.field("p", tried)[:, 0] = np.where(free, 1.0 + X[:, 0], 0.0)
    seen, trial = everywhere(of, "cells", local), everywhere(of, "cells", tried)
    v = at.operation.body_velocity(seen.position)
    change = CHI * ratio(seen) * np.einsum("eqd,eqd->eq", v, seen.grad("p"))
    expected = POROSITY * (seen.weights * change * trial.value("p")).sum()
    found = tried @ of.local_residual(local)
    assert found == pytest.approx(expected, rel=1e-3)
    assert abs(expected) > 0.1


@each
@pytest.mark.parametrize("spatial", [True, False])
def test_rows_balance_the_flow_of_mass(kind, spatial):
    """Tested with any q: r times Darcy's flux in the pores and r times the film's."""
    of = Layer(kind, spatial=spatial).system(carry=False)
    local = smooth(of.dofs)
    q = np.zeros(of.dofs.size_local)
    random = np.random.default_rng(0).standard_normal(of.dofs.size_local)
    q[of.dofs.range["p"]] = random[of.dofs.range["p"]]
    surface = f"facets:{meshes.surface(kind)}"
    inside, film = everywhere(of, "cells", local), everywhere(of, surface, local)
    darcy = -MOBILITY * inside.grad("p")
    if spatial:
        F = np.eye(inside.dim) + inside.grad("u")
        inverse = np.linalg.inv(F)
        darcy = np.linalg.det(F)[..., None] * np.einsum("eqij,eqkj,eqk->eqi", inverse, inverse,
                                                        darcy)
    thin = next(t for t in of.terms if isinstance(t, Film)).flux(film)
    expected = 0.0
    for at, name, flux in ((inside, "cells", darcy), (film, surface, thin)):
        slope = everywhere(of, name, q).grad("p")
        expected -= np.einsum("eq,eqd,eqd->", at.weights * ratio(at), flux, slope)
    assert q @ of.local_residual(local) == pytest.approx(expected, rel=1e-10)
