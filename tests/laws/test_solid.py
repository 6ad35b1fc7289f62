"""Skeleton laws: stress from energy, tangent from stress, and what any such law must obey."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.laws.kinematics import Deformation
from porolub.laws.solid import LinearElastic, NeoHookean, von_mises_stress
from tests.laws.support import (
    ANGLES,
    ANY_GRADIENT,
    assert_derivative,
    assert_linear,
    displacement_gradients,
    embed,
    rotation,
)

G, K = 0.45, 0.7
LINEAR, NEO = LinearElastic(G, K), NeoHookean(G, K)
LAWS = [pytest.param(LINEAR, id="linear"), pytest.param(NEO, id="neo-hookean")]


def stress(law, H):
    return law.stress(Deformation(H, law.finite))


def energy_by_the_book(H):
    """W of the paper's Eqs. 2-4 with C = F^T F in 3D; plane strain has C_33 = 1."""
    F = np.eye(3) + (embed(H) if H.shape[-1] == 2 else H)
    C, J = np.swapaxes(F, -1, -2) @ F, np.linalg.det(F)
    trace = np.trace(C, axis1=-2, axis2=-1)
    return G / 2 * (J ** (-2 / 3) * trace - 3) + K / 2 * (J - 1) ** 2


def hookean_energy(d):
    """G |dev eps|^2 + K/2 (tr eps)^2, eps in 3D."""
    H = embed(d.H) if d.dim == 2 else d.H
    strain = (H + np.swapaxes(H, -1, -2)) / 2
    trace = np.trace(strain, axis1=-2, axis2=-1)
    return G * ((strain**2).sum(axis=(-2, -1)) - trace**2 / 3) + K / 2 * trace**2


@given(ANY_GRADIENT)
def test_energy_is_that_of_the_paper(H):
    assert NEO.energy(Deformation(H, True)) == pytest.approx(energy_by_the_book(H), abs=1e-13)


@given(ANY_GRADIENT)
def test_neo_hookean_stress_is_the_derivative_of_the_energy(H):
    assert_derivative(lambda d: energy_by_the_book(d.H), NEO.stress, H, True, G)


@given(ANY_GRADIENT)
def test_linear_stress_is_the_derivative_of_the_energy(H):
    assert_derivative(hookean_energy, LINEAR.stress, H, False, G)


@given(ANY_GRADIENT)
def test_neo_hookean_tangent(H):
    assert_derivative(NEO.stress, NEO.tangent, H, True, G)


@given(ANY_GRADIENT)
def test_linear_tangent(H):
    assert_linear(LINEAR.stress, LINEAR.tangent, H, False, G)


@given(ANY_GRADIENT)
def test_tangents_have_the_symmetry_of_a_second_derivative(H):
    for law in (LINEAR, NEO):
        D = law.tangent(Deformation(H, law.finite))
        np.testing.assert_allclose(D, np.einsum("ijkl->klij", D), atol=1e-10)


@given(ANY_GRADIENT, ANGLES)
def test_neo_hookean_does_not_see_the_observer_nor_the_sample_turn(H, angle):
    dim = len(H)
    F, Q = np.eye(dim) + H, rotation(dim, angle)
    P = stress(NEO, H)
    np.testing.assert_allclose(stress(NEO, Q @ F - np.eye(dim)), Q @ P, atol=1e-11)
    np.testing.assert_allclose(stress(NEO, F @ Q - np.eye(dim)), P @ Q, atol=1e-11)
    np.testing.assert_allclose(P @ F.T, F @ P.T, atol=1e-12)  # moment of momentum


@given(ANY_GRADIENT)
def test_linear_law_sees_strain_only(H):
    symmetric = (H + H.T) / 2
    np.testing.assert_allclose(stress(LINEAR, H), stress(LINEAR, symmetric), atol=1e-15)
    np.testing.assert_allclose(stress(LINEAR, H - symmetric), 0.0, atol=1e-15)


