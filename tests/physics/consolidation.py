"""A porous block under a load on its drained top, sides and bottom on rollers; closed forms.

Linear, fluid and grains incompressible (Biot 1): c p_yy = p_t - s_t, c = M kappa/eta, u_y =
(p - s)/M in y from the base, s the load on the top (Terzaghi 1943; Verruijt 2016, chapter 2).
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.physics.stepped import Look

Array = NDArray[np.float64]
BULK, SHEAR = 1e6, 0.6e6  # Pa
MODULUS = BULK + 4.0 * SHEAR / 3.0  # of confined compression, Pa
THICKNESS = 1e-3  # m
MOBILITY = 1e-12  # kappa / eta, m^2/(Pa s)
C = MODULUS * MOBILITY  # m^2/s
TAU = THICKNESS**2 / C  # s
LOAD = 1e3  # Pa
SETTLED = LOAD * THICKNESS / MODULUS  # m, drained
ROOTS = (np.arange(2000) + 0.5) * np.pi


def column(across: int, end: float, traction: Any = f"{LOAD} Pa", degree: int = 1,
           **time: Any) -> dict[str, Any]:
    """Tables of the block; ``end`` in units of TAU."""
    return {
        "geometry": {"shape": "block", "width": "0.5 mm", "thickness": f"{THICKNESS} m"},
        "mesh": {"along": 1, "across": across, "pressure_degree": degree},
        "solid": {"law": "linear", "shear_modulus": f"{SHEAR} Pa", "bulk_modulus": f"{BULK} Pa"},
        "pores": {"biot": 1.0, "permeability": f"{MOBILITY * 1e-3} m^2", "viscosity": "1 mPa*s"},
        "boundary": {"top": {"traction": traction, "pressure": "0 Pa"}},
        "time": {"end": f"{end * TAU!r} s", "frames": 0, **time},
    }


def settlement(look: Look) -> float:
    """How far the top has come down, m."""
    return -float(look.displacement()[np.argmax(look.nodes[:, 1]), 1])


def degree_of_consolidation(T: Array | float) -> Array:
    """U = settlement over drained settlement after t = T TAU under a sudden load."""
    T = np.atleast_1d(T)[:, None]
    return 1.0 - (2.0 / ROOTS**2 * np.exp(-(ROOTS**2) * T)).sum(axis=1)


def excess_pressure(y: Array, T: float) -> Array:
    """p / load at heights y (m) under a sudden load."""
    depth = ROOTS * (1.0 - y[:, None] / THICKNESS)
    return (2.0 / ROOTS * np.sin(depth) * np.exp(-(ROOTS**2) * T)).sum(axis=1)


def settlement_of_excess(y: Array, T: float) -> Array:
    """Displacement downwards at heights y over the drained settlement, under a sudden load."""
    depth = ROOTS * (1.0 - y[:, None] / THICKNESS)
    held = 2.0 / ROOTS**2 * (np.cos(depth) - np.cos(ROOTS)) * np.exp(-(ROOTS**2) * T)
    return y / THICKNESS - held.sum(axis=1)


def harmonic_response(omega: float) -> complex:
    """Settlement per exp(i omega t) of a load LOAD exp(i omega t) that has always acted, m."""
    b = np.sqrt(1j * omega / C)
    return complex(LOAD / MODULUS * np.tanh(b * THICKNESS) / b)


def start_of_harmonic(t: Array, omega: float) -> Array:
    """What a load LOAD sin(omega t) begun at t = 0 adds to the settlement and dies out, m."""
    rate = (ROOTS**2 / TAU)[:, None]
    return (SETTLED / TAU * 2.0 * omega / (rate**2 + omega**2) * np.exp(-rate * t)).sum(axis=0)
