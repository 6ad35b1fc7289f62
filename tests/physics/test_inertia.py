"""A block that is struck on its top, base and sides on rollers: waves, ringing, lost energy.

With inertia u_tt = c^2 u_yy, c = sqrt(M/rho): a push s(t) on the top makes
    u(y, t) = -1/(rho c) sum_k (-1)^k [S(t - (2k d + d - y)/c) - S(t - (2k d + d + y)/c)],
S the integral of s (d'Alembert, base fixed).  Left to itself the top is back after 4 d/c, and
upside down after half of that.  M is K + 4G/3 in a dry block; where the pores are closed it is
that plus a^2/S, S the storage coefficient.

BDF damps: with N steps a period an amplitude falls by exp(-2 pi^2/N) (order 1) or by
exp(-pi/2 (2 pi/N)^3) (order 2) in each period; order 3 would let it grow and is refused.
"""

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from porolub.scene import scene_from_dict
from tests.physics.stepped import Look, Steps, fixed, stepped

Array = NDArray[np.float64]
BULK, SHEAR, DENSITY, THICKNESS = 1e6, 0.6e6, 1100.0, 1e-3
DRY = BULK + 4.0 * SHEAR / 3.0  # Pa
PUSH = 1e3  # Pa
CLOSED = {"biot": 0.9, "permeability": "1e-18 m^2", "viscosity": "1 mPa*s", "storage": "0.1 1/MPa"}
UNDRAINED = DRY + 0.9**2 / 0.1e-6  # Pa


def period(modulus: float, thickness: float = THICKNESS) -> float:
    """4 d/c, s."""
    return 4.0 * thickness * float(np.sqrt(DENSITY / modulus))


def block(traction: Any, end: float, across: int = 12, pores: Any = None,
          thickness: float = THICKNESS, **time: Any) -> dict[str, Any]:
    """``end`` in s."""
    tables = {
        "geometry": {"shape": "block", "width": f"{thickness / 2} m",
                     "thickness": f"{thickness} m"},
        "mesh": {"along": 1, "across": across},
        "solid": {"law": "linear", "shear_modulus": f"{SHEAR} Pa", "bulk_modulus": f"{BULK} Pa",
                  "density": f"{DENSITY} kg/m^3", "inertia": True},
        "boundary": {"top": {"traction": traction}},
        "time": {"end": f"{end!r} s", "frames": 0, **time},
    }
    return tables if pores is None else tables | {"pores": pores}


def pulse(length: float) -> dict[str, Any]:
    """A smooth push, PUSH sin^2, of that length in s; it ends with no kink."""
    t = np.append(np.linspace(0.0, length, 33), 100.0 * length)
    values = PUSH * np.sin(np.pi * t / length) ** 2
    values[-2:] = 0.0
    return {"times": [f"{v!r} s" for v in t.tolist()], "interpolation": "smooth",
            "values": [f"{v!r} Pa" for v in values.tolist()]}


def impulse(t: Array, length: float) -> Array:
    """Integral of PUSH sin^2 over time up to t, Pa s."""
    inside = np.clip(t, 0.0, length)
    return PUSH * (inside / 2.0 - length / (4.0 * np.pi) * np.sin(2.0 * np.pi * inside / length))


def dalembert(y: float, t: Array, modulus: float, length: float) -> Array:
    """u(y, t) after that pulse, m."""
    c = np.sqrt(modulus / DENSITY)
    u = np.zeros_like(t)
    for k in range(40):
        reflected = 2.0 * k * THICKNESS + THICKNESS
        u += (-1) ** k * (impulse(t - (reflected - y) / c, length)
                          - impulse(t - (reflected + y) / c, length))
    return -u / (DENSITY * c)


def line(look: Look) -> Array:
    """(3, n): height, u_y and its velocity along a vertical line of nodes, upwards; SI."""
    s, nodes = look.model.scales, look.nodes
    side = np.flatnonzero(nodes[:, 0] < nodes[:, 0].min() + 1e-9)
    side = side[np.argsort(nodes[side, 1])]
    speed = look.derived.nodal("w")[side, 1] * s.length / s.time
    return np.array([nodes[side, 1], look.displacement()[side, 1], speed])


@cache
def struck(modulus: float, share: float, periods: float, count: int, across: int,
           order: int = 2) -> tuple[Steps, Array, Array]:
    """By a pulse as long as a share of the period, with ``count`` steps a period: t, what is seen.
    """
    unit = period(modulus)
    pores = CLOSED if modulus == UNDRAINED else None
    tables = block(pulse(share * unit), periods * unit, across, pores, order=order)
    run = fixed(tables, round(periods * count), look=line)
    return run, run["time"], run.sight


@pytest.mark.parametrize("modulus", [DRY, UNDRAINED])
def test_a_wave_runs_up_and_down(modulus: float) -> None:
    """At the top, and half way up where it passes at d/(2c), 3d/(2c), ..."""
    share = 0.25
    _, t, seen = struck(modulus, share, 1.0, 200, 12)
    size = PUSH * THICKNESS / modulus
    for y in (0.5 * THICKNESS, THICKNESS):
        k = int(np.argmin(np.abs(seen[0, 0] - y)))
        exact = dalembert(y, t, modulus, share * period(modulus))
        assert np.abs(exact).max() > 0.4 * size
        assert seen[:, 1, k] == pytest.approx(exact, abs=1.5e-2 * size)


