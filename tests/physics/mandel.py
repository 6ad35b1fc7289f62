"""Mandel's problem in closed form: a block between two smooth rigid plates, plane strain.

Half of it: x from 0 in the middle to a at the drained, free side; height h on a roller base; the
plate on top carries the force F per unit depth (on this half).  Fluid and grains incompressible
(nu_u = 0.5, Biot 1).  Mandel 1953; Cheng and Detournay 1988; Abousleiman et al. 1996:
    p/p0 = 2 sum sin a_i (cos(a_i x/a) - cos a_i)/(a_i - sin a_i cos a_i) exp(-a_i^2 T),
    tan a_i = (1 - nu)/(1/2 - nu) a_i,  p0 = F/(2 a),  T = c t/a^2.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Mandel:
    """SI; ``nu`` the drained Poisson ratio, below 1/2."""

    nu: float
    shear: float = 0.5e6
    half_width: float = 2e-3
    height: float = 1e-3
    mobility: float = 1e-12
    force: float = 1.0

    @property
    def bulk(self) -> float:
        return 2.0 * self.shear * (1.0 + self.nu) / (3.0 * (1.0 - 2.0 * self.nu))

    @property
    def tau(self) -> float:
        """a^2/c, s."""
        return self.half_width**2 / ((self.bulk + 4.0 * self.shear / 3.0) * self.mobility)

    @property
    def p0(self) -> float:
        """Pressure at t = 0+, Pa."""
        return self.force / (2.0 * self.half_width)

    @cached_property
    def roots(self) -> Array:
        slope = (1.0 - self.nu) / (0.5 - self.nu)
        return np.array([brentq(lambda a: np.sin(a) - slope * a * np.cos(a),
                                m * np.pi + (0.0 if m else 0.1), (m + 0.5) * np.pi)
                         for m in range(400)])

    def _sum(self, shape: Array, T: Array | float) -> Array:
        a = self.roots
        decay = np.exp(-(a**2) * np.atleast_1d(T)[:, None])
        return (shape / (a - np.sin(a) * np.cos(a)) * decay).sum(axis=1)

    def centre_pressure(self, T: Array | float) -> Array:
        """p/p0 at x = 0."""
        a = self.roots
        return self._sum(2.0 * np.sin(a) * (1.0 - np.cos(a)), T)

    def profile(self, x: Array, T: float) -> Array:
        """p/p0 at places x (m)."""
        a = self.roots
        shape = np.cos(a * x[:, None] / self.half_width) - np.cos(a)
        return self._sum(2.0 * np.sin(a) * shape, T)

    def plate(self, T: Array | float) -> Array:
        """Displacement of the plate upwards, m."""
        a = self.roots
        drained = -self.force * self.height / (2.0 * self.shear * self.half_width)
        return drained * (1.0 - self.nu - self._sum(np.sin(a) * np.cos(a), T))

    def tables(self, end: float, along: int = 24, plate: str = "contact", degree: int = 1,
               **time: Any) -> dict[str, Any]:
        """The scene; ``end`` in T. ``plate``: under its load in "contact", or "moved" as it should.
        """
        tables: dict[str, Any] = {
            "geometry": {"shape": "block", "width": f"{self.half_width} m",
                         "thickness": f"{self.height} m"},
            "mesh": {"along": along, "across": 1, "pressure_degree": degree},
            "solid": {"law": "linear", "shear_modulus": f"{self.shear} Pa",
                      "bulk_modulus": f"{self.bulk} Pa"},
            "pores": {"biot": 1.0, "permeability": f"{self.mobility * 1e-3} m^2",
                      "viscosity": "1 mPa*s"},
            "boundary": {"right": {"traction": "0 Pa", "pressure": "0 Pa"}},
            "time": {"end": f"{end * self.tau!r} s", "frames": 0, **time},
        }
        if plate == "contact":
            return tables | {"contact": {}, "load": {"force": f"{self.force} N/m"}}
        tables["boundary"]["top"] = {"displacement": {"y": self._motion(end)}}
        return tables

    def _motion(self, end: float) -> dict[str, Any]:
        """Samples of the plate's exact place."""
        T = np.concatenate([[0.0], np.geomspace(1e-7, end, 200)])
        place = self.plate(T)
        place[0] = -self.force * self.height / (4.0 * self.shear * self.half_width)
        return {"times": [f"{t!r} s" for t in (T * self.tau).tolist()],
                "values": [f"{v!r} m" for v in place.tolist()], "interpolation": "smooth"}
