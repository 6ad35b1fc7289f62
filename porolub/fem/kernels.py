"""The compiled contractions of ``kernels.c``, called through ctypes on NumPy arrays."""

from __future__ import annotations

import ctypes
import importlib.util

import numpy as np
from numpy.typing import NDArray

from porolub.errors import SolveError

Array = NDArray[np.float64]
Ints = NDArray[np.int32]


def _load() -> ctypes.CDLL:
    spec = importlib.util.find_spec("porolub.fem._kernels")
    if spec is None or spec.origin is None:
        raise SolveError(
            "The compiled kernels (porolub/fem/_kernels) are missing: "
            "run 'pip install -e .' in the checkout (it needs a C compiler)."
        )
    return ctypes.CDLL(spec.origin)


_lib = _load()
_MAX_NODES = 27


def _ptr(a: NDArray[np.generic]) -> ctypes.c_void_p:
    if not a.flags.c_contiguous:
        raise ValueError("kernel arrays must be C-contiguous")
    return ctypes.c_void_p(a.ctypes.data)


def evaluate(table: Array, grad: bool, variant: Ints, inverse: Array, dofs: Ints, ncomp: int,
             x: Array) -> Array:
    """Field values (ne, nq, ncomp) or gradients (ne, nq, ncomp, dim) from the local vector x."""
    ne, nq, dim = inverse.shape[:3]
    nn = dofs.shape[1]
    out = np.empty((ne, nq, ncomp, dim) if grad else (ne, nq, ncomp))
    _lib.pl_evaluate(ne, nq, dim, nn, ncomp, int(grad), _ptr(table), _ptr(variant),
                     _ptr(inverse), _ptr(dofs), _ptr(x), _ptr(out))
    return out


def residual(table: Array, grad: bool, variant: Ints, inverse: Array, weights: Array, f: Array,
             dofs: Ints, ncomp: int, r: Array) -> None:
    """Add the integral of f against test values or gradients to the local vector r."""
    ne, nq, dim = inverse.shape[:3]
    _lib.pl_residual(ne, nq, dim, dofs.shape[1], ncomp, int(grad), _ptr(table), _ptr(variant),
                     _ptr(inverse), _ptr(weights), _ptr(f), _ptr(dofs), _ptr(r))


def matrix(test: tuple[Array, bool, int, int], trial: tuple[Array, bool, int, int],
           variant: Ints, inverse: Array, weights: Array, g: Array, out: Array) -> None:
    """Add the integral of test . g . trial to element matrices out (ne, ci, ni, cj, nj).

    ``test`` and ``trial`` are (table, is gradient, nodes, components).
    """
    ne, nq, dim = inverse.shape[:3]
    (ti, gi, ni, ci), (tj, gj, nj, cj) = test, trial
    _lib.pl_matrix(ne, nq, dim, ni, ci, int(gi), _ptr(ti), nj, cj, int(gj), _ptr(tj),
                   _ptr(variant), _ptr(inverse), _ptr(weights), _ptr(g), _ptr(out))