@pytest.mark.parametrize("law", LAWS)
@given(H=displacement_gradients(2))
def test_plane_strain_is_3d_with_unit_stretch_across(law, H):
    plane, space = Deformation(H, law.finite), Deformation(embed(H), law.finite)
    np.testing.assert_allclose(law.stress(plane), law.stress(space)[:2, :2], atol=1e-13)
    np.testing.assert_allclose(law.tangent(plane), law.tangent(space)[:2, :2, :2, :2], atol=1e-11)
    assert von_mises_stress(law, plane) == pytest.approx(von_mises_stress(law, space), abs=1e-13)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("dim", [2, 3])
def test_no_stress_without_deformation(law, dim):
    np.testing.assert_allclose(stress(law, np.zeros((dim, dim))), 0.0, atol=1e-15)
    Q = rotation(dim, 0.4)
    if law.finite:
        np.testing.assert_allclose(stress(law, Q - np.eye(dim)), 0.0, atol=1e-15)


@pytest.mark.parametrize("dim", [2, 3])
def test_neo_hookean_is_linear_elastic_in_the_small(dim):
    nothing = np.zeros((dim, dim))
    np.testing.assert_allclose(NEO.tangent(Deformation(nothing, True)),
                               LINEAR.tangent(Deformation(nothing, False)), atol=1e-15)
    H = np.random.default_rng(1).standard_normal((dim, dim))
    steps = [1e-3, 5e-4]
    rest = [np.linalg.norm(stress(NEO, e * H) - stress(LINEAR, e * H)) for e in steps]
    assert np.log2(rest[0] / rest[1]) == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("dim", [2, 3])
@given(stretch=st.floats(0.4, 1.6), biot=st.floats(0.05, 0.95))
def test_confined_compression_of_the_papers_law(dim, stretch, biot):
    shear, bulk = 0.5, 5.0
    H = np.zeros((dim, dim))
    H[1, 1] = stretch - 1.0
    P = NeoHookean(biot * shear, (1 - biot) * bulk).stress(Deformation(H, True))
    closed = (2 * biot * shear / 3 * (stretch ** (1 / 3) - stretch ** (-5 / 3))
              + (1 - biot) * bulk * (stretch - 1))
    assert P[1, 1] == pytest.approx(closed, rel=1e-11, abs=1e-13)
    np.testing.assert_array_equal(P[~np.eye(dim, dtype=bool)], 0.0)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("dim", [2, 3])
def test_constrained_modulus_is_the_stiffness_of_confined_compression(law, dim):
    D = law.tangent(Deformation(np.zeros((dim, dim)), law.finite))
    assert D[1, 1, 1, 1] == pytest.approx(law.constrained_modulus, rel=1e-14)
    assert law.constrained_modulus == pytest.approx(K + 4 * G / 3)


@given(displacement_gradients(3), ANGLES)
def test_von_mises_of_the_cauchy_stress(H, angle):
    F = np.eye(3) + H
    sigma = stress(NEO, H) @ F.T / np.linalg.det(F)
    a, b, c = np.linalg.eigvalsh((sigma + sigma.T) / 2)
    by_principal = np.sqrt(((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2) / 2)
    found = von_mises_stress(NEO, Deformation(H, True))
    assert found == pytest.approx(by_principal, rel=1e-9, abs=1e-13)
    turned = rotation(3, angle) @ F - np.eye(3)
    assert von_mises_stress(NEO, Deformation(turned, True)) == pytest.approx(found, abs=1e-10)


@pytest.mark.parametrize("law", LAWS)
def test_von_mises_of_known_states(law):
    swollen = Deformation(0.1 * np.eye(3), law.finite)
    assert von_mises_stress(law, swollen) == pytest.approx(0.0, abs=1e-15)
    sheared = np.zeros((2, 2))
    sheared[0, 1] = 1e-6
    found = von_mises_stress(law, Deformation(sheared, law.finite))
    assert found == pytest.approx(np.sqrt(3.0) * G * 1e-6, rel=1e-5)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("dim", [2, 3])
def test_points_of_an_array_do_not_mix(law, dim):
    H = 0.1 * np.random.default_rng(3).standard_normal((4, 5, dim, dim))
    whole, single = Deformation(H, law.finite), Deformation(H[1, 4], law.finite)
    np.testing.assert_allclose(law.stress(whole)[1, 4], law.stress(single), atol=1e-13)
    np.testing.assert_allclose(law.tangent(whole)[1, 4], law.tangent(single), atol=1e-13)