@pytest.mark.parametrize("modulus", [DRY, UNDRAINED])
def test_speed_of_the_wave(modulus: float) -> None:
    """The push needs d/(2c) from the top to the middle: when does half of it get there?"""
    _, t, seen = struck(modulus, 0.125, 0.4, 400, 20)
    middle = seen.shape[2] // 2
    rising = t < 0.35 * period(modulus)
    when = []
    for k in (middle, -1):
        u = -seen[rising, 1, k]
        after = int(np.argmax(u > 0.5 * u.max()))
        when.append(np.interp(0.5 * u.max(), u[after - 1 : after + 1], t[after - 1 : after + 1]))
    travelled = (when[0] - when[1]) * np.sqrt(modulus / DENSITY)
    assert travelled == pytest.approx(0.5 * THICKNESS, rel=1e-2)


def test_period_of_free_vibration() -> None:
    """After a long push the block rings: zero crossings of the top are 2 d/c apart.

    In BDF of order 2 it rings slower by a third of (2 pi/N)^2, N steps a period.
    """
    _, t, seen = struck(DRY, 1.0, 4.0, 64, 6)
    free = t > 1.1 * period(DRY)
    t, u = t[free], seen[free, 1, -1]
    k = np.flatnonzero(u[:-1] * u[1:] < 0.0)
    crossings = t[k] - u[k] * (t[k + 1] - t[k]) / (u[k + 1] - u[k])
    mean = (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    assert len(crossings) >= 5
    assert mean == pytest.approx(0.5 * period(DRY), rel=5e-3)
    slower = 1.0 + (2.0 * np.pi / 64) ** 2 / 3.0
    assert mean == pytest.approx(0.5 * period(DRY) * slower, rel=5e-4)


@pytest.mark.slow
@pytest.mark.parametrize(("order", "largest"), [(1, 0.25), (2, 0.03)])
def test_orders_in_time(order: int, largest: float) -> None:
    """From rest, over two periods, at the top; against a pulse that begins with no slope."""
    errors = []
    for count in (100, 200):
        _, t, seen = struck(DRY, 1.0, 2.0, count, 10, order)
        exact = dalembert(THICKNESS, t, DRY, period(DRY))
        errors.append(np.abs(seen[:, 1, -1] - exact).max() / np.abs(exact).max())
    assert np.log2(errors[0] / errors[1]) > (0.8 if order == 1 else 1.9), errors
    assert errors[0] < largest


def energy(y: Array, u: Array, v: Array) -> float:
    """Kinetic and elastic, J/m^2: three Gauss points in each quadratic element."""
    g, w = np.sqrt(0.6) * np.array([-1.0, 0.0, 1.0]), np.array([5.0, 8.0, 5.0]) / 9.0
    value = np.stack([g * (g - 1.0) / 2.0, 1.0 - g * g, g * (g + 1.0) / 2.0])
    slope = np.stack([g - 0.5, -2.0 * g, g + 0.5])
    total = 0.0
    for e in range(0, len(y) - 2, 2):
        h, own = y[e + 2] - y[e], slice(e, e + 3)
        density = DENSITY * (v[own] @ value) ** 2 + DRY * (2.0 / h * u[own] @ slope) ** 2
        total += h / 4.0 * float(w @ density)
    return total


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("count", [32, 64])
def test_energy_decays_as_the_scheme_damps(order: int, count: int) -> None:
    """One gentle push as long as a period leaves little but the lowest vibration."""
    _, t, seen = struck(DRY, 1.0, 4.0, count, 6, order)
    held = np.array([energy(*s) for s in seen])
    T = t / period(DRY)
    first, last = (int(np.argmin(np.abs(T - at))) for at in (1.5, 3.5))
    left = np.sqrt(held[last] / held[first])  # of a cycle
    theta = 2.0 * np.pi / count
    expected = np.exp(-2.0 * np.pi * theta) if order == 1 else np.exp(-np.pi * theta**3)
    assert np.log(left) == pytest.approx(np.log(expected), rel=0.1)
    assert np.all(np.diff(held[T > 1.01]) < 0.0), "nothing is gained"


def test_steps_do_not_depend_on_the_size_of_the_block() -> None:
    """A run that is short beside the program's unit of time is controlled by its error too."""
    counts = []
    for thickness in (1e-3, 1e-5):
        unit = period(DRY, thickness)
        run = stepped(block(pulse(unit), unit, 4, thickness=thickness, tolerance=1e-3))
        counts.append(run.steps)
    assert counts[0] == counts[1] > 40


def test_a_slow_push_feels_no_inertia() -> None:
    """Ten thousand periods long: u_top = -s d/M at every moment."""
    push = {"mean": "0 Pa", "amplitude": f"{PUSH} Pa", "frequency": f"{1e-4 / period(DRY)!r} Hz"}
    run = stepped(block(push, 0.25e4 * period(DRY), 2, tolerance=1e-2), line)
    t, top = run["time"], run.sight[:, 1, -1]
    exact = -PUSH * THICKNESS / DRY * np.sin(2e-4 * np.pi * t / period(DRY))
    assert top == pytest.approx(exact, abs=1e-3 * PUSH * THICKNESS / DRY)


def test_where_it_is_not_asked_for_there_is_none() -> None:
    """Density alone adds no unknown: a sudden push is answered at once."""
    tables = block(f"{PUSH} Pa", 1.0)
    del tables["solid"]["inertia"]
    assert scene_from_dict(tables).solid.density == DENSITY
    run = stepped(tables, lambda look: look.displacement()[:, 1].min())
    assert run.seen == pytest.approx([-PUSH * THICKNESS / DRY] * len(run.seen), rel=1e-9)
