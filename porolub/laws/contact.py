"""Unilateral contact as one equation: min(p_c, c gap) = 0 (semismooth), with its derivative."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def complementarity(pressure: Array, gap: Array, stiffness: float,
                    smoothing: float = 0.0) -> tuple[Array, Array, Array]:
    """min(p_c, c gap), its derivative by p_c and its derivative by the gap.

    ``stiffness`` c (pressure per length) only weighs the two branches; it moves no solution.
    ``smoothing`` t > 0 gives the smooth minimum whose zero set is p_c c gap = t^2 (both
    positive): the central path that leads to contact as t goes to 0.
    """
    difference = pressure - stiffness * gap
    root = np.sqrt(difference**2 + 4.0 * smoothing**2)
    sign = np.divide(difference, root, out=-np.ones_like(root), where=root > 0)
    return (0.5 * (pressure + stiffness * gap - root), 0.5 * (1.0 - sign),
            0.5 * stiffness * (1.0 + sign))
