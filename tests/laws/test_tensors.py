"""The compiled tensor products against their formulas in NumPy."""

import numpy as np
import pytest

from porolub.laws import tensors

POINTS = (7, 3)
CLOSE = {"rtol": 1e-13, "atol": 1e-13}


@pytest.fixture(params=[2, 3])
def dim(request):
    return request.param


@pytest.fixture
def some():
    """Random arrays over the points, with the given shape behind."""
    random = np.random.default_rng(1)
    return lambda *shape: random.standard_normal((*POINTS, *shape))


@pytest.fixture
def F(dim, some):
    return np.eye(dim) + 0.1 * some(dim, dim)


@pytest.mark.parametrize("shape", [(2,), (2, 2), (3, 3), (2, 2, 2), (2, 2, 2, 2), (3, 3, 3)])
def test_combine(some, shape):
    a, b, A, B = some(), some(), some(*shape), some(*shape)
    column = (..., *[None] * len(shape))
    np.testing.assert_allclose(tensors.combine(a, A, b, B), a[column] * A + b[column] * B, **CLOSE)
    np.testing.assert_allclose(tensors.combine(2.0, A, b, B), 2.0 * A + b[column] * B, **CLOSE)
    np.testing.assert_allclose(tensors.combine(2.0, A, -0.5, B), 2.0 * A - 0.5 * B, **CLOSE)
    np.testing.assert_allclose(tensors.combine(a, A), a[column] * A, **CLOSE)


def test_combine_numbers_per_point(some):
    a, A, B = some(), some(), some()
    np.testing.assert_allclose(tensors.combine(1.0, A, a, B), A + a * B, **CLOSE)


def test_combine_repeated_and_strided_tensors(some):
    a, b, A = some(), some(), some(2, 2)
    same = np.broadcast_to(np.array([[1.0, 2.0], [3.0, 4.0]]), A.shape)
    column = (..., None, None)
    np.testing.assert_allclose(tensors.combine(a, A, b, same), a[column] * A + b[column] * same,
                               **CLOSE)
    np.testing.assert_allclose(tensors.combine(a, same), a[column] * same, **CLOSE)
    turned = np.swapaxes(A, -1, -2)
    np.testing.assert_allclose(tensors.combine(1.0, turned, b, same), turned + b[column] * same,
                               **CLOSE)


def test_combine_with_one_tensor_for_all_points(dim, some):
    b, A, one = some(), some(dim, dim), np.eye(dim)
    np.testing.assert_allclose(tensors.combine(1.0, A, 1.0, one), A + one, **CLOSE)
    np.testing.assert_allclose(tensors.combine(1.0, A, b, one), A + b[..., None, None] * one,
                               **CLOSE)


def test_outer(dim, some):
    A, B = some(dim), some(dim, dim)
    np.testing.assert_allclose(tensors.outer(A, B), np.einsum("...i,...kl->...ikl", A, B), **CLOSE)


def test_apply_and_inner(dim, some):
    A, B, b = some(dim, dim), some(dim, dim), some(dim)
    np.testing.assert_allclose(tensors.apply(A, b), np.einsum("...ij,...j->...i", A, b), **CLOSE)
    turned = np.swapaxes(A, -1, -2)
    np.testing.assert_allclose(tensors.apply(turned, b), np.einsum("...ji,...j->...i", A, b),
                               **CLOSE)
    np.testing.assert_allclose(tensors.inner(A, B), np.einsum("...ij,...ij->...", A, B), **CLOSE)


def test_inverse(F):
    J, T, cof = tensors.inverse(F)
    inverse = np.swapaxes(np.linalg.inv(F), -1, -2)
    np.testing.assert_allclose(J, np.linalg.det(F), **CLOSE)
    np.testing.assert_allclose(T, inverse, **CLOSE)
    np.testing.assert_allclose(cof, np.linalg.det(F)[..., None, None] * inverse, **CLOSE)


def test_tangent(dim, F, some):
    T, coefficients, one = some(dim, dim), [some() for _ in range(4)], np.eye(dim)
    forms = [np.einsum("ik,jl->ijkl", one, one),
             np.einsum("...ij,...kl->...ijkl", F, T) + np.einsum("...ij,...kl->...ijkl", T, F),
             np.einsum("...ij,...kl->...ijkl", T, T),
             np.einsum("...il,...kj->...ijkl", T, T)]
    expected = sum(c[..., None, None, None, None] * f
                   for c, f in zip(coefficients, forms, strict=True))
    np.testing.assert_allclose(tensors.tangent(F, T, *coefficients), expected, **CLOSE)


def test_mobility_and_the_derivative_of_its_flux(dim, F, some):
    J, T, _ = tensors.inverse(F)
    g = some(dim)
    M = J[..., None, None] * np.einsum("...ij,...ik->...jk", T, T)
    np.testing.assert_allclose(tensors.mobility(J, T), M, **CLOSE)
    Mg = np.einsum("...jk,...k->...j", M, g)
    Tg = np.einsum("...jk,...k->...j", T, g)
    expected = (np.einsum("...j,...kl->...jkl", Mg, T) - np.einsum("...kj,...l->...jkl", T, Mg)
                - np.einsum("...jl,...k->...jkl", M, Tg))
    np.testing.assert_allclose(tensors.mobility_flux_derivative(T, M, g), expected, **CLOSE)


def test_no_points(dim):
    """A rank without facets calls everything with empty arrays."""
    F = np.zeros((0, 3, dim, dim))
    J, T, _ = tensors.inverse(F)
    assert tensors.tangent(F, T, J, J, J, J).shape == (0, 3, dim, dim, dim, dim)
    assert tensors.combine(J, F, J, T).shape == F.shape
