"""Fluid over time, counted twice: as the program counts it and from displacements and flows alone.

fluid_content and fluid_gained agree as well as Newton solves, whatever the steps do, because what
is stored is what is differenced.  Counted independently: pores hold a (deformed area - area), a
film the integral of its thickness, and what flows between them over time is the integral of in-
and outflow, to the accuracy of the steps.
"""

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from porolub.solve.gather import gather_surface
from tests.physics.stepped import Look, Steps, stepped

Array = NDArray[np.float64]
DENSITY, BIOT = 1000.0, 0.9
POROUS: dict[str, Any] = {
    "geometry": {"shape": "block", "width": "4 mm", "thickness": "1 mm"},
    "mesh": {"along": 8, "across": 3},
    "solid": {"law": "neo-hookean", "shear_modulus": "0.5 MPa", "bulk_modulus": "5 MPa"},
    "pores": {"biot": BIOT, "permeability": "1e-15 m^2", "viscosity": "1 mPa*s"},
}
DRAINED = {"pressure": "0 Pa"}


def jerked(order: int, tolerance: float = 1e-3) -> Steps:
    """The load ramps, rests, and drops within a millisecond; the top is drained."""
    ramps = {"times": ["0 s", "0.2 s", "0.4 s", "0.401 s", "0.6 s"],
             "values": ["0 MPa", "0.5 MPa", "0.5 MPa", "0.05 MPa", "0.3 MPa"]}
    return stepped(POROUS | {
        "mesh": {"along": 1, "across": 6},
        "boundary": {"top": {"traction": ramps, **DRAINED}},
        "time": {"end": "0.8 s", "frames": 0, "order": order, "tolerance": tolerance,
                 "first_step": "50 ms"},
    })


@pytest.mark.parametrize("order", [1, 2, 3])
def test_balance_across_kinks_and_steps_taken_back(order: int) -> None:
    run = jerked(order)
    assert len(run.rejections) > 0
    assert set(run["order"][1:]) == {1: {1.0}, 2: {2.0}, 3: {2.0, 3.0}}[order]
    assert run["rejected_steps"].sum() == len(run.rejections)
    assert np.ptp(run["fluid_content"]) > 1e-5
    assert run.fluid_error() < 1e-9


@pytest.mark.parametrize("sides", [("top",), ("left", "right"), ("top", "bottom", "left")])
def test_balance_with_several_drained_sides(sides: tuple[str, ...]) -> None:
    """Sides on rollers that drain, under a load that swings."""
    swing = {"mean": "0.1 MPa", "amplitude": "0.1 MPa", "frequency": "4 Hz", "shape": "cosine"}
    boundary: dict[str, Any] = {side: {"displacement": {"normal": "0 m"}, **DRAINED}
                                for side in sides if side != "top"}
    boundary["top"] = {"traction": swing, **(DRAINED if "top" in sides else {})}
    run = stepped(POROUS | {"boundary": boundary, "time": {"end": "0.5 s", "frames": 0}})
    assert run.fluid_error() < 2e-8


def around(look: Look) -> Array:
    """Nodes of the block's boundary, against the clock, beginning in a corner (quadratic edges)."""
    X, low, high = look.nodes, look.nodes.min(axis=0), look.nodes.max(axis=0)
    near = 1e-9 * np.abs(high - low).max()
    legs = [(1, low, 0, 1), (0, high, 1, 1), (1, high, 0, -1), (0, low, 1, -1)]
    chain: list[int] = []
    for fixed, at, along, sign in legs:
        side = np.flatnonzero(np.abs(X[:, fixed] - at[fixed]) < near)
        chain += side[np.argsort(sign * X[side, along])][:-1].tolist()
    return np.array([*chain, chain[0]])


def area(x: Array) -> float:
    """Of a closed chain of quadratic edges (corner, middle, corner, ...), exactly."""
    a, b, c = x[:-2:2], x[1:-1:2], x[2::2]
    cross = [p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] for p, q in ((a, b), (b, c), (a, c))]
    return float((4.0 * cross[0] + 4.0 * cross[1] - cross[2]).sum() / 6.0)


def pores_and_film(look: Look) -> tuple[float, float]:
    """Fluid in the pores beyond the undeformed layer's and in the film, kg/m."""
    ring = around(look)
    X = look.nodes[ring]
    grown = area(X + look.displacement()[ring]) - area(X)
    surface = gather_surface(look.model, look.solver.stepper.x)
    assert surface is not None
    h, s = surface.h, surface.s
    film = ((s[2::2] - s[:-2:2]) * (h[:-2:2] + 4.0 * h[1:-1:2] + h[2::2]) / 6.0).sum()
    return DENSITY * BIOT * grown, DENSITY * float(film)


def test_areas_of_quadratic_edges() -> None:
    """A circle of radius 1 with four curved edges, each a parabola: 8/3 (2 sqrt 2 - 1) - 2."""
    angle = np.linspace(0.0, 2.0 * np.pi, 9)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    assert area(circle) == pytest.approx(2.0 + 8.0 / 3.0 * (np.sqrt(2.0) - 1.0), rel=1e-12)


@cache
def pumped(tolerance: float) -> Steps:
    """A plane above a film breathes from 26 to 14 um: the film feeds the layer and drains it."""
    breath = {"mean": "-20 um", "amplitude": "-6 um", "frequency": "5 Hz", "shape": "cosine"}
    return stepped(POROUS | {
        "film": {"viscosity": "10 mPa*s"}, "load": {"approach": breath},
        "time": {"end": "0.2 s", "frames": 0, "tolerance": tolerance},
    }, pores_and_film)


def test_content_is_what_pores_and_film_hold() -> None:
    run = pumped(1e-3)
    held = run.sight.sum(axis=1)
    size = np.ptp(run["fluid_content"])
    assert size > 1e-6
    assert run["fluid_content"] == pytest.approx(held - held[0], abs=1e-8 * size)
    assert run["fluid_gained"] == pytest.approx(held - held[0], abs=2e-6 * size)


@pytest.mark.parametrize(("tolerance", "within"), [
    (1e-3, 2e-2), pytest.param(1e-4, 5e-3, marks=pytest.mark.slow)])
def test_what_flows_between_pores_and_film_over_time(tolerance: float, within: float) -> None:
    """Outflow is counted out of the layer; a monotone cubic through the steps is integrated."""
    run = pumped(tolerance)
    out = sum(run[f"outflow_{side}"] - run[f"inflow_{side}"] for side in ("left", "right"))
    held = run.sight[:, 0]
    lost = PchipInterpolator(run["time"], out).antiderivative()(run["time"])
    assert np.ptp(held) > 1e-7
    assert held[0] - held == pytest.approx(lost, abs=within * np.ptp(held))
