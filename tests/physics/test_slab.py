"""A slice of a straight barrel between two symmetry planes is the plane problem."""

from typing import Any

import pytest

from tests.physics.rolling import rolling
from tests.physics.solved import solved

WIDTH = 0.7e-3  # m
SAME = 1e-6  # relative
PER_WIDTH = ("load_total", "load_solid", "load_fluid", "inflow_left", "inflow_right",
             "outflow_left", "outflow_right")
AS_THEY_ARE = ("load_ratio", "friction_coefficient", "friction_fluid", "approach",
               "contact_length", "contact_left", "contact_right", "penetration_length",
               "pressure_max", "pressure_min", "contact_pressure_max")
SCENES: dict[str, dict[str, Any]] = {
    "sliding base": {},
    "bonded base, friction shears": {"base": "bonded", "friction": True, "speed": 0.3},
    "sliding plane": {"motion": {"kind": "sliding", "speed": "0.02 m/s"},
                      "pores": {"carry": False}},
    "material frame, paper's traction": {"conventions": {"frame": "material"},
                                         "traction": "paper"},
}


@pytest.mark.parametrize("name", SCENES)
def test_a_slab_is_the_plane_problem(name: str) -> None:
    """Film, contact, motion and load balance on; the same numbers per width."""
    plane = rolling(40, 3, **SCENES[name])
    slab = rolling(40, 3, **SCENES[name])
    slab["scene"] = {"dimension": 3}
    slab["geometry"] |= {"shape": "barrel", "width": f"{WIDTH} m"}
    slab["mesh"]["deep"] = 2
    slab["load"] = {"force": f"{1500.0 * WIDTH} N"}
    flat, solid = solved(plane).values, solved(slab).values
    assert flat["contact_length"] > 5e-3
    for key in PER_WIDTH:
        assert solid[key] == pytest.approx(flat[key] * WIDTH, rel=SAME, abs=1e-12), key
    for key in AS_THEY_ARE:
        assert solid[key] == pytest.approx(flat[key], rel=SAME), key
