"""Scaled units of a solve: lengths by the layer thickness, pressures by the layer's modulus.

SI spans twenty decades in the matrix; scaled, the layer has thickness 1, modulus 1 and, if
porous, mobility kappa/eta 1 (the time unit is the consolidation time d^2 eta / (M kappa)).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Scales:
    """SI size of one scaled unit: length in m, pressure in Pa, time in s; dim 2 or 3."""

    length: float
    pressure: float
    time: float
    dim: int

    @property
    def speed(self) -> float:
        return self.length / self.time

    @property
    def force(self) -> float:
        """N/m in 2D, N in 3D."""
        return self.pressure * self.length ** (self.dim - 1)

    @property
    def density(self) -> float:
        return self.pressure * self.time**2 / self.length**2

    @property
    def viscosity(self) -> float:
        return self.pressure * self.time

    @property
    def mobility(self) -> float:
        """Unit of kappa/eta, m^2/(Pa s)."""
        return self.length**2 / (self.pressure * self.time)

    @property
    def volume_flow(self) -> float:
        """m^2/s per width in 2D, m^3/s in 3D."""
        return self.length**self.dim / self.time
