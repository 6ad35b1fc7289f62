"""Mandel's problem: the pressure in the middle rises before it falls.

The plate is a user's: the plane of [contact] under a force, which the layer holds up with fluid
and contact pressure; or the top is moved as the plate would move.
"""

from functools import cache

import numpy as np
import pytest

from tests.physics.mandel import Mandel
from tests.physics.stepped import Look, Steps, stepped

each_plate = pytest.mark.parametrize("plate", ["contact", "moved"])


def middle_and_plate(look: Look) -> tuple[float, float]:
    """p at x = 0 in Pa, u_y of the top in m."""
    where, p = look.pressure()
    highest = look.nodes[:, 1] > look.nodes[:, 1].max() - 1e-9
    return float(p[np.argmin(where[:, 0])]), float(look.displacement()[highest, 1].mean())


@cache
def run(nu: float, plate: str, end: float = 0.5, along: int = 24, order: int = 2,
        tolerance: float = 1e-4) -> Steps:
    tables = Mandel(nu).tables(end, along, plate, order=order, tolerance=tolerance)
    return stepped(tables, middle_and_plate)


def test_textbook_numbers() -> None:
    T = np.linspace(0.02, 0.2, 2000)
    p = Mandel(0.0).centre_pressure(T)
    assert p.max() == pytest.approx(1.15555, abs=1e-5)
    assert T[p.argmax()] == pytest.approx(0.083, abs=5e-4)
    assert Mandel(0.0).centre_pressure(0.5) == pytest.approx(0.70273, abs=1e-5)


@each_plate
@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_pressure_in_the_middle(nu: float, plate: str) -> None:
    exact, found = Mandel(nu), run(nu, plate)
    T, p = found["time"] / exact.tau, found.sight[:, 0] / exact.p0
    late = T > 0.01
    assert p[late] == pytest.approx(exact.centre_pressure(T[late]), abs=1e-3)
    assert p == pytest.approx(exact.centre_pressure(T), abs=1e-2)
    assert p[-1] == pytest.approx(exact.centre_pressure(0.5)[0], abs=6e-4)


@each_plate
def test_the_pressure_rises_before_it_falls(plate: str) -> None:
    found = run(0.0, plate)
    T, p = found["time"] / Mandel(0.0).tau, found.sight[:, 0] / Mandel(0.0).p0
    assert p.max() == pytest.approx(1.15555, abs=1e-3)
    assert T[p.argmax()] == pytest.approx(0.083, abs=0.01)


def test_the_plate_under_its_load_comes_down_as_it_should() -> None:
    exact, found = Mandel(0.0), run(0.0, "contact")
    place = exact.plate(found["time"] / exact.tau)
    drained = exact.plate(10.0)[0]
    assert found.sight[:, 1] == pytest.approx(place, abs=3e-3 * abs(drained))
    assert -found["approach"] == pytest.approx(found.sight[:, 1], abs=1e-9 * abs(drained))
    assert found["load_balance_error"].max() < 1e-12
    assert found["load_fluid"][0] == pytest.approx(0.5 * exact.force, rel=0.02)


@each_plate
def test_profile_of_the_pressure(plate: str) -> None:
    exact = Mandel(0.3)
    where, p = run(0.3, plate).last().pressure()
    x = where[:, 0] - where[:, 0].min()
    assert p / exact.p0 == pytest.approx(exact.profile(x, 0.5), abs=5e-4)


def test_order_in_space() -> None:
    """Linear pressure at T = 0.1, in the middle: order 2."""
    exact = Mandel(0.0).centre_pressure(0.1)[0]
    found = [run(0.0, "contact", 0.1, n, 3, 1e-6).sight[-1, 0] for n in (6, 12)]
    errors = np.abs(np.array(found) / Mandel(0.0).p0 - exact)
    assert np.all(np.log2(errors[:-1] / errors[1:]) > 1.9), errors


@each_plate
def test_no_fluid_appears_or_vanishes(plate: str) -> None:
    assert run(0.0, plate).fluid_error() < 1e-9
