"""Streamline diffusion that is just enough: the doubly asymptotic upwind function."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def upwind_function(peclet: Array) -> Array:
    """coth(Pe) - 1/Pe: 0 for resolved transport (as Pe/3), 1 for pure convection."""
    pe = np.abs(peclet)
    small = pe < 1e-2
    safe = np.where(small, 1.0, pe)
    series = pe / 3.0 - np.minimum(pe, 1.0) ** 3 / 45.0  # used below 0.01; must not overflow
    return np.where(small, series, 1.0 / np.tanh(safe) - 1.0 / safe)


def streamline_diffusivity(speed: Array, length: Array, diffusivity: float) -> Array:
    """Extra diffusivity along the stream, |v| l/2 (coth Pe - 1/Pe), Pe = |v| l / (2 c).

    Brooks and Hughes (1982): nodally exact for linear elements in one dimension; of second
    order in l once the flow is resolved.
    """
    pe = speed * length / (2.0 * max(diffusivity, 1e-300))
    return speed * length / 2.0 * upwind_function(pe)


def upwind_derivative(peclet: Array) -> Array:
    """d/dPe of the upwind function, for Pe >= 0."""
    small = peclet < 1e-2
    safe = np.where(small, 1.0, peclet)
    closed = (1.0 / safe) ** 2 - 1.0 / np.sinh(np.minimum(safe, 300.0)) ** 2
    return np.where(small, 1.0 / 3.0 - np.minimum(peclet, 1.0) ** 2 / 15.0, closed)
