"""Products of tensors at many points, compiled: NumPy is slow on 2 x 2 blocks.

Laws may use these or plain NumPy; both see arrays (..., dim, dim) whose leading axes are points.
The formulas are in the docstrings; tests compare them, written in NumPy, with what is compiled.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from porolub.laws.compiled import contiguous, load, ptr

Array = NDArray[np.float64]


_lib = load("porolub.laws._tensors")


def _coefficient(c: Array | float) -> tuple[Array, int]:
    """A number per point, or one for all of them, with its stride."""
    c = np.asarray(c, dtype=float)
    return (contiguous(c), 1) if c.ndim else (c.reshape(1), 0)


def _tensor(A: Array, points: int) -> tuple[Array, int]:
    """A tensor per point, or one repeated without a copy, with its stride."""
    if points and A.size and not any(A.strides[:points]):
        return contiguous(A[(0,) * points]), 0
    return contiguous(A), math.prod(A.shape[points:])


def combine(a: Array | float, A: Array, b: Array | float = 0.0, B: Array | None = None) -> Array:
    """a A + b B with a and b numbers or arrays over the points.

    B has the shape of A, or of a single tensor that stands for all points.
    """
    B = A if B is None else B
    points = max(np.ndim(a), np.ndim(b), A.ndim - B.ndim)
    (a, da), (b, db) = _coefficient(a), _coefficient(b)
    (A0, dA), (B0, dB) = _tensor(A, points), _tensor(B, points if A.ndim == B.ndim else 0)
    out = np.empty(A.shape)
    if out.size:
        n = math.prod(A.shape[:points])
        _lib.pt_combine(n, out.size // n, ptr(a), da, ptr(A0), dA, ptr(b), db, ptr(B0),
                        dB if A.ndim == B.ndim else 0, ptr(out))
    return out


def outer(A: Array, B: Array) -> Array:
    """A_i B_kl: A (..., dim), B (..., dim, dim)."""
    points = A.ndim - 1
    A, B = contiguous(A), contiguous(B)
    out = np.empty((*A.shape, *B.shape[points:]))
    n, rows = math.prod(A.shape[:points]), A.shape[-1]
    _lib.pt_outer(n, rows, out.size // max(1, A.size), ptr(A), ptr(B), ptr(out))
    return out


def apply(A: Array, B: Array) -> Array:
    """A_ij B_j: A (..., dim, dim), B (..., dim)."""
    A, B = contiguous(A), contiguous(B)
    out = np.empty(B.shape)
    dim = B.shape[-1]
    _lib.pt_apply(B.size // dim, dim, dim, ptr(A), ptr(B), ptr(out))
    return out


def inner(A: Array, B: Array) -> Array:
    """A_ij B_ij: (...)."""
    A, B = contiguous(A), contiguous(B)
    out = np.empty(A.shape[:-2])
    _lib.pt_apply(out.size, 1, A.shape[-1] * A.shape[-2], ptr(A), ptr(B), ptr(out))
    return out


def inverse(F: Array) -> tuple[Array, Array, Array]:
    """J = det F, F^-T and cof F = J F^-T, in closed form; dim 2 or 3."""
    F = contiguous(F)
    J, T, cof = np.empty(F.shape[:-2]), np.empty(F.shape), np.empty(F.shape)
    _lib.pt_inverse(J.size, F.shape[-1], ptr(F), ptr(J), ptr(T), ptr(cof))
    return J, T, cof


def tangent(F: Array, T: Array, one: Array, mixed: Array, square: Array, crossed: Array) -> Array:
    """Derivative by F_kl of an isotropic tensor function a F_ij + b T_ij, T = F^-T:

    one d_ik d_jl + mixed (F_ij T_kl + T_ij F_kl) + square T_ij T_kl + crossed T_il T_kj,
    the four coefficients (...) over the points.
    """
    F, T = contiguous(F), contiguous(T)
    dim, points = F.shape[-1], F.shape[:-2]
    parts = [contiguous(np.broadcast_to(c, points)) for c in (one, mixed, square, crossed)]
    out = np.empty((*F.shape, dim, dim))
    _lib.pt_tangent(parts[0].size, dim, ptr(F), ptr(T), *map(ptr, parts), ptr(out))
    return out


def mobility(J: Array, T: Array) -> Array:
    """J T_ij T_ik = J F^-1 F^-T for T = F^-T."""
    J, T = contiguous(J), contiguous(T)
    out = np.empty(T.shape)
    _lib.pt_mobility(J.size, T.shape[-1], ptr(J), ptr(T), ptr(out))
    return out


def mobility_flux_derivative(T: Array, M: Array, g: Array) -> Array:
    """d(M g)_j / dF_kl for M = J F^-1 F^-T and fixed g (..., dim):

    (M g)_j T_kl - T_kj (M g)_l - M_jl (T g)_k.
    """
    T, M, g = contiguous(T), contiguous(M), contiguous(g)
    out = np.empty((*T.shape, T.shape[-1]))
    _lib.pt_mobility_flux(M.size // T.shape[-1]**2, T.shape[-1], ptr(T), ptr(M), ptr(g),
                          ptr(out))
    return out
