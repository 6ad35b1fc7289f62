"""Kinematics of the skeleton: F, J, cof F and their exact derivatives with respect to F.

``finite=False`` is the small-strain limit: J = 1 + tr H, cof F = I, and the pull-back of a
tensor is the tensor itself, so that a linear law gives a linear model.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from porolub.laws import tensors

Array = NDArray[np.float64]


class Deformation:
    """Deformation at points; H is grad u (..., dim, dim)."""

    def __init__(self, H: Array, finite: bool) -> None:
        self.H, self.finite, self.dim = H, finite, H.shape[-1]

    @cached_property
    def F(self) -> Array:
        return tensors.combine(1.0, self.H, 1.0, np.eye(self.dim))

    @cached_property
    def _closed_form(self) -> tuple[Array, Array, Array]:
        return tensors.inverse(self.F)

    @cached_property
    def J(self) -> Array:
        """Volume ratio (...)."""
        if self.finite:
            return self._closed_form[0]
        return 1.0 + np.einsum("...ii->...", self.H)

    @cached_property
    def inverse(self) -> Array:
        """F^-1 (identity for small strain)."""
        return np.swapaxes(self.inverse_transposed, -1, -2)

    @cached_property
    def inverse_transposed(self) -> Array:
        if self.finite:
            return self._closed_form[1]
        return np.broadcast_to(np.eye(self.dim), self.H.shape)

    @cached_property
    def cof(self) -> Array:
        """dJ/dF = J F^-T."""
        return self._closed_form[2] if self.finite else self.inverse_transposed

    @cached_property
    def dcof(self) -> Array:
        """d cof_ij / dF_kl = J (T_ij T_kl - T_il T_kj) with T = F^-T."""
        if not self.finite:
            return np.zeros((*self.H.shape, self.dim, self.dim))
        if self.dim == 2:  # the cofactor is linear: the same everywhere
            turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
            constant = np.einsum("ik,jl->ijkl", turn, turn)
            return np.broadcast_to(constant, (*self.H.shape, 2, 2))
        return tensors.tangent(self.F, self.inverse_transposed, np.zeros(()), np.zeros(()),
                               self.J, -self.J)

    @cached_property
    def mobility_tensor(self) -> Array:
        """J F^-1 F^-T: an isotropic spatial mobility seen from the reference configuration."""
        if not self.finite:
            return self.inverse
        return tensors.mobility(self.J, self.inverse_transposed)

    def mobility_flux_derivative(self, g: Array) -> Array:
        """d(J F^-1 F^-T g)_j / dF_kl for fixed g (..., dim): (..., dim, dim, dim)."""
        if not self.finite:
            return np.zeros((*g.shape, self.dim, self.dim))
        return tensors.mobility_flux_derivative(self.inverse_transposed, self.mobility_tensor, g)
