"""What holds in every scene, to solver tolerance: load, fluid mass, contact, J, mirror symmetry.

Case 1 and its relatives on small meshes: both laws, bases and conventions, with and without
friction on the skeleton, both senses of rotation; a sliding plane (Appendix A).  The load is
checked once more from the stresses: what acts on the surface arrives at the bone.
"""

from functools import cache
from typing import Any

import numpy as np
import pytest

from porolub.solve.derived import Derived
from tests.physics.rolling import rolling
from tests.physics.solved import Solved, solved

CASES: dict[str, dict[str, Any]] = {
    "case 1": {},
    "paper's surface traction": {"traction": "paper"},
    "material frame": {"conventions": {"frame": "material", "surface_traction": "balanced"}},
    "linear law": {"solid": {"law": "linear"}},
    "bonded": {"base": "bonded"},
    "bonded, linear, friction": {"base": "bonded", "solid": {"law": "linear"}, "friction": True},
    "bonded, friction": {"base": "bonded", "friction": True},
    "triangles": {"mesh": {"element": "triangle"}},
    "equal degrees": {"mesh": {"pressure_degree": 2}},
    "light": {"load": {"force": "0.3 kN/m"}},
    "heavy and fast": {"load": {"force": "3 kN/m"}, "speed": 2.0},
}
MIRRORED = ["case 1", "bonded", "bonded, friction", "linear law"]


@cache
def case(name: str, sense: float = 1.0) -> Solved:
    keys = dict(CASES[name])
    return solved(rolling(speed=sense * keys.pop("speed", 1.0), **keys))


@cache
def sliding_plane(sense: float = 1.0) -> Solved:
    tables = rolling(pores={"carry": False})
    tables["motion"] = {"kind": "sliding", "speed": f"{sense * 0.1} m/s"}
    return solved(tables)


def everything(s: Solved) -> None:
    """The balances and inequalities of one solved scene."""
    model, values = s.outcome.model, s.values
    assert values["load_balance_error"] < 1e-8
    assert values["mass_balance_error"] < 1e-8
    d = Derived(model, s.outcome.x)
    assert d.gap()[d.mine].min() * model.scales.length >= -1e-9
    assert s.surface.p_c.min() >= -1e-9 * s.surface.p_c.max()
    closed = s.surface.p_c > 1e-9 * s.surface.p_c.max()
    assert closed.any()
    assert s.surface.h[closed].max() < 1e-9
    assert s.fields.jacobian.min() > 0.0
    assert d.at(model.system.domains["cells"]).deformation.J.min() > 0.0
    assert values["load_solid"] + values["load_fluid"] == pytest.approx(values["load_total"])


@pytest.mark.parametrize("name", CASES)
def test_rolling(name: str) -> None:
    everything(case(name))


def test_sliding_plane() -> None:
    everything(sliding_plane())


def mirrored(forth: Solved, back: Solved) -> None:
    a, b = forth.surface, back.surface
    for name, sign in (("p", 1), ("p_c", 1), ("h", 1), ("V", 1), ("Q", -1)):
        one, other = getattr(a, name), sign * getattr(b, name)[::-1]
        assert other == pytest.approx(one, abs=1e-6 * np.abs(one).max()), name
    same = ("load_solid", "load_fluid", "approach", "friction_coefficient", "contact_length")
    for name in same:
        assert back.values[name] == pytest.approx(forth.values[name], rel=1e-8), name
    size = max(forth.values["inflow_left"], forth.values["inflow_right"])
    for flow in ("inflow", "outflow"):
        for one, other in (("left", "right"), ("right", "left")):
            assert back.values[f"{flow}_{one}"] == pytest.approx(
                forth.values[f"{flow}_{other}"], abs=1e-6 * size)


@pytest.mark.parametrize("base", ["sliding", "bonded"])
def test_rolling_without_a_film(base: str) -> None:
    tables = rolling(base=base)
    del tables["film"]
    everything(solved(tables))


def test_pressing_without_motion_drains() -> None:
    """At rest no pressure is left in a steady state, and the skeleton carries all."""
    tables = rolling(pores={"carry": False})
    del tables["film"], tables["motion"]
    s = solved(tables)
    assert s.values["load_solid"] == pytest.approx(1500.0, rel=1e-9)
    assert s.fields.pressure is not None
    assert np.abs(s.fields.pressure).max() < 1e-6 * s.surface.p_c.max()


@pytest.mark.parametrize("name", MIRRORED)
def test_the_other_sense_of_rotation_is_the_mirror_image(name: str) -> None:
    mirrored(case(name), case(name, -1.0))


def test_the_other_sense_of_sliding_is_the_mirror_image() -> None:
    mirrored(sliding_plane(), sliding_plane(-1.0))


def surface_force(s: Solved) -> float:
    """Vertical force of contact and fluid on the deformed surface, by its own quadrature."""
    model, d = s.outcome.model, Derived(s.outcome.model, s.outcome.x)
    at = d.surface
    share = model.scene.pores.biot if "paper" in model.scene.conventions.surface_traction else 1.0
    normal = at.normal
    if model.scene.conventions.frame == "spatial":
        normal = np.einsum("...ij,...j->...i", at.deformation.cof, normal)
    fluid = -(at.weights * share * at.value("p") * normal[..., 1]).sum() * model.scales.force
    return s.values["load_solid"] + float(fluid)


@pytest.mark.parametrize("name", ["case 1", "paper's surface traction", "material frame", "bonded"])
def test_load_on_the_surface_arrives_at_the_bone(name: str) -> None:
    """Reaction of bone and ends, from the stresses alone, against the force on the surface."""
    s = case(name)
    system, dofs = s.outcome.model.system, s.outcome.model.dofs
    local = system.physical(dofs.to_local(s.outcome.x))
    stresses = system.local_residual(local, {"skeleton", "pores"})[dofs.range["u"]].reshape(-1, 2)
    off = np.isin(dofs.nodes["u"], s.outcome.model.mesh.boundary_nodes("lubricated"), invert=True)
    reaction = stresses[off, 1].sum() * s.outcome.model.scales.force
    assert abs(reaction) == pytest.approx(surface_force(s), rel=5e-4)


def test_load_that_is_counted_and_load_that_acts() -> None:
    """Equal to the cosine of the arc where p acts on the undeformed surface (material frame).

    On the deformed one it acts on a surface stretched by the contact: 3 % more in Case 1.
    """
    material, spatial = case("material frame"), case("case 1")
    assert surface_force(material) == pytest.approx(1500.0, rel=2e-3)
    assert 1.01 < surface_force(spatial) / 1500.0 < 1.05
