"""From the scene to the system: which fields and terms, which moduli, what is held where."""

import numpy as np
import pytest

from porolub.solve.system import union_of_fields
from porolub.terms.pores import Pores
from porolub.terms.skeleton import Skeleton
from porolub.terms.surface_pressure import SurfacePressure
from tests.scene.scenes import changed
from tests.terms.case1 import BARREL, BONDED, CASE1, model
from tests.terms.cases import NEO

G, K, BIOT, R = 0.5e6, 5e6, 0.9, 100.0


def anything(of, seed=0):
    """A physical local state with random free dofs: only the constraints hold."""
    size = of.dofs.size_local
    stored = np.random.default_rng(seed).standard_normal(size)
    stored[of.system.constraints.fixed] = of.system.constraints.values
    return of.system.physical(stored)


def displacement(of, local, name):
    """(n, dim) at the nodes of a boundary, and their positions."""
    nodes = of.mesh.boundary_nodes(name)
    base = of.dofs.base["u"][nodes]
    return local[base[:, None] + np.arange(of.mesh.dim)], of.mesh.coordinates[nodes]


@pytest.mark.parametrize(
    ("without", "fields"),
    [
        ((), {"u", "p", "l", "v0", "j"}),
        (("film",), {"u", "p", "l", "v0", "j"}),
        (("contact",), {"u", "p", "v0", "j"}),
        (("pores",), {"u", "p", "l", "v0"}),
        (("pores", "film"), {"u", "l", "v0"}),
    ],
)
def test_an_absent_effect_has_no_unknowns(without, fields):
    of = model(changed(CASE1, **dict.fromkeys(without)))
    counts = of.dofs.counts()
    assert set(counts) == fields
    nodes, surface = (2 * 12 + 1) * (2 * 3 + 1), 2 * 12 + 1
    assert counts["u"] == 2 * nodes
    if "l" in fields:
        assert counts["l"] == surface
    if "p" in fields:  # in the layer with pores, else in the film alone
        assert counts["p"] == (13 if "pores" in without else 13 * 4)


def test_a_given_approach_is_no_unknown():
    of = model(changed(CASE1, load={"force": None, "approach": "50 um"}))
    assert "v0" not in of.dofs.fields
    assert of.operation.approach * of.scales.length == pytest.approx(50e-6)


def test_terms_are_refused_without_their_fields_or_with_two_meanings_of_one():
    with pytest.raises(ValueError, match="'surface pressure' needs the field 'u'"):
        union_of_fields([SurfacePressure(1.0, True, "top")])
    with pytest.raises(ValueError, match="two terms define the field 'u' differently"):
        union_of_fields([Skeleton(NEO, 2, 2), Skeleton(NEO, 2, 1)])
    both = union_of_fields([Pores(BIOT, 1.0, True, 1), Skeleton(NEO, 2, 2)])
    assert [f.name for f in both] == ["u", "p"]


def test_moduli_of_the_papers_energy_and_of_a_dry_layer():
    wet, dry = model(CASE1), model(changed(CASE1, pores=None, film=None))
    for of, shear, bulk in ((wet, BIOT * G, (1 - BIOT) * K), (dry, G, K)):
        assert of.law.shear * of.scales.pressure == pytest.approx(shear)
        assert of.law.bulk * of.scales.pressure == pytest.approx(bulk)


def test_scaled_units_give_back_the_scene():
    of = model(CASE1)
    s = of.scales
    assert of.operation.speed / s.time == pytest.approx(1.0)
    assert of.operation.force * s.force == pytest.approx(1.5e3)
    pores = next(t for t in of.system.terms if t.name == "pores")
    assert pores.mobility * s.mobility == pytest.approx(1e-15 / 1e-3)
    film = next(t for t in of.system.terms if t.name == "film")
    assert film.law.viscosity * s.viscosity == pytest.approx(1e-3)
    assert s.speed * s.time == pytest.approx(s.length)


@pytest.mark.parametrize("tables", [CASE1, BARREL], ids=["sector", "barrel"])
def test_a_sliding_layer_keeps_its_distance_from_bone_and_ends(tables):
    of = model(tables)
    local = anything(of)
    u, X = displacement(of, local, "bone")
    if of.mesh.dim == 2:
        radial = (X - [0.0, R]) / np.linalg.norm(X - [0.0, R], axis=1, keepdims=True)
        np.testing.assert_allclose(np.einsum("nd,nd->n", u, radial), 0.0, atol=1e-9)
    assert np.abs(u).max() > 0.1
    for name, side in (("inlet", -1), ("outlet", 1)):
        u, _ = displacement(of, local, name)
        angle = side * np.deg2rad(5.0)
        normal = np.array([np.cos(angle), np.sin(angle)])
        np.testing.assert_allclose(u[:, :2] @ normal, 0.0, atol=1e-12)
        assert np.abs(u).max() > 0.1
    if of.mesh.dim == 3:
        for name in ("front", "back"):
            u, _ = displacement(of, local, name)
            assert np.abs(u).max() > 0.1
            np.testing.assert_allclose(u[:, 2], 0.0, atol=1e-12)


def test_a_bonded_layer_does_not_move_at_the_bone():
    of = model(BONDED)
    local = anything(of)
    np.testing.assert_allclose(displacement(of, local, "bone")[0], 0.0, atol=1e-14)
    assert np.abs(displacement(of, local, "lubricated")[0]).max() > 0.1


def test_the_film_ends_in_the_bath():
    of = model(CASE1)
    local = anything(of)
    X = of.mesh.coordinates[of.dofs.nodes["p"]]
    pressure = of.dofs.field("p", local)[:, 0]
    rim = np.isclose(np.hypot(X[:, 0], R - X[:, 1]), R) & (np.abs(X[:, 0]) > 8.7)
    assert rim.sum() == 2
    np.testing.assert_array_equal(pressure == 0.0, rim)


def test_the_scene_may_hold_a_boundary_otherwise():
    given = {"inlet": {"displacement": {"x": "2 um"}, "pressure": "3 kPa"},
             "outlet": {"traction": "1 kPa"}}
    of = model(changed(CASE1, boundary=given))
    local = anything(of)
    u, _ = displacement(of, local, "inlet")
    np.testing.assert_allclose(u[:-1, 0], 2e-3, atol=1e-12)
    p = of.dofs.base["p"][of.mesh.boundary_nodes("inlet")]
    values = np.unique(local[p[p >= 0]]) * of.scales.pressure
    assert values[-1] == pytest.approx(3e3)
    assert np.abs(displacement(of, local, "outlet")[0]).max() > 0.1
    loads = [t for t in of.system.terms if t.name == "traction"]
    assert [t.boundary for t in loads] == ["outlet"]
    assert loads[0].normal * of.scales.pressure == pytest.approx(1e3)


@pytest.mark.parametrize(("reading", "share"), [("balanced", 1.0), ("paper", BIOT)])
def test_reading_of_the_surface_traction(reading, share):
    of = model(changed(CASE1, conventions={"surface_traction": reading}))
    term = next(t for t in of.system.terms if t.name == "surface pressure")
    assert term.share == share


def test_closed_surface_weighs_what_it_measures():
    """Nodal contact weights add up to the length of the arc."""
    of = model(CASE1)
    nodes = of.system.domains["nodes:lubricated"]
    assert nodes.weights.sum() == pytest.approx(2 * np.deg2rad(5.0) * R, rel=1e-7)
    assert nodes.weights.min() > 0
    np.testing.assert_array_equal(np.sort(nodes.cells), of.mesh.boundary_nodes("lubricated"))
    assert of.plane.offset == pytest.approx(0.0, abs=1e-12)
