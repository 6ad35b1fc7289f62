"""A surface load exp(iqx) travelling over a linear biphasic layer: closed form by wave number.

In the frame of the load the layer 0 <= y <= 1 moves with U along x.  With e = div u, M the
confined modulus, k the mobility, a the Biot coefficient and c = M k / a^2,
    G lap u + (M - G) grad e = a grad p,        a U d_x e = k lap p.
The divergence of the first gives M lap e = a lap p, hence e'' = r^2 e with
r^2 = q^2 + i q U / c, and p = (M/a) e + B with B harmonic.  The displacement is
    u = (c / (i q U)) grad e  +  (a / 2G) (y grad S - S j)  +  grad X,    d_y S = B,
S and X harmonic: the first part carries e, the second B, the third is free of both.  e, S and X
have two constants each (growing and decaying in y), found from the six conditions
    y = 0:  u = 0, d_y p = 0;   y = 1:  normal traction -1, no shear, and p = 0 or d_y p = 0.
All exponentials are scaled to be at most 1, so Peclet numbers of thousands are no trouble.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Layer:
    """Scaled properties of a layer of thickness 1; ``peclet`` is U / c."""

    shear: float
    modulus: float
    biot: float
    mobility: float
    peclet: float
    drained: bool  # the top: p = 0, else no flux

    @property
    def diffusivity(self) -> float:
        return self.modulus * self.mobility / self.biot**2

    @property
    def speed(self) -> float:
        return self.peclet * self.diffusivity


@dataclass(frozen=True)
class Wave:
    """Complex amplitudes at the heights y (n,): fields times exp(iqx)."""

    ux: Complex
    uy: Complex
    p: Complex
    e: Complex
    p_y: Complex
    shear_stress: Complex
    normal_stress: Complex  # total: s_yy - a p


def _modes(layer: Layer, q: float, y: Array) -> list[Wave]:
    """The six solutions: e, S and X, each growing and decaying."""
    G, M, a = layer.shear, layer.modulus, layer.biot
    r = np.sqrt(q**2 + 1j * q * layer.peclet)
    found = []
    for sign in (1.0, -1.0):
        for part in "eSX":
            rate = sign * (r if part == "e" else q)
            f = np.exp(rate * (y - (1.0 if sign > 0 else 0.0)))
            if part == "e":
                w = 1.0 / (r**2 - q**2)
                ux, uy, e, p, p_y = w * 1j * q * f, w * rate * f, f, M / a * f, M / a * rate * f
                ux_y, uy_y = rate * ux, rate * uy
            elif part == "S":
                w = a / (2.0 * G)
                ux, uy = w * y * 1j * q * f, w * (y * rate - 1.0) * f
                ux_y, uy_y = w * 1j * q * (1.0 + y * rate) * f, w * y * rate**2 * f
                e, p, p_y = 0.0 * f, rate * f, rate**2 * f
            else:
                ux, uy = 1j * q * f, rate * f
                ux_y, uy_y, e, p, p_y = rate * ux, rate * uy, 0.0 * f, 0.0 * f, 0.0 * f
            stress = 2.0 * G * uy_y + (M - 2.0 * G) * e - a * p
            found.append(Wave(ux, uy, p, e, p_y, G * (ux_y + 1j * q * uy), stress))
    return found


def wave(layer: Layer, q: float, y: Array) -> Wave:
    """Amplitudes at heights y under the surface traction -exp(iqx) normal to the top."""
    bottom, top = _modes(layer, q, np.zeros(1)), _modes(layer, q, np.ones(1))
    rows = [[m.ux[0] for m in bottom], [m.uy[0] for m in bottom], [m.p_y[0] for m in bottom],
            [m.normal_stress[0] for m in top], [m.shear_stress[0] for m in top],
            [m.p[0] if layer.drained else m.p_y[0] for m in top]]
    matrix = np.array(rows)
    scale = np.abs(matrix).max(axis=0)
    size = np.abs(matrix).max(axis=1)
    A = matrix / scale / size[:, None]
    constants = np.linalg.solve(A, np.array([0, 0, 0, -1, 0, 0]) / size) / scale
    modes = _modes(layer, q, y)
    return Wave(*(sum(c * getattr(m, name) for c, m in zip(constants, modes, strict=True))
                  for name in Wave.__dataclass_fields__))
