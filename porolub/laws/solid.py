"""Skeleton laws: first Piola-Kirchhoff stress P(F) and its tangent dP/dF (plane strain or 3D).

Effective (drained) stress; the pore pressure is added by the pores term.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.laws import tensors
from porolub.laws.kinematics import Deformation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LinearElastic:
    """Small-strain Hooke: P = 2 G dev(eps) + K tr(eps) I."""

    shear: float
    bulk: float
    finite = False

    @property
    def constrained_modulus(self) -> float:
        """M = K + 4G/3, the modulus of confined compression at zero strain."""
        return self.bulk + 4.0 * self.shear / 3.0

    def _lame(self) -> float:
        return self.bulk - 2.0 * self.shear / 3.0

    def stress(self, d: Deformation) -> Array:
        H = d.H
        trace = np.einsum("...ii->...", H)[..., None, None]
        return self.shear * (H + np.swapaxes(H, -1, -2)) + self._lame() * trace * np.eye(d.dim)

    def tangent(self, d: Deformation) -> Array:
        one = np.eye(d.dim)
        D = (self.shear * (np.einsum("ik,jl->ijkl", one, one) + np.einsum("il,jk->ijkl", one, one))
             + self._lame() * np.einsum("ij,kl->ijkl", one, one))
        return np.broadcast_to(D, (*d.H.shape[:-2], *D.shape))


@dataclass(frozen=True)
class NeoHookean:
    """W = G/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)^2 (de Boer et al. 2020, Eqs. 2-4).

    The paper's weights, a G and (1 - a) K with the Biot coefficient a, are applied by whoever
    builds the law; plane strain adds 1 to the in-plane trace.
    """

    shear: float
    bulk: float
    finite = True

    @property
    def constrained_modulus(self) -> float:
        """Modulus of confined compression at zero strain."""
        return self.bulk + 4.0 * self.shear / 3.0

    def _isochoric(self, d: Deformation) -> tuple[Array, Array]:
        """G J^(-2/3) and tr C."""
        I1 = tensors.inner(d.F, d.F) + (3 - d.dim)
        return self.shear * d.J ** (-2.0 / 3.0), I1

    def stress(self, d: Deformation) -> Array:
        """P = A (F - I1/3 T) + K (J - 1) J T with A = G J^(-2/3), T = F^-T."""
        (A, I1), J = self._isochoric(d), d.J
        return tensors.combine(A, d.F, self.bulk * (J - 1.0) * J - A * I1 / 3.0,
                               d.inverse_transposed)

    def tangent(self, d: Deformation) -> Array:
        """dP/dF, by dA = -2/3 A T, dI1 = 2 F, dJ = J T and dT_ij = -T_il T_kj dF_kl."""
        (A, I1), J = self._isochoric(d), d.J
        return tensors.tangent(
            d.F, d.inverse_transposed, one=A, mixed=-2.0 / 3.0 * A,
            square=2.0 / 9.0 * A * I1 + self.bulk * J * (2.0 * J - 1.0),
            crossed=A * I1 / 3.0 - self.bulk * J * (J - 1.0))

    def energy(self, d: Deformation) -> Array:
        """Strain energy density (...), for tests of the stress."""
        I1 = np.einsum("...ij,...ij->...", d.F, d.F) + (3 - d.dim)
        return (self.shear / 2.0 * (d.J ** (-2.0 / 3.0) * I1 - 3.0)
                + self.bulk / 2.0 * (d.J - 1.0) ** 2)


def von_mises_stress(law: LinearElastic | NeoHookean, d: Deformation) -> Array:
    """Von Mises stress (...) of the Cauchy stress, out-of-plane component included."""
    P = law.stress(d)
    sigma = P @ np.swapaxes(d.F, -1, -2) / d.J[..., None, None] if law.finite else P
    full = np.zeros((*sigma.shape[:-2], 3, 3))
    full[..., : d.dim, : d.dim] = sigma
    if d.dim == 2:
        full[..., 2, 2] = _out_of_plane(law, d)
    deviator = full - np.einsum("...ii->...", full)[..., None, None] / 3.0 * np.eye(3)
    return np.sqrt(1.5 * np.einsum("...ij,...ij->...", deviator, deviator))


def _out_of_plane(law: LinearElastic | NeoHookean, d: Deformation) -> Array:
    if not law.finite:
        return (law.bulk - 2.0 * law.shear / 3.0) * np.einsum("...ii->...", d.H)
    I1 = np.einsum("...ij,...ij->...", d.F, d.F) + 1.0
    isochoric = law.shear * d.J ** (-5.0 / 3.0) * (1.0 - I1 / 3.0)
    return isochoric + law.bulk * (d.J - 1.0)
