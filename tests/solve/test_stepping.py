"""Steps in time: prescribed values, starts from rest, rejections, replay, films between walls."""

from typing import Any

import numpy as np
import pytest

from tests.physics.stepped import Look, Steps, stepped

G, K = 0.5e6, 2e6  # of the block, Pa
DOWN = 1e-6  # m
PORES = {"biot": 1.0, "permeability": "1e-15 m^2", "viscosity": "1 mPa*s"}


def block(**others: Any) -> dict[str, Any]:
    """A porous block, 2 mm x 1 mm, its sides and bottom on rollers unless overridden."""
    return {
        "geometry": {"shape": "block", "width": "2 mm", "thickness": "1 mm"},
        "mesh": {"along": 3, "across": 3},
        "solid": {"law": "linear", "shear_modulus": f"{G} Pa", "bulk_modulus": f"{K} Pa"},
        "pores": PORES,
        "time": {"end": "0.2 s", "frames": 0},
        **others,
    }


def pressed_down(history: Any) -> dict[str, Any]:
    """The block under a plate that is moved; its right side is free and drained."""
    free = {"traction": "0 Pa", "pressure": "0 Pa"}
    return block(boundary={"top": {"displacement": {"y": history}}, "right": free})


def pressures(look: Look) -> Any:
    return look.pressure()[1]


@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_moving_plate_presses_out_what_the_layer_loses(order: int) -> None:
    """A Newton step does not tell the rows of fluid that a prescribed value will change."""
    moving = {"mean": "0 m", "amplitude": f"{DOWN} m", "frequency": "2 Hz", "shape": "sine"}
    tables = pressed_down(moving)
    tables["time"]["order"] = order
    run = stepped(tables)
    assert run.steps > 15
    assert np.ptp(run["fluid_content"]) > 1e-7
    assert run.fluid_error() < 1e-9


def test_a_plate_that_is_down_at_the_start_has_come_down_on_an_undeformed_layer() -> None:
    """Undrained plane strain under a smooth plate: p = 2 G times the strain, but at the rim."""
    run = stepped(pressed_down(f"{-DOWN} m") | {"mesh": {"along": 12, "across": 1}}, pressures)
    where, _ = run.last().pressure()
    inside = run.seen[0][where[:, 0] < 0.0]
    assert inside == pytest.approx(np.full(len(inside), 2.0 * G * DOWN / 1e-3), rel=1e-3)


@pytest.mark.parametrize("porous", [True, False])
def test_a_plate_under_load_rests_on_contact_alone(porous: bool) -> None:
    """No film holds it up while it comes down: at rest it only touches."""
    tables = block(contact={}, load={"force": "100 N/m"}, mesh={"along": 12, "across": 1})
    if porous:
        tables["boundary"] = {"right": {"traction": "0 Pa", "pressure": "0 Pa"}}
    else:
        del tables["pores"]
    run = stepped(tables)
    assert run["load_total"] == pytest.approx(np.full(run.steps + 1, 100.0), rel=1e-9)
    assert run["load_fluid"][0] == pytest.approx(50.0 if porous else 0.0, abs=2.0)


def film(load: dict[str, Any], **time: Any) -> Steps:
    """A plane over a rigid block 10 mm wide, 0.01 Pa s between them."""
    return stepped({
        "geometry": {"shape": "block", "width": "10 mm", "thickness": "1 mm"},
        "mesh": {"along": 8, "across": 1, "pressure_degree": 2},
        "film": {"viscosity": "10 mPa*s"}, "load": load,
        "time": {"end": "1 s", "frames": 0, **time},
    })


@pytest.mark.parametrize("height", [20e-6, 2e-6])
def test_a_thin_film_between_walls_loses_what_leaves_it(height: float) -> None:
    """Under loads that bring it down at the same pace."""
    force = 100.0 * (20e-6 / height) ** 2
    run = film({"force": f"{force} N/m"}, approach=f"{-height} m")
    assert run["film_min"][-1] < 0.4 * height
    assert run.fluid_error() < 1e-7
