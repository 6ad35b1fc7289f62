"""Quadrature on the reference cells: Gauss tensor rules, collapsed Gauss-Jacobi on simplices.

Reference cells: line, quad and hex on [-1, 1]^d; triangle and tet on the unit simplex.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import roots_jacobi

Array = NDArray[np.float64]


def _tensor(n: int, dim: int) -> tuple[Array, Array]:
    x, w = np.polynomial.legendre.leggauss(n)
    grids = np.meshgrid(*[x] * dim, indexing="ij")
    weights = np.ones(1)
    for _ in range(dim):
        weights = np.multiply.outer(weights, w)
    return np.stack([g.ravel() for g in grids], axis=1), weights.ravel()


def _simplex(n: int, dim: int) -> tuple[Array, Array]:
    """Duffy map of a Gauss-Jacobi tensor rule: exact for total degree 2n - 1."""
    rules = []
    for k in range(dim):
        # Jacobi weight (1 - t)^k takes the collapse's Jacobian into the rule
        t, w = roots_jacobi(n, k, 0.0)
        rules.append(((1.0 + t) / 2.0, w / 2.0 ** (k + 1)))
    if dim == 2:
        (a, wa), (b, wb) = rules
        B, A = np.meshgrid(b, a, indexing="ij")
        points = np.stack([B.ravel(), ((1 - B) * A).ravel()], axis=1)
        return points, np.multiply.outer(wb, wa).ravel()
    (a, wa), (b, wb), (c, wc) = rules
    C, B, A = np.meshgrid(c, b, a, indexing="ij")
    points = np.stack(
        [C.ravel(), ((1 - C) * B).ravel(), ((1 - C) * (1 - B) * A).ravel()], axis=1
    )
    return points, np.multiply.outer(np.multiply.outer(wc, wb), wa).ravel()


def rule(cell: str, n: int) -> tuple[Array, Array]:
    """Points (nq, dim) and weights (nq,) exact to degree 2n - 1 (per direction on tensor cells)."""
    if cell in ("line", "quad", "hex"):
        return _tensor(n, {"line": 1, "quad": 2, "hex": 3}[cell])
    if cell in ("triangle", "tet"):
        return _simplex(n, {"triangle": 2, "tet": 3}[cell])
    raise ValueError(f"no quadrature on {cell!r}")
