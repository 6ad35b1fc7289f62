"""Deformation gradients to test with, and the Taylor test of a derivative."""

from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from porolub.laws.kinematics import Deformation

Array = NDArray[np.float64]
STEPS = 1e-3 * 0.5 ** np.arange(3)


def displacement_gradients(dim: int, size: float = 0.2) -> st.SearchStrategy[Array]:
    """H = F - I with entries up to `size`: F is diagonally dominant, J from 0.06 to 2 or so."""
    return arrays(float, (dim, dim), elements=st.floats(-size, size))


DIMENSIONS = st.sampled_from([2, 3])
ANY_GRADIENT = DIMENSIONS.flatmap(displacement_gradients)
ANGLES = st.floats(-3.1, 3.1)


def rotation(dim: int, angle: float, other: float = 0.7) -> Array:
    """A rotation; in 3D by `angle` about z, then by `other` about x."""
    c, s = np.cos(angle), np.sin(angle)
    plane = np.array([[c, -s], [s, c]])
    if dim == 2:
        return plane
    about_z, about_x = np.eye(3), np.eye(3)
    about_z[:2, :2] = plane
    c, s = np.cos(other), np.sin(other)
    about_x[1:, 1:] = [[c, -s], [s, c]]
    return about_x @ about_z


def embed(H: Array) -> Array:
    """Plane strain as what it is in 3D: H with a third row and column of zeros."""
    full = np.zeros((*H.shape[:-2], 3, 3))
    full[..., :2, :2] = H
    return full


def directions(dim: int) -> Array:
    """Five fixed tensors (5, dim, dim) of unit size: never all blind to a curvature."""
    d = np.random.default_rng(7).standard_normal((5, dim, dim))
    return d / np.linalg.norm(d, axis=(1, 2), keepdims=True)


def remainders(value: Callable[[Deformation], Array], derivative: Callable[[Deformation], Array],
               H: Array, finite: bool) -> Array:
    """|f(H + e D) - f(H) - e f'(H) : D| over all directions D, for each step e of STEPS."""
    D, at = directions(len(H)), Deformation(H, finite)
    start, slope = value(at), derivative(at)
    change = np.einsum("...kl,nkl->n...", slope, D)
    return np.array([np.linalg.norm(value(Deformation(H + e * D, finite)) - start - e * change)
                     for e in STEPS])


def order(errors: Array) -> float:
    """Observed order between the last two of successively halved steps."""
    return float(np.log2(errors[-2] / errors[-1]))


def assert_derivative(value: Callable[[Deformation], Array],
                      derivative: Callable[[Deformation], Array], H: Array, finite: bool,
                      scale: float) -> None:
    """The remainder of the Taylor expansion is of second order."""
    errors = remainders(value, derivative, H, finite)
    assert errors[0] > 1e-9 * scale, "the function is linear: nothing was tested"
    assert abs(order(errors) - 2.0) < 0.1


def assert_linear(value: Callable[[Deformation], Array],
                  derivative: Callable[[Deformation], Array], H: Array, finite: bool,
                  scale: float) -> None:
    """The derivative is exact at any distance: only rounding is left."""
    assert remainders(value, derivative, H, finite).max() < 1e-13 * scale
    assert np.abs(derivative(Deformation(H, finite))).max() > 1e-3 * scale
