"""Unilateral contact as one equation: min(p_c, c gap) = 0 (semismooth), with its derivative."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def complementarity(pressure: Array, gap: Array, stiffness: float) -> tuple[Array, Array, Array]:
    """min(p_c, c gap), its derivative by p_c and its derivative by the gap.

    ``stiffness`` c (pressure per length) only weighs the two branches; it moves no solution.
    """
    closed = pressure > stiffness * gap
    return (np.where(closed, stiffness * gap, pressure), np.where(closed, 0.0, 1.0),
            np.where(closed, stiffness, 0.0))
