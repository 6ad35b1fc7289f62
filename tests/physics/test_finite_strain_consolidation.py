"""A porous block crushed to half its height: the drained limit and the way there.

With l the stretch and k the spatial mobility, 1D: a l_t = d_Z[(k/l) p_Z] and P(l) - a p = -s at
every moment, a the Biot coefficient; so a^2 l_t = d_Z[(k/l) d_Z P(l)], with P(l) = -s at the
drained top (Z = d) and no flow at the base.  In the material frame k/l is k.  That equation is
solved here by finite volumes and scipy, on cells that grow finer toward the top; P is the closed
form of test_confined_compression.
"""

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.sparse import diags

from tests.physics.consolidation import settlement
from tests.physics.stepped import Steps, stepped

Array = NDArray[np.float64]
SHEAR, BULK, THICKNESS, MOBILITY = 0.5e6, 5e6, 1e-3, 1e-12


def stress(stretch: Any, biot: float) -> Any:
    """Effective nominal stress P(l), tension positive, Pa."""
    iso = 2.0 * biot * SHEAR / 3.0 * (stretch ** (1.0 / 3.0) - stretch ** (-5.0 / 3.0))
    return iso + (1.0 - biot) * BULK * (stretch - 1.0)


def time_unit(biot: float) -> float:
    """Consolidation time of small strains, s."""
    modulus = 4.0 * biot * SHEAR / 3.0 + (1.0 - biot) * BULK
    return biot**2 * THICKNESS**2 / (MOBILITY * modulus)


def reference(times: Array, biot: float, final: float, spatial: bool, cells: int = 400) -> Array:
    """Stretch (cells, n) of the cells of `grid` at the times (n,), s."""
    _, heights, centres = grid(cells)
    apart = np.append(np.diff(centres), THICKNESS - centres[-1])
    top = stress(final, biot)

    def rate(_: float, stretch: Array) -> Array:
        P = np.append(stress(stretch, biot), top)
        between = (np.append(stretch[1:], final) + stretch) / 2.0
        flow = MOBILITY * np.diff(P) / apart / (between if spatial else 1.0)
        return np.diff(np.append(0.0, flow)) / heights / biot**2

    band = diags([np.ones(cells - 1), np.ones(cells), np.ones(cells - 1)], [-1, 0, 1])
    found = solve_ivp(rate, (0.0, times[-1]), np.ones(cells), "BDF", times, rtol=1e-7, atol=1e-9,
                      jac_sparsity=band)
    assert found.success, found.message
    return np.asarray(found.y)


def grid(cells: int) -> tuple[Array, Array, Array]:
    """Faces, heights and centres of the cells, m."""
    faces = THICKNESS * (1.0 - (1.0 - np.linspace(0.0, 1.0, cells + 1)) ** 2)
    return faces, np.diff(faces), (faces[1:] + faces[:-1]) / 2.0


def settled(stretch: Array) -> Array:
    """Settlement of the top (n,), m."""
    _, heights, _ = grid(len(stretch))
    return (1.0 - stretch).T @ heights


@cache
def crushed(biot: float, final: float, across: int = 24, frame: str = "spatial",
            order: int = 2, tolerance: float = 1e-3, end: float = 3.0) -> Steps:
    """Under the load that brings it to the stretch ``final``; ``end`` in its time unit."""
    return stepped({
        "geometry": {"shape": "block", "width": "0.5 mm", "thickness": f"{THICKNESS} m"},
        "mesh": {"along": 1, "across": across},
        "solid": {"law": "neo-hookean", "shear_modulus": f"{SHEAR} Pa",
                  "bulk_modulus": f"{BULK} Pa"},
        "pores": {"biot": biot, "permeability": f"{MOBILITY * 1e-3} m^2", "viscosity": "1 mPa*s"},
        "conventions": {"frame": frame},
        "boundary": {"top": {"traction": f"{-stress(final, biot)} Pa", "pressure": "0 Pa"}},
        "time": {"end": f"{end * time_unit(biot)!r} s", "frames": 0, "order": order,
                 "tolerance": tolerance},
    }, settlement)


def off(run: Steps, biot: float, final: float, spatial: bool = True) -> Array:
    """Error of the settlement at all steps over the thickness."""
    exact = settled(reference(run["time"], biot, final, spatial))
    return np.abs(run.sight - exact) / THICKNESS


def test_the_reference_is_fine_enough() -> None:
    t = np.linspace(0.01, 1.0, 20) * time_unit(0.9)
    coarse, fine = (settled(reference(t, 0.9, 0.5, True, n)) for n in (200, 400))
    assert np.abs(coarse - fine).max() < 1e-5 * THICKNESS


@pytest.mark.parametrize(("biot", "final"), [(0.9, 0.5), (0.9, 0.8), (1.0, 0.5), (0.5, 0.7)])
def test_settlement_over_time(biot: float, final: float) -> None:
    run = crushed(biot, final)
    error, T = off(run, biot, final), run["time"] / time_unit(biot)
    assert error[T > 1e-3].max() < 2e-3
    assert error.max() < 0.02
    assert run.fluid_error() < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("order", [2, 3])
def test_settlement_with_a_small_tolerance(order: int) -> None:
    run = crushed(0.9, 0.5, 48, order=order, tolerance=1e-5)
    error, T = off(run, 0.9, 0.5), run["time"] / time_unit(0.9)
    assert error[T > 1e-3].max() < 1.5e-4


def test_the_frame_of_the_permeability_matters() -> None:
    """A crushed layer is a shorter way: with a spatial permeability it drains faster."""
    run = crushed(0.9, 0.5, frame="material")
    assert off(run, 0.9, 0.5, spatial=False)[run["time"] > 1e-3].max() < 2e-3
    assert off(run, 0.9, 0.5, spatial=True).max() > 0.02


@pytest.mark.parametrize("final", [0.3, 0.5, 0.8])
def test_drained_limit(final: float) -> None:
    run = crushed(0.9, final, 8, end=12.0)
    assert run.seen[-1] / THICKNESS == pytest.approx(1.0 - final, abs=1e-6)
    assert run["pressure_max"][-1] < 1e-5 * SHEAR
    assert run["jacobian_min"].min() > final - 1e-3, "no overshoot"


def test_profile_of_the_stretch() -> None:
    end = 0.2
    run = crushed(0.9, 0.5, 48, tolerance=1e-4, end=end)
    stretch = reference(run["time"][[0, -1]], 0.9, 0.5, True)[:, -1]
    faces, heights, _ = grid(len(stretch))
    exact = np.append(0.0, np.cumsum((stretch - 1.0) * heights))
    look = run.last()
    found = look.displacement()[:, 1]
    assert found == pytest.approx(np.interp(look.nodes[:, 1], faces, exact), abs=2e-4 * THICKNESS)
