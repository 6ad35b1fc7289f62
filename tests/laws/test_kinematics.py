"""F, J, cof F and the pulled-back mobility, each with its derivative."""

import numpy as np
import pytest
from hypothesis import given

from porolub.laws.kinematics import Deformation
from tests.laws.support import (
    ANY_GRADIENT,
    assert_derivative,
    assert_linear,
    displacement_gradients,
    embed,
)

SLOPE = {2: np.array([0.3, -1.1]), 3: np.array([0.3, -1.1, 0.8])}


@given(ANY_GRADIENT)
def test_inverse_and_volume_ratio(H):
    F, d = np.eye(len(H)) + H, Deformation(H, finite=True)
    np.testing.assert_allclose(d.inverse @ F, np.eye(len(F)), atol=1e-13)
    assert pytest.approx(np.linalg.det(F), rel=1e-13) == d.J


@given(ANY_GRADIENT)
def test_cofactor_and_mobility_are_what_they_are_called(H):
    d = Deformation(H, finite=True)
    F = np.eye(len(H)) + H
    J, inverse = np.linalg.det(F), np.linalg.inv(F)
    np.testing.assert_allclose(d.F, F, rtol=1e-15)
    np.testing.assert_allclose(d.J, J, rtol=1e-13)
    np.testing.assert_allclose(d.cof, J * inverse.T, atol=1e-13)
    np.testing.assert_allclose(d.mobility_tensor, J * inverse @ inverse.T, rtol=1e-11, atol=1e-11)


@given(ANY_GRADIENT)
def test_cofactor_is_the_derivative_of_the_volume_ratio(H):
    assert_derivative(lambda d: d.J, lambda d: d.cof, H, True, 1.0)


@given(displacement_gradients(3))
def test_derivative_of_the_cofactor_in_3d(H):
    assert_derivative(lambda d: d.cof, lambda d: d.dcof, H, True, 1.0)


@given(displacement_gradients(2))
def test_the_cofactor_is_linear_in_2d(H):
    assert_linear(lambda d: d.cof, lambda d: d.dcof, H, True, 1.0)


@given(ANY_GRADIENT)
def test_derivative_of_the_pulled_back_flux(H):
    g = SLOPE[len(H)]
    assert_derivative(
        lambda d: np.einsum("...jk,k->...j", d.mobility_tensor, g),
        lambda d: d.mobility_flux_derivative(np.broadcast_to(g, (*d.H.shape[:-2], len(g)))),
        H, True, 1.0)


@given(displacement_gradients(2))
def test_plane_strain_is_3d_with_unit_stretch_across(H):
    plane, space = Deformation(H, finite=True), Deformation(embed(H), finite=True)
    np.testing.assert_allclose(plane.J, space.J, rtol=1e-14)
    np.testing.assert_allclose(plane.cof, space.cof[:2, :2], atol=1e-14)
    np.testing.assert_allclose(plane.dcof, space.dcof[:2, :2, :2, :2], atol=1e-13)
    np.testing.assert_allclose(plane.mobility_tensor, space.mobility_tensor[:2, :2], atol=1e-12)
    g = np.array([0.3, -1.1, 0.0])
    np.testing.assert_allclose(plane.mobility_flux_derivative(g[:2]),
                               space.mobility_flux_derivative(g)[:2, :2, :2], atol=1e-11)


@given(ANY_GRADIENT)
def test_small_strain_is_linear(H):
    one = np.eye(len(H))
    d = Deformation(H, finite=False)
    assert pytest.approx(1.0 + np.trace(H), rel=1e-14) == d.J
    assert_linear(lambda d: d.J, lambda d: d.cof, H, False, 1.0)
    for tensor in (d.inverse, d.cof, d.mobility_tensor):
        np.testing.assert_array_equal(tensor, one)
    assert not d.dcof.any()
    assert not d.mobility_flux_derivative(SLOPE[len(H)]).any()


@pytest.mark.parametrize("finite", [True, False])
@pytest.mark.parametrize("dim", [2, 3])
def test_points_of_an_array_do_not_mix(dim, finite):
    H = 0.1 * np.random.default_rng(3).standard_normal((4, 5, dim, dim))
    g = np.random.default_rng(4).standard_normal((4, 5, dim))
    whole, single = Deformation(H, finite), Deformation(H[2, 3], finite)
    for name in ("F", "J", "inverse", "cof", "dcof", "mobility_tensor"):
        np.testing.assert_allclose(getattr(whole, name)[2, 3], getattr(single, name), atol=1e-13)
    np.testing.assert_allclose(whole.mobility_flux_derivative(g)[2, 3],
                               single.mobility_flux_derivative(g[2, 3]), atol=1e-13)
