"""Scalars of states simple enough to be worked out by hand."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from scipy.integrate import quad

from porolub.solve.derived import Derived, scalars
from porolub.solve.model import Model
from tests.solve.models import PORES, Array, block, case1, model_of, vector

R, D, ANGLE = 0.1, 1e-3, np.deg2rad(5.0)  # of Case 1: radius, thickness (m), half angle
ARC = 2 * R * ANGLE
ALONG = 30


@contextmanager
def at_rest(*overrides: str) -> Iterator[tuple[Model, Array]]:
    """Case 1 undeformed, nothing pressed: its model and a local, physical state to fill."""
    with model_of(case1(ALONG, 3, *overrides)) as model:
        yield model, np.zeros(model.dofs.size_local)


def set_field(model: Model, local: Array, name: str, values: object) -> None:
    """Set a field: a constant, or an array (nodes,) of values in SI."""
    s = model.scales
    unit = {"u": s.length, "v0": s.length, "p": s.pressure, "l": s.pressure}[name]
    model.dofs.field(name, local)[:, -1] = np.asarray(values) / unit


def angles(model: Model, name: str) -> Array:
    """Angle of a field's nodes from the downward direction."""
    X = model.mesh.coordinates[model.dofs.nodes[name]] * model.scales.length
    return np.arctan2(X[:, 0], R - X[:, 1])


def test_loads_are_integrals_over_the_arc() -> None:
    with at_rest() as (model, local):
        set_field(model, local, "p", 2e4)
        set_field(model, local, "l", 5e4 * np.cos(angles(model, "l")) ** 2)
        found = scalars(model, vector(model, local))
    fluid, solid = 2e4 * ARC, 5e4 * R * (ANGLE + np.sin(2 * ANGLE) / 2)
    assert found["load_fluid"] == pytest.approx(fluid, rel=1e-9)
    assert found["load_solid"] == pytest.approx(solid, rel=1e-9)
    assert found["load_total"] == pytest.approx(fluid + solid, rel=1e-9)
    assert found["load_ratio"] == pytest.approx(fluid / solid, rel=1e-9)
    assert found["load_balance_error"] == pytest.approx(abs(fluid + solid - 1500.0) / 1500.0)


def test_without_contact_pressure_there_is_no_ratio() -> None:
    with at_rest() as (model, local):
        set_field(model, local, "p", 2e4)
        assert scalars(model, vector(model, local))["load_ratio"] is None


def test_gap_and_lengths_of_an_undeformed_cylinder_pressed_in() -> None:
    v0 = 50e-6
    half = np.arccos(1 - v0 / R)  # angle of the chord the plane cuts off
    with at_rest() as (model, local):
        set_field(model, local, "v0", v0)
        theta = angles(model, "l")
        set_field(model, local, "l", np.where(np.abs(theta) < half, 1e4, 0.0))
        found = scalars(model, vector(model, local))
    inside = theta[np.abs(theta) < half]
    assert found["approach"] == pytest.approx(v0)
    assert found["film_min"] == 0.0
    assert found["penetration_length"] == pytest.approx(2 * R * np.sin(half), rel=1e-9)
    assert found["contact_left"] == pytest.approx(R * inside.min(), rel=1e-9)
    assert found["contact_right"] == pytest.approx(R * inside.max(), rel=1e-9)
    assert found["contact_length"] == pytest.approx(
        R * (np.sin(inside.max()) - np.sin(inside.min())), rel=1e-9)
    assert found["contact_pressure_max"] == pytest.approx(1e4)


def test_a_plane_that_is_off_touches_nowhere() -> None:
    with at_rest() as (model, local):
        set_field(model, local, "v0", -3e-6)
        found = scalars(model, vector(model, local))
    assert found["film_min"] == pytest.approx(3e-6, rel=1e-9)
    assert (found["contact_length"], found["penetration_length"]) == (0.0, 0.0)
    assert found["contact_left"] is None
    assert found["contact_right"] is None
    assert found["contact_pressure_max"] == 0.0


def test_a_rigid_lift_of_the_layer_is_a_withdrawal_of_the_plane() -> None:
    with at_rest() as (model, local):
        set_field(model, local, "v0", 40e-6)
        plain = Derived(model, vector(model, local)).gap()
        set_field(model, local, "u", 25e-6)  # in y
        lifted = Derived(model, vector(model, local)).gap()
        arc = model.dofs.nodes["l"]
    np.testing.assert_allclose((lifted - plain)[arc] * D, 25e-6, rtol=1e-9)


