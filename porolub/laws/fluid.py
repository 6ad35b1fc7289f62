"""Density of the fluid over its pressure: rho = rho_0 exp(chi p) (de Boer et al. 2020, 2.2.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CompressibleFluid:
    """``compressibility`` chi in one over the caller's unit of pressure."""

    compressibility: float

    def excess_density(self, pressure: Array) -> tuple[Array, Array]:
        """rho / rho_0 - 1, exact also where chi p is tiny, and its derivative by the pressure."""
        chi = self.compressibility
        return np.expm1(chi * pressure), chi * np.exp(chi * pressure)
