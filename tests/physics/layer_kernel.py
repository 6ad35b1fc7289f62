"""Frictionless rigid cylinder on an elastic layer bonded to a rigid base (plane strain).

A surface pressure p cos(kx) on the layer sinks by (1 - nu)/G L(kd)/k p cos(kx) with
    L(u) = (2 K sinh 2u - 4u) / (2 K cosh 2u + 4u^2 + 1 + K^2),  K = 3 - 4 nu
(Meijers 1968; Johnson, Contact Mechanics, 5.8).  In the contact |x| <= a the displacement is
delta - x^2/(2R) and p(+-a) = 0.  With p = sum c_n sqrt(1 - t^2) U_{n-1}(t), t = x/a, n odd, the
derivative of that condition reads
    (1 - nu)/G sum c_n [T_n(t) + n int_0^inf (L - 1)(v d/a) sin(n pi/2) J_n(v) sin(vt)/v dv] = x/R
where the part of the half space (L = 1) is a Hilbert transform known in closed form and L - 1
decays exponentially: collocation converges to machine precision.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import jv

Array = NDArray[np.float64]


def kernel(u: Array, nu: float) -> Array:
    """L(u), with numerator and denominator divided by exp(2u)."""
    K, e = 3.0 - 4.0 * nu, np.exp(-2.0 * u)
    over = K * (1.0 - e**2) - 4.0 * u * e
    return over / (K * (1.0 + e**2) + (4.0 * u**2 + 1.0 + K**2) * e)


def gauss(ends: Array, points: int = 40) -> tuple[Array, Array]:
    """Composite Gauss rule between the given ends: places and weights."""
    x, w = np.polynomial.legendre.leggauss(points)
    half = np.diff(ends)[:, None] / 2.0
    return (ends[:-1, None] + half * (1.0 + x)).ravel(), (half * w).ravel()


@dataclass(frozen=True)
class Indentation:
    """Cylinder of radius R pressed into a layer of thickness d until the half-width is a.

    force: N/m; approach: m; spread: rms of x weighted by p, m; coefficients: c_n, Pa.
    """

    half_width: float
    force: float
    approach: float
    spread: float
    coefficients: Array

    def pressure(self, x: Array) -> Array:
        """Contact pressure at x (m), Pa."""
        angle = np.arccos(np.clip(x / self.half_width, -1.0, 1.0))
        n = 2 * np.arange(len(self.coefficients)) + 1
        return np.sin(np.multiply.outer(angle, n)) @ self.coefficients

    @property
    def peak(self) -> float:
        """Pressure in the middle, Pa."""
        return float(self.pressure(np.zeros(1))[0])


def indentation(a: float, R: float, d: float, shear: float, nu: float,
                terms: int = 16) -> Indentation:
    """Solve the integral equation for a given half-width a."""
    n = 2 * np.arange(terms) + 1
    sign = np.where(n % 4 == 1, 1.0, -1.0)
    t = np.cos((np.arange(terms) + 0.5) * np.pi / (2 * terms))
    v, w = gauss(np.linspace(0.0, 25.0 * max(a / d, 1.0), 60 + int(10 * a / d)))
    J = jv(n[:, None], v)
    rest = (kernel(v * d / a, nu) - 1.0) * w / v
    rows = np.cos(np.outer(np.arccos(t), n)) + np.sin(np.outer(t, v)) @ (J * rest).T * (n * sign)
    c = np.linalg.solve(rows, shear / (1.0 - nu) * a * t / R)

    # w(0) = (1 - nu)/(G pi) int L(kd)/k p^(k) dk with p^(k) = a pi sum n c_n sign J_n(ka)/(ka)
    v, w = gauss(np.linspace(0.0, 3000.0, 3000), 12)
    transform = (jv(n[:, None], v) / v).T @ (n * sign * c)
    approach = (1.0 - nu) / shear * a * (w * kernel(v * d / a, nu) / v * transform).sum()
    angle = (np.arange(400) + 0.5) * np.pi / 400
    profile = np.sin(np.outer(angle, n)) @ c * np.sin(angle) * np.pi
    force = a * profile.mean()
    spread = a * np.sqrt((profile * np.cos(angle) ** 2).mean() / profile.mean())
    return Indentation(a, force, approach, spread, c)