@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_friction_is_dry_friction_and_the_shear_of_the_film(speed: float) -> None:
    """T_f = int h/2 |dp/ds| U/|U| + eta |U| / max(h, h_min) ds with the film's own formulas."""
    v0, slope, eta, smallest, mu = -2e-6, 3e6, 1e-3, 1e-7, 0.45
    with at_rest(f"motion.speed={speed} rad/s") as (model, local):
        set_field(model, local, "v0", v0)
        set_field(model, local, "l", 4e4)
        set_field(model, local, "p", 6e4 + slope * R * angles(model, "p"))
        found = scalars(model, vector(model, local))

    def stress(theta: float) -> float:
        h = R * (1 - np.cos(theta)) - v0
        along = np.sign(speed)  # the surface moves in +x when it turns anticlockwise
        return h / 2 * slope * along + eta * abs(speed) * R / max(h, smallest)

    sheared = R * quad(stress, -ANGLE, ANGLE, points=[0.0], epsabs=0, epsrel=1e-10, limit=200)[0]
    solid, fluid = 4e4 * ARC, 6e4 * ARC
    # the film is thin in a few elements only: Gauss points see 1/h to about 1e-3
    assert found["friction_fluid"] == pytest.approx(sheared / fluid, rel=2e-3)
    assert found["friction_coefficient"] == pytest.approx(
        (mu * solid + sheared) / (solid + fluid), rel=1e-4)


def test_an_unloaded_surface_has_no_coefficient_of_friction() -> None:
    with at_rest() as (model, local):
        found = scalars(model, vector(model, local))
    assert found["friction_coefficient"] is None
    assert found["friction_fluid"] is None


SEEPING = {"pores": PORES, "contact": {}, "load": {"approach": "-0.1 mm"}}


def seepage(drop: float) -> dict[str, float | None]:
    """Scalars of a block through which fluid seeps up: p falls linearly by `drop` to 0 on top."""
    with model_of(block(**SEEPING)) as model:
        local = np.zeros(model.dofs.size_local)
        y = model.mesh.coordinates[model.dofs.nodes["p"], 1] * model.scales.length
        set_field(model, local, "p", drop * (1 - y / D))
        return scalars(model, vector(model, local))


def test_flow_through_the_surface_is_darcys() -> None:
    density, mobility, width = 1000.0, 1e-15 / 1e-3, 4e-3
    out = density * mobility * 1e5 / D  # kg/(m^2 s)
    found = seepage(1e5)
    assert found["inflow_left"] == found["inflow_right"] == 0.0
    assert found["outflow_left"] == pytest.approx(out * width / 2, rel=1e-9)
    assert found["outflow_right"] == pytest.approx(out * width / 2, rel=1e-9)
    found = seepage(-1e5)
    assert found["outflow_left"] == found["outflow_right"] == 0.0
    assert found["inflow_left"] == pytest.approx(out * width / 2, rel=1e-9)
    assert found["inflow_right"] == pytest.approx(out * width / 2, rel=1e-9)


def through(bottom: float, top: float, bend: float = 0.0) -> dict[str, float | None]:
    """A block between two prescribed pressures, p linear but for `bend` in the middle."""
    sides = {"bottom": {"pressure": f"{bottom} Pa", "displacement": {"normal": "0 mm"}},
             "top": {"pressure": f"{top} Pa"}}
    with model_of(block(pores=PORES, boundary=sides)) as model:
        local = np.zeros(model.dofs.size_local)
        y = model.mesh.coordinates[model.dofs.nodes["p"], 1]
        set_field(model, local, "p", bottom + (top - bottom) * y + bend * y * (1 - y))
        return scalars(model, vector(model, local))


def test_what_enters_leaves_or_is_missed_in_the_balance() -> None:
    assert through(2e5, 5e4)["mass_balance_error"] < 1e-12
    # bent by B, the slopes at the two ends change by B (1 - 1/3), in and out of three elements
    drop, bend = 1.5e5, 3e4
    extra = bend * 2 / 3  # slope of y (1 - y) over the first third, in thicknesses
    assert through(2e5, 5e4, bend)["mass_balance_error"] == pytest.approx(
        2 * extra / (drop - extra + drop + extra), rel=1e-6)


def test_pressure_extremes_are_those_of_all_nodes() -> None:
    found = through(2e5, 5e4)
    assert (found["pressure_max"], found["pressure_min"]) == (
        pytest.approx(2e5), pytest.approx(5e4))


def test_a_dry_block_has_no_fluid_numbers() -> None:
    with model_of(block(boundary={"top": {"traction": "1 kPa"}})) as model:
        found = scalars(model, model.dofs.vector())
    fluid = ("pressure_max", "pressure_min", "inflow_left", "inflow_right", "outflow_left",
             "outflow_right", "mass_balance_error", "load_ratio", "friction_fluid")
    assert all(found[key] is None for key in fluid)
    assert found["film_min"] is None
    assert found["approach"] is None
