"""Thin film between the surface and the plane (Reynolds): flux, mobility, shear stress.

de Boer et al. 2020, Eqs. 8, 18, 19.  Film thickness h >= 0; eta viscosity; U entrainment speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Newtonian:
    """Isoviscous lubricant; ``viscosity`` and ``shear_film_min`` in the caller's units."""

    viscosity: float
    shear_film_min: float

    def conductance(self, h: Array) -> Array:
        """h^3 / (12 eta)."""
        return h**3 / (12.0 * self.viscosity)

    def conductance_derivative(self, h: Array) -> Array:
        return h**2 / (4.0 * self.viscosity)

    def shear_stress(self, h: Array, slope: Array, speed: Array) -> Array:
        """tau = h/2 dp/ds + eta U / max(h, h_min) (Eqs. 18-19)."""
        return h / 2.0 * slope + self.viscosity * speed / np.maximum(h, self.shear_film_min)


def film_thickness(gap: Array) -> tuple[Array, Array]:
    """h = max(0, gap) and dh/dgap."""
    return np.maximum(gap, 0.0), (gap > 0.0).astype(float)
