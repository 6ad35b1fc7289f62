"""Squeeze films between rigid surfaces that approach each other at V: closed forms in time.

Parallel plates of width L: W = eta V L^3/h^3.  Cylinder over a plane, long arc:
W = 3 sqrt(2) pi eta V (R/h0)^(3/2); on an arc with p = 0 at its ends p' = -12 eta V s/h^3.
Under a constant load the plates keep 1/h^2 = 1/h0^2 + 2 W t/(eta L^3).  The film's pressure and
the approach are the only unknowns.  V is a difference in time of the film's content, so under a
given approach a smooth history shows the scheme's error, a ramp none.
"""

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from tests.physics.stepped import Steps, stepped

Array = NDArray[np.float64]
ETA, LENGTH, RADIUS = 0.01, 0.01, 0.1  # Pa s, m, m


def plates(load: dict[str, Any], degree: int = 2, **time: Any) -> Steps:
    return stepped({
        "geometry": {"shape": "block", "width": f"{LENGTH} m", "thickness": "1 mm"},
        "mesh": {"along": 8, "across": 1, "pressure_degree": degree},
        "film": {"viscosity": f"{ETA} Pa*s"},
        "load": load,
        "time": {"end": "1 s", "frames": 0, **time},
    })


def plate_load(h: Array, V: Array | float) -> Array:
    return ETA * V * LENGTH**3 / h**3


def breathing(mean: float, amplitude: float) -> dict[str, Any]:
    """An approach that turns, 1 Hz."""
    return {"mean": f"{-mean} m", "amplitude": f"{amplitude} m", "frequency": "1 Hz",
            "shape": "sine"}


def breath(t: Array, mean: float, amplitude: float) -> tuple[Array, Array]:
    """Its film h and speed V = -dh/dt."""
    angle = 2.0 * np.pi * t
    return mean - amplitude * np.sin(angle), 2.0 * np.pi * amplitude * np.cos(angle)


def test_plates_on_a_ramp() -> None:
    """From 20 to 5 um and on to 4 um: V is 20, then 2 um/s; a step ends where it changes."""
    ramp = {"times": ["0 s", "0.5 s", "1 s"], "values": ["-20 um", "-5 um", "-4 um"]}
    run = plates({"approach": ramp})
    t = run["time"]
    assert np.abs(t - 0.5).min() < 1e-12
    h = np.interp(t, [0.0, 0.5, 1.0], [20e-6, 5e-6, 4e-6])
    V = np.where(t < 0.5 + 1e-9, 30e-6, 2e-6)
    assert run["load_fluid"] == pytest.approx(plate_load(h, V), rel=1e-6)
    assert run["film_min"] == pytest.approx(h, rel=1e-9)
    assert run["pressure_max"] == pytest.approx(1.5 * run["load_fluid"] / LENGTH, rel=1e-6)


def test_linear_pressure_is_exact_at_the_nodes_only() -> None:
    """Of a parabola 8 elements lose 1/64 of the load."""
    run = plates({"approach": {"times": ["0 s", "1 s"], "values": ["-20 um", "-10 um"]}}, 1)
    W = plate_load(run["film_min"], 10e-6)
    assert run["load_fluid"] == pytest.approx(W * (1.0 - 1.0 / 64.0), rel=1e-6)


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_plates_that_turn(order: int, tolerance: float) -> None:
    """The film carries when it closes and sucks when it opens; steps follow the tolerance."""
    run = plates({"approach": breathing(15e-6, 5e-6)}, tolerance=tolerance, order=order)
    exact = plate_load(*breath(run["time"], 15e-6, 5e-6))
    assert np.abs(run["load_fluid"] - exact).max() < 20.0 * tolerance * exact.max()
    assert run["load_fluid"].min() < -0.5 * exact.max()
    assert run.fluid_error() < 1e-9


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_plates_under_a_load(tolerance: float) -> None:
    force, h0 = 100.0, 20e-6
    run = plates({"force": f"{force} N/m"}, tolerance=tolerance, approach=f"{-h0} m")
    exact = 1.0 / np.sqrt(1.0 / h0**2 + 2.0 * force * run["time"] / (ETA * LENGTH**3))
    assert exact[-1] < h0 / 2.9
    assert -run["approach"] == pytest.approx(exact, abs=8.0 * tolerance * h0)
    assert run.fluid_error() < 1e-7


HALF = 10.0 * np.sqrt(2.0 * RADIUS * 10e-6)  # of the arc, m


@cache
def cylinder(tolerance: float = 1e-4) -> Steps:
    """Over a plane that breathes between 5 and 15 um."""
    return stepped({
        "geometry": {"shape": "sector", "outer_radius": f"{RADIUS} m", "thickness": "1 mm",
                     "half_angle": f"{HALF / RADIUS} rad"},
        "mesh": {"along": 80, "across": 1, "pressure_degree": 2},
        "film": {"viscosity": f"{ETA} Pa*s"},
        "load": {"approach": breathing(10e-6, 5e-6)},
        "time": {"end": "1 s", "frames": 0, "tolerance": tolerance},
    })


def arc_load(h0: float, V: float) -> float:
    """Of the finite arc, N/m."""
    s = np.linspace(-HALF, HALF, 40001)
    h = h0 + 2.0 * RADIUS * np.sin(s / RADIUS / 2.0) ** 2
    p = cumulative_trapezoid(-12.0 * ETA * V * s / h**3, s, initial=0.0)
    return float(cumulative_trapezoid(p, s)[-1])


def test_cylinder_at_several_times() -> None:
    """Of an approach that speeds up, slows down, and turns."""
    run = cylinder()
    h0, V = breath(run["time"], 10e-6, 5e-6)
    exact = np.array([arc_load(*pair) for pair in zip(h0, V, strict=True)])
    assert run["load_fluid"] == pytest.approx(exact, abs=1e-2 * exact.max())
    assert run["film_min"] == pytest.approx(h0, rel=1e-9)


def test_cylinder_has_the_load_of_the_textbook() -> None:
    run = cylinder()
    h0, V = breath(run["time"], 10e-6, 5e-6)
    exact = 3.0 * np.sqrt(2.0) * np.pi * ETA * V * (RADIUS / h0) ** 1.5
    assert run["load_fluid"] == pytest.approx(exact, abs=1.2e-2 * exact.max())
