"""Kinematics of the skeleton: F, J, cof F and their exact derivatives with respect to F.

``finite=False`` is the small-strain limit: J = 1 + tr H, cof F = I, and the pull-back of a
tensor is the tensor itself, so that a linear law gives a linear model.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def inverse_and_det(F: Array) -> tuple[Array, Array]:
    """Closed-form inverse and determinant of (..., dim, dim), dim 2 or 3."""
    if F.shape[-1] == 2:
        a, b, c, d = F[..., 0, 0], F[..., 0, 1], F[..., 1, 0], F[..., 1, 1]
        J = a * d - b * c
        adj = np.empty_like(F)
        adj[..., 0, 0], adj[..., 0, 1], adj[..., 1, 0], adj[..., 1, 1] = d, -b, -c, a
        return adj / J[..., None, None], J
    rows = F[..., 0, :], F[..., 1, :], F[..., 2, :]
    columns = [np.cross(rows[1], rows[2]), np.cross(rows[2], rows[0]), np.cross(rows[0], rows[1])]
    adj = np.stack(columns, axis=-1)
    J = np.einsum("...i,...i->...", rows[0], adj[..., :, 0])
    return adj / J[..., None, None], J


def outer(A: Array, B: Array) -> Array:
    """A_ij B_kl."""
    return A[..., :, :, None, None] * B[..., None, None, :, :]


def crossed(A: Array) -> Array:
    """A_il A_kj as (i, j, k, l): minus the derivative of a transposed inverse A = F^-T."""
    # [i, j, k, l] = A[i, l] A[k, j]
    return A[..., :, None, None, :] * np.swapaxes(A, -1, -2)[..., None, :, :, None]


class Deformation:
    """Deformation at points; H is grad u (..., dim, dim)."""

    def __init__(self, H: Array, finite: bool) -> None:
        self.H, self.finite, self.dim = H, finite, H.shape[-1]

    @cached_property
    def F(self) -> Array:
        return self.H + np.eye(self.dim)

    @cached_property
    def _inverse_and_det(self) -> tuple[Array, Array]:
        return inverse_and_det(self.F)

    @cached_property
    def J(self) -> Array:
        """Volume ratio (...)."""
        if self.finite:
            return self._inverse_and_det[1]
        return 1.0 + np.einsum("...ii->...", self.H)

    @cached_property
    def inverse(self) -> Array:
        """F^-1 (identity for small strain)."""
        if self.finite:
            return self._inverse_and_det[0]
        return np.broadcast_to(np.eye(self.dim), self.H.shape)

    @cached_property
    def inverse_transposed(self) -> Array:
        return np.ascontiguousarray(np.swapaxes(self.inverse, -1, -2))

    @cached_property
    def cof(self) -> Array:
        """dJ/dF = J F^-T."""
        if self.finite:
            return self.J[..., None, None] * self.inverse_transposed
        return self.inverse_transposed

    @cached_property
    def dcof(self) -> Array:
        """d cof_ij / dF_kl."""
        if not self.finite:
            return np.zeros((*self.H.shape, self.dim, self.dim))
        T = self.inverse_transposed
        return self.J[..., None, None, None, None] * (outer(T, T) - crossed(T))

    @cached_property
    def mobility_tensor(self) -> Array:
        """J F^-1 F^-T: an isotropic spatial mobility seen from the reference configuration."""
        if not self.finite:
            return self.inverse
        return self.J[..., None, None] * (self.inverse @ self.inverse_transposed)

    def mobility_flux_derivative(self, g: Array) -> Array:
        """d(J F^-1 F^-T g)_j / dF_kl for fixed g (..., dim): (..., dim, dim, dim)."""
        if not self.finite:
            return np.zeros((*g.shape, self.dim, self.dim))
        Fi, T = self.inverse, self.inverse_transposed
        Cg = np.einsum("...jk,...k->...j", self.mobility_tensor, g)  # J C^-1 g
        Tg = np.einsum("...ki,...i->...k", T, g)  # F^-T g
        JC = self.mobility_tensor
        return (Cg[..., :, None, None] * T[..., None, :, :]
                - Fi[..., :, :, None] * Cg[..., None, None, :]
                - JC[..., :, None, :] * Tg[..., None, :, None])
