"""The compiled contractions of ``kernels.c``, called through ctypes on NumPy arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porolub.laws.compiled import load, ptr

Array = NDArray[np.float64]
Ints = NDArray[np.int32]
Side = tuple[Array, bool, int, int]  # table, is gradient, nodes, components


@dataclass(frozen=True)
class Turned:
    """Entities with nodes stored in a rotated frame: K <- R^T K R there.

    entities: (k,), ascending; test and trial: (k, nodes of that side) frame numbers, -1: none,
    or None for a side that is never rotated; frames: (m, dim, dim).
    """

    entities: Ints
    test: Ints | None
    trial: Ints | None
    frames: Array

    def within(self, rows: slice) -> Turned:
        """Those of a batch, numbered from its start."""
        first, last = np.searchsorted(self.entities, (rows.start, rows.stop))
        test, trial = (None if k is None else k[first:last] for k in (self.test, self.trial))
        return Turned(self.entities[first:last] - np.int32(rows.start), test, trial, self.frames)


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


def matrix(test: Side, trial: Side, variant: Ints, inverse: Array, weights: Array, g: Array,
           turned: Turned | None, slots: Ints, values: Array) -> None:
    """Add the integral of test . g . trial to values[slots].

    slots (ne, test nodes * components, trial nodes) say where the first trial component goes,
    its others follow; -1: dropped.
    """
    ne, nq, dim = inverse.shape[:3]
    (ti, gi, ni, ci), (tj, gj, nj, cj) = test, trial
    if turned is None:
        rotation = (0, None, None, None, None)
    else:
        sides = [None if k is None else ptr(k) for k in (turned.test, turned.trial)]
        rotation = (len(turned.entities), ptr(turned.entities), *sides, ptr(turned.frames))
    _lib.pl_matrix(ne, nq, dim, len(ti), ni, ci, int(gi), ptr(ti), nj, cj, int(gj), ptr(tj),
                   ptr(variant), ptr(inverse), ptr(weights), ptr(g), *rotation, ptr(slots),
                   ptr(values))


def slots(rows: Ints, cols: Ints, indptr: Ints, indices: Ints) -> Ints:
    """Position (ne, rows, cols) of each entity entry in a CSR pattern sorted by column, or -1.

    rows (ne, nr) and cols (ne, nc) with -1 where absent; present pairs must be in the pattern.
    """
    ne, nr = rows.shape
    out = np.empty((ne, nr, cols.shape[1]), dtype=np.int32)
    _lib.pl_slots(ne, nr, cols.shape[1], ptr(rows), ptr(cols), ptr(indptr), ptr(indices),
                  ptr(out))
    return out
