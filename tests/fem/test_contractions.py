"""Compiled contractions against NumPy's einsum: all slots, both dimensions, absent dofs."""

from dataclasses import dataclass
from itertools import product

import numpy as np
import pytest

from porolub.fem.dofs import Dofs, Field
from porolub.fem.domains import Domain
from porolub.fem.points import GRAD, VALUE, Points
from porolub.terms.term import Part
from tests.fem import meshes
from tests.terms.support import dense_jacobian, system

SLOTS = [(name, op) for name in ("u", "p", "s") for op in (VALUE, GRAD)]
DOMAINS = ["cells", "facets"]
KINDS = ["sector", "block of triangles", "barrel", "box of tets"]
each = pytest.mark.parametrize(("kind", "where"), list(product(KINDS, DOMAINS)))


def basis(domain, degree, op):
    """Values (ne, nq, 1, nn) or physical gradients (ne, nq, dim, nn)."""
    tables = domain.tables(degree)
    if op == VALUE:
        return tables.value[domain.variant][:, :, None, :]
    return np.einsum("eqrd,eqrn->eqdn", domain.inverse, tables.gradient[domain.variant])


@dataclass(frozen=True)
class AnyNumbers:
    """Fills one slot, or a pair of slots, with given numbers."""

    kind: str
    domain: str
    test: tuple[str, bool]
    trial: tuple[str, bool] | None = None
    name: str = "any numbers"

    def fields(self):
        mesh, surface = meshes.mesh(self.kind), meshes.surface(self.kind)
        return [Field("u", mesh.dim, 2), Field("p", 1, 1), Field("s", 1, 1, support=surface),
                Field("v0", 1, 0)]

    def reads(self):
        return []

    def parts(self):
        blocks = [(self.test[0], self.trial[0])] if self.trial else []
        return [Part(self.domain, self.add, blocks)]

    def shape(self, at, slot):
        field, op = slot
        return (at.dim,) * (field == "u") + (at.dim,) * op

    def numbers(self, at):
        """Different at every point, reproducible in any slicing."""
        slots = [self.test] + [self.trial] * (self.trial is not None)
        inner = sum((self.shape(at, slot) for slot in slots), ())
        count = int(np.prod(inner, dtype=int))
        phase = 3 * at.position.sum(axis=-1)[..., None] + np.arange(count)
        return np.sin(phase).reshape(*at.weights.shape, *inner)

    def add(self, at, out):
        if self.trial is None:
            out.residual(*self.test, self.numbers(at))
        elif out.wants_jacobian:
            out.jacobian(*self.test, *self.trial, self.numbers(at))


def build(kind, where, test, trial=None):
    name = where if where == "cells" else f"facets:{meshes.surface(kind)}"
    term = AnyNumbers(kind, name, test, trial)
    of = system(meshes.mesh(kind), [term])
    domain = of.domains[name]
    at = Points(domain, of.dofs, np.zeros(of.dofs.size_local), slice(0, len(domain)), True)
    return of, domain, term, term.numbers(at)


def scattered(of, domain, name):
    """(ne, components, nn) local dofs; absent ones point to a last, extra place."""
    base = of.dofs.entity_dofs(name, domain)[:, None, :]
    components = np.arange(of.dofs.fields[name].components)[None, :, None]
    return np.where(base >= 0, base + components, of.dofs.size_local)


@each
@pytest.mark.parametrize("slot", SLOTS)
def test_residual(kind, where, slot):
    of, domain, _, f = build(kind, where, slot)
    name, op = slot
    field = of.dofs.fields[name]
    B = basis(domain, field.degree, op)
    f = f.reshape(*domain.weights.shape, field.components, B.shape[2])
    per_entity = np.einsum("eq,eqca,eqan->ecn", domain.weights, f, B)
    expected = np.zeros(of.dofs.size_local + 1)
    np.add.at(expected, scattered(of, domain, name), per_entity)
    found = of.local_residual(np.zeros(of.dofs.size_local))
    np.testing.assert_allclose(found, expected[:-1], atol=1e-12)
    assert np.abs(found[of.dofs.range[name]]).max() > 1e-3


