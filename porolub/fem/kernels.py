"""The compiled contractions of ``kernels.c``, called through ctypes on NumPy arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from porolub.laws.compiled import load, ptr

Array = NDArray[np.float64]
Ints = NDArray[np.int32]
Side = tuple[Array, bool, int, int]  # table, is gradient, nodes, components


_lib = load("porolub.fem._kernels")


def evaluate(table: Array, grad: bool, variant: Ints, inverse: Array, dofs: Ints, ncomp: int,
             x: Array) -> Array:
    """Field values (ne, nq, ncomp) or gradients (ne, nq, ncomp, dim) from the local vector x."""
    ne, nq, dim = inverse.shape[:3]
    out = np.empty((ne, nq, ncomp, dim) if grad else (ne, nq, ncomp))
    _lib.pl_evaluate(ne, nq, dim, len(table), dofs.shape[1], ncomp, int(grad), ptr(table),
                     ptr(variant), ptr(inverse), ptr(dofs), ptr(x), ptr(out))
    return out


def residual(table: Array, grad: bool, variant: Ints, inverse: Array, weights: Array, f: Array,
             dofs: Ints, ncomp: int, r: Array) -> None:
    """Add the integral of f against test values or gradients to the local vector r."""
    ne, nq, dim = inverse.shape[:3]
    _lib.pl_residual(ne, nq, dim, len(table), dofs.shape[1], ncomp, int(grad), ptr(table),
                     ptr(variant), ptr(inverse), ptr(weights), ptr(f), ptr(dofs), ptr(r))


def matrix_buffer(entities: int, test: tuple[int, int], trial: tuple[int, int]) -> Array:
    """Room for element matrices (entities, test nodes, padded row); sides are (nodes, comps)."""
    (ni, ci), (nj, cj) = test, trial
    return np.zeros((entities, ni, _lib.pl_padded(ci * cj * nj)))


def matrix(test: Side, trial: Side, variant: Ints, inverse: Array, weights: Array, g: Array,
           out: Array, add: bool) -> None:
    """Put (or add) the integral of test . g . trial into element matrices ``out``."""
    ne, nq, dim = inverse.shape[:3]
    (ti, gi, ni, ci), (tj, gj, nj, cj) = test, trial
    _lib.pl_matrix(ne, nq, dim, len(ti), ni, ci, int(gi), ptr(ti), nj, cj, int(gj), ptr(tj),
                   ptr(variant), ptr(inverse), ptr(weights), ptr(g), int(add), ptr(out))


def rotate(entities: Ints, frame_of: Ints, frames: Array, on_trial: bool, test: tuple[int, int],
           trial: tuple[int, int], out: Array) -> None:
    """K <- R^T K or K R in place; frame_of (len(entities), nodes) numbers the frames, -1: none."""
    (ni, ci), (nj, cj) = test, trial
    _lib.pl_rotate(len(entities), ptr(entities), frames.shape[-1], ptr(frame_of), ptr(frames),
                   int(on_trial), ni, ci, cj, nj, ptr(out))


def scatter(element_matrices: Array, slots: Ints, values: Array) -> None:
    """values[slots] += element matrices; slots (ne, test nodes, row), -1 is dropped."""
    ne, ni, n = slots.shape
    _lib.pl_scatter(ne, ni, n, ptr(element_matrices), ptr(slots), ptr(values))


def slots(rows: Ints, cols: Ints, indptr: Ints, indices: Ints) -> Ints:
    """Position (ne, rows, cols) of each entity entry in a CSR pattern sorted by column, or -1.

    rows (ne, nr) and cols (ne, nc) with -1 where absent; present pairs must be in the pattern.
    """
    ne, nr = rows.shape
    out = np.empty((ne, nr, cols.shape[1]), dtype=np.int32)
    _lib.pl_slots(ne, nr, cols.shape[1], ptr(rows), ptr(cols), ptr(indptr), ptr(indices),
                  ptr(out))
    return out
