"""The whole system of Case 1 and its relatives: the Jacobian is the derivative of the residual."""

from itertools import product

import numpy as np
import pytest

from tests.scene.scenes import changed
from tests.terms.case1 import BARREL, BONDED, CASE1, CUBOID, model, restrained, trial_state
from tests.terms.support import smooth
from tests.terms.taylor import pairs, residual

MATERIAL = {"frame": "material"}
PAPER = {"surface_traction": "paper"}
LINEAR = {"law": "linear"}
DRY = {"pores": None, "film": None}

READINGS = {
    f"{frame}, {traction}, {law}": changed(
        CASE1, conventions={"frame": frame, "surface_traction": traction}, solid={"law": law})
    for frame, traction, law in product(("spatial", "material"), ("balanced", "paper"),
                                        ("neo-hookean", "linear"))
}
SCENES = READINGS | {
    "triangles": changed(CASE1, mesh={"element": "triangle"}),
    "triangles, material, paper, linear": changed(
        CASE1, mesh={"element": "triangle"}, conventions=MATERIAL | PAPER, solid=LINEAR),
    "equal order": changed(CASE1, mesh={"pressure_degree": 2}),
    "lowest order": changed(CASE1, mesh={"degree": 1, "pressure_degree": 1}),
    "bonded, friction shears": BONDED,
    "the other way round": changed(BONDED, motion={"speed": "-1 rad/s"}),
    "given approach": changed(CASE1, load={"force": None, "approach": "50 um"}),
    "sliding plane": changed(CASE1, motion={"kind": "sliding", "speed": "0.1 m/s"},
                             pores={"carry": None}, contact={"friction_traction": True}),
    "no film": changed(CASE1, film=None),
    "no contact": changed(CASE1, contact=None),
    "impermeable": changed(CASE1, pores=None),
    "dry": changed(CASE1, **DRY, motion=None),
    "rigid": changed(CASE1, solid=None, pores=None, contact=None),
    "rigid, given approach": changed(CASE1, solid=None, pores=None, contact=None,
                                     load={"force": None, "approach": "-5 um"}),
    "barrel": BARREL,
    "barrel, material, paper, linear": changed(BARREL, conventions=MATERIAL | PAPER, solid=LINEAR),
    "barrel, bonded, friction shears": changed(BARREL, solid={"base": "bonded"},
                                               contact={"friction_traction": True}),
    "block": CUBOID,
    "block, material, paper, linear": changed(CUBOID, conventions=MATERIAL | PAPER, solid=LINEAR),
    "block, friction shears": changed(CUBOID, geometry={"symmetry": []},
                                      contact={"friction_traction": True},
                                      motion={"direction": "z"}),
    "block, oblique, free sides": changed(CUBOID, geometry={"symmetry": []},
                                          contact={"friction_traction": True},
                                          motion={"direction": [1.0, 0.0, -0.4]}),
    "half a barrel": changed(BARREL, geometry={"symmetry": ["front"]}),
    "barrel spinning under its film": changed(
        BARREL, pores={"carry": False}, motion={"axis": [0.3, 1.0, 0.2], "centre": ["0 m"] * 3}),
}


@pytest.mark.parametrize("name", SCENES)
def test_jacobian_is_the_derivative_of_the_residual(name):
    of = model(SCENES[name])
    system, dofs = of.system, of.dofs
    state = trial_state(of)
    for rate in (0.0, 5.0):  # steady, and a step of the start-up
        if rate:
            before = system.physical(restrained(of, smooth(dofs, 0.03, 0.05)))
            system.backward_euler(before, 1.0 / rate)
        filled = pairs(system, state)
        parts = [part for kind in (system.parts, system.contents) for on in kind.values()
                 for part in on]
        declared = {b for part in parts for b in part.blocks}
        names = set(dofs.fields)
        assert {(n, n) for n in names - {"v0"}} <= filled <= declared | {(n, n) for n in names}
        assert {row for row, _ in filled} == names == {column for _, column in filled}
    level = residual(system, state)
    assert np.isfinite(level).all()
    for field in dofs.fields:
        assert np.abs(level[dofs.range[field]]).max() > 1e-6


def test_constrained_rows_are_the_distance_to_what_is_given():
    of = model(BONDED)
    fixed, values = of.system.constraints.fixed, of.system.constraints.values
    state = trial_state(of)
    np.testing.assert_allclose(residual(of.system, state)[fixed], 0.0, atol=1e-15)
    state[fixed] += 0.25
    np.testing.assert_allclose(residual(of.system, state)[fixed], 0.25, rtol=1e-12)
    matrix = of.system.create_matrix()
    x = of.dofs.vector()
    of.system.jacobian(x, matrix)
    rows = of.dofs.global_numbers[fixed]
    block = matrix[:, :]
    expected = np.eye(of.dofs.size)[rows]
    np.testing.assert_array_equal(block[rows], expected)
    np.testing.assert_array_equal(block[:, rows], expected.T)
    assert len(values) > 25
    matrix.destroy()
    x.destroy()


def test_the_start_is_free_of_stress_and_carries_no_load():
    """Undeformed and just touching: what is left is the load that is missing and the wedge."""
    of = model(CASE1)
    found = residual(of.system, restrained(of, np.zeros(of.dofs.size_local)))
    np.testing.assert_allclose(of.dofs.field("u", found), 0.0, atol=1e-14)
    force = 1.5e3 / of.scales.force
    assert of.dofs.field("v0", found)[0, 0] == pytest.approx(-force, rel=1e-12)
    assert np.abs(of.dofs.field("p", found)).max() > 1e-3
    assert np.abs(of.dofs.field("l", found)).max() < 1e-12  # min(0, gap) with gap >= 0