@pytest.mark.parametrize(("test", "trial"), list(product(SLOTS, SLOTS)))
@pytest.mark.parametrize("where", DOMAINS)
@pytest.mark.parametrize("kind", ["sector", "cuboid"])
def test_matrix(kind, where, test, trial):
    of, domain, _, g = build(kind, where, test, trial)
    fields = [of.dofs.fields[name] for name, _ in (test, trial)]
    B, D = (basis(domain, f.degree, op) for f, (_, op) in zip(fields, (test, trial), strict=True))
    g = g.reshape(*domain.weights.shape, fields[0].components, B.shape[2],
                  fields[1].components, D.shape[2])
    per_entity = np.einsum("eq,eqan,eqcadb,eqbm->ecndm", domain.weights, B, g, D, optimize=True)
    n = of.dofs.size_local
    expected = np.zeros((n + 1, n + 1))
    rows, cols = (scattered(of, domain, f.name) for f in fields)
    np.add.at(expected, (rows[:, :, :, None, None], cols[:, None, None]), per_entity)
    found = dense_jacobian(of, np.zeros(n))
    np.testing.assert_allclose(found, expected[:-1, :-1], atol=1e-12)
    assert np.abs(found).max() > 1e-3


@each
def test_evaluation(kind, where):
    mesh, surface = meshes.mesh(kind), meshes.surface(kind)
    fields = [Field("u", mesh.dim, 2), Field("p", 1, 1), Field("s", 1, 1, support=surface),
              Field("v0", 1, 0)]
    dofs = Dofs(mesh, fields)
    domain = Domain("cells" if where == "cells" else f"facets:{surface}", mesh, 3)
    local = np.random.default_rng(0).standard_normal(dofs.size_local)
    rows = slice(1, len(domain) - 1)
    at = Points(domain, dofs, local, rows, True)
    extended = np.append(local, 0.0)
    for f in fields:
        base = dofs.entity_dofs(f.name, domain)[:, None, :]
        numbers = np.where(base >= 0, base + np.arange(f.components)[None, :, None], -1)
        for op in (VALUE, GRAD):
            B = basis(domain, f.degree, op)
            expected = np.einsum("eqan,ecn->eqca", B, extended[numbers])[rows]
            found = at.grad(f.name) if op else at.value(f.name)
            np.testing.assert_allclose(found, expected.reshape(found.shape), atol=1e-12)
    np.testing.assert_array_equal(at.value("v0"), local[-1])


def test_terms_of_a_slot_are_summed_over_any_number_of_entities():
    """More cells than are worked on at a time, and the same term three times."""
    mesh = meshes.mesh("sector", 40, 16)
    term = AnyNumbers("sector", "cells", ("u", GRAD), ("p", VALUE))
    once, thrice = system(mesh, [term]), system(mesh, [term] * 3)
    x = once.dofs.vector()
    x.array[:] = np.sin(np.arange(once.dofs.size))
    found = []
    for of in (once, thrice):
        matrix, product_ = of.create_matrix(), of.dofs.vector()
        of.jacobian(x, matrix)
        matrix.mult(x, product_)
        found.append(product_.array.copy())
        matrix.destroy()
    np.testing.assert_allclose(3 * found[0], found[1], atol=1e-11)
    domain = once.domains["cells"]
    local = once.dofs.to_local(x)
    at = Points(domain, once.dofs, local, slice(0, len(domain)), True)
    f = np.einsum("eqij,eq->eqij", term.numbers(at), at.value("p"))
    per_entity = np.einsum("eq,eqca,eqan->ecn", domain.weights, f, basis(domain, 2, GRAD))
    expected = np.zeros(once.dofs.size_local + 1)
    np.add.at(expected, scattered(once, domain, "u"), per_entity)
    np.testing.assert_allclose(found[0], expected[once.dofs.owned.nonzero()[0]], atol=1e-11)
