"""Loads that travel over a linear biphasic layer, Peclet numbers 1 to 1000.

Closed form by wave number: ``travelling_wave``.  The terms Skeleton, Pores, Carry and Streamline
are solved on a block that moves with a uniform velocity (``moving_layer``): one wave with exact
values at the ends; a smooth local load with the natural ends of a scene; a sealed patch, whose
outlet has a layer of thickness c/U that these meshes do not resolve.
"""

from functools import cache

import numpy as np
import pytest
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray

from tests.physics.layer_kernel import gauss
from tests.physics.moving_layer import Exact, MovingLayer
from tests.physics.travelling_wave import Layer, wave

Array = NDArray[np.float64]
Q = np.pi / 2.0  # wave number times thickness
SIZE = 1e-2  # of all loads, in moduli
PECLETS = [1.0, 10.0, 100.0, 1000.0]


def layer(peclet: float, drained: bool = True) -> Layer:
    return Layer(shear=0.4, modulus=1.4, biot=0.9, mobility=0.7, peclet=peclet, drained=drained)


def orders(errors: list[float]) -> Array:
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


# -- the reference ------------------------------------------------------------------------
@pytest.mark.parametrize("drained", [True, False])
@pytest.mark.parametrize("peclet", [1.0, 30.0, 1000.0])
def test_closed_form_satisfies_equations_and_conditions(peclet: float, drained: bool) -> None:
    of = layer(peclet, drained)

    def fitted(name: str) -> Chebyshev:
        return Chebyshev.interpolate(lambda y: getattr(wave(of, Q, y), name), 120, [0.0, 1.0])

    ux, uy, p, e = (fitted(name) for name in ("ux", "uy", "p", "e"))
    y = np.linspace(0.02, 0.98, 60)  # differentiation loses digits at the ends
    G, M, a = of.shear, of.modulus, of.biot
    scale = np.abs(p.deriv(2)(y)).max()
    volume = 1j * Q * ux(y) + uy.deriv()(y) - e(y)
    along = G * (ux.deriv(2) - Q**2 * ux)(y) + 1j * Q * ((M - G) * e - a * p)(y)
    across = G * (uy.deriv(2) - Q**2 * uy)(y) + ((M - G) * e.deriv() - a * p.deriv())(y)
    mass = a * of.speed * 1j * Q * e(y) - of.mobility * (p.deriv(2) - Q**2 * p)(y)
    for residual in (volume, along, across, mass):
        assert np.abs(residual).max() < 1e-7 * scale
    bottom, top = wave(of, Q, np.zeros(1)), wave(of, Q, np.ones(1))
    zero = [bottom.ux, bottom.uy, bottom.p_y, top.shear_stress, top.normal_stress + 1.0,
            top.p if drained else top.p_y]
    assert np.abs(zero).max() < 1e-12


# -- one wave, exact at the ends ----------------------------------------------------------
def travelling(of: Layer) -> Exact:
    """Real part of the wave, by position."""
    def fields(x: Array, y: Array) -> tuple[Array, Array, Array]:
        heights, where = np.unique(np.round(y, 13), return_inverse=True)
        found = wave(of, Q, heights)
        phase = SIZE * np.exp(1j * Q * x)

        def real(f: NDArray[np.complex128]) -> Array:
            return (f[where].reshape(np.shape(y)) * phase).real

        return real(found.ux), real(found.uy), real(found.p)

    return fields


@cache
def one_wave(peclet: float, drained: bool, elements: int, stabilised: bool = True) -> MovingLayer:
    of = layer(peclet, drained)
    return MovingLayer(of, 2.0 * np.pi / Q, elements, lambda x: SIZE * np.cos(Q * x),
                       travelling(of), stabilised)


def wave_errors(peclet: float, drained: bool, stabilised: bool = True) -> tuple[list[float], ...]:
    """Relative L2 errors of u and of p on 8, 16, 32 elements per thickness."""
    exact = travelling(layer(peclet, drained))
    found = [one_wave(peclet, drained, n, stabilised).errors(exact) for n in (8, 16, 32)]
    return [u for u, _ in found], [p for _, p in found]


@pytest.mark.parametrize("drained", [True, False])
@pytest.mark.parametrize("peclet", [1.0, 10.0])
def test_second_order_where_the_flow_is_resolved(peclet: float, drained: bool) -> None:
    """u and p, stabilised.  u is one order below its best, as p (linear) drives it."""
    for errors in wave_errors(peclet, drained):
        assert np.all(orders(errors) > 1.9), errors
        assert errors[-1] < 2e-3, errors


@pytest.mark.parametrize("drained", [True, False])
@pytest.mark.parametrize("peclet", [100.0, 1000.0])
def test_errors_stay_small_where_it_is_not(peclet: float, drained: bool) -> None:
    """Under a drained top p has a layer of thickness 1/sqrt(q Pe), 0.025 at 1000."""
    u, p = wave_errors(peclet, drained)
    assert np.all(orders(u) > 1.4), u
    assert np.all(orders(p) > 1.3), p
    assert u[-1] < 2e-3, u
    assert p[-1] < 0.025, p


@pytest.mark.parametrize("drained", [True, False])
@pytest.mark.parametrize("peclet", PECLETS)
def test_stabilisation_costs_little_where_none_is_needed(peclet: float, drained: bool) -> None:
    """A smooth wave needs none: errors at most twice those of plain Galerkin, on every mesh."""
    for with_it, plain in zip(wave_errors(peclet, drained),
                              wave_errors(peclet, drained, stabilised=False), strict=True):
        assert np.all(np.array(with_it) < 2.0 * np.array(plain)), (with_it, plain)


@pytest.mark.parametrize("drained", [True, False])
@pytest.mark.parametrize("peclet", PECLETS)
def test_plain_galerkin_is_of_second_order_too(peclet: float, drained: bool) -> None:
    """The carry term itself, without stabilisation: a smooth wave needs none."""
    u, p = wave_errors(peclet, drained, stabilised=False)
    least = 1.9 if peclet < 1000.0 else 1.75  # a layer of thickness 0.03 under the drained top
    assert orders(u)[-1] > least, u
    assert orders(p)[-1] > least, p


@pytest.mark.parametrize("peclet", [1.0, 10.0])
def test_stabilisation_vanishes_under_refinement(peclet: float) -> None:
    """Difference of the bone pressure with and without: second order."""
    changes = []
    for n in (8, 16, 32):
        (_, p), (_, plain) = (one_wave(peclet, True, n, on).line("p", "bottom")
                              for on in (True, False))
        changes.append(float(np.abs(p - plain).max() / np.abs(plain).max()))
    assert np.all(orders(changes) > 1.8), changes
    assert changes[-1] < 2e-3, changes


@pytest.mark.parametrize("elements", [4, 8, 16])
@pytest.mark.parametrize("peclet", PECLETS)
def test_wave_has_no_sawtooth(peclet: float, elements: int) -> None:
    """Total variation of the bone pressure: that of the wave, within 3 %."""
    for drained in (True, False):
        x, p = one_wave(peclet, drained, elements).line("p", "bottom")
        exact = travelling(layer(peclet, drained))(x, np.zeros_like(x))[2]
        ratio = np.abs(np.diff(p[:, 0])).sum() / np.abs(np.diff(exact)).sum()
        assert ratio == pytest.approx(1.0, abs=0.03)


# -- a local load, ends as in a scene -----------------------------------------------------
SPREAD, WIDTH, NEAR = 0.7, 24.0, 5.0


def bell(x: Array) -> Array:
    return SIZE * np.exp(-((x / SPREAD) ** 2) / 2.0)


def superposed(of: Layer, height: float, x: Array) -> tuple[Array, Array]:
    """u_y and p at (x, height) under `bell`: the integral over all wave numbers."""
    root, w = gauss(np.linspace(0.0, np.sqrt(8.0 / SPREAD), 13), 20)
    q, w = root**2, w * 2.0 * root  # finer where the waves are long and carried far
    share = w * SIZE * SPREAD * np.sqrt(2.0 / np.pi) * np.exp(-((q * SPREAD) ** 2) / 2.0)
    parts = [wave(of, k, np.array([height])) for k in q]
    phase = np.exp(1j * np.outer(x, q))
    uy, p = (np.array([getattr(f, name)[0] for f in parts]) for name in ("uy", "p"))
    return (phase @ (share * uy)).real, (phase @ (share * p)).real


@pytest.mark.parametrize("peclet", PECLETS)
def test_local_load_with_the_ends_of_a_scene(peclet: float) -> None:
    """Bone pressure and sinking of the top near the load, fresh material from the left."""
    of = layer(peclet)
    pressure, sinking = [], []
    for n in (4, 8, 16):
        m = MovingLayer(of, WIDTH, n, bell)
        x, p = m.line("p", "bottom")
        near = np.abs(x) < NEAR
        exact = superposed(of, 0.0, x[near])[1]
        pressure.append(float(np.abs(p[near, 0] - exact).max() / np.abs(exact).max()))
        variation = np.abs(np.diff(p[near, 0])).sum() / np.abs(np.diff(exact)).sum()
        assert variation < 1.03
        x, u = m.line("u", "top")
        near = np.abs(x) < NEAR
        exact = superposed(of, 1.0, x[near])[0]
        sinking.append(float(np.abs(u[near, 1] - exact).max() / np.abs(exact).max()))
    least = {1.0: 1.9, 10.0: 1.9, 100.0: 1.7, 1000.0: 1.4}[peclet]
    for errors in (pressure, sinking):
        assert orders(errors)[-1] > least, errors
        assert errors[-1] < (0.002 if peclet <= 10.0 else 0.01), errors


# -- a sealed patch -----------------------------------------------------------------------
def patch_pressure(elements: int, stabilised: bool, peclet: float = 1000.0) -> Array:
    """Pressure along the sealed patch |x| < 1 under the ellipse of Hertz, p = 0 beside it."""
    def load(x: Array) -> Array:
        return SIZE * np.sqrt(np.maximum(1.0 - x**2, 0.0))

    m = MovingLayer(layer(peclet), 6.0, elements, load, stabilised=stabilised, sealed=1.0)
    x, p = m.line("p", "top")
    return p[np.abs(x) < 1.0 + 1e-9, 0]


def excess_variation(p: Array) -> float:
    """Total variation over that of one hump."""
    return float(np.abs(np.diff(p)).sum() / (2.0 * p.max()) - 1.0)


@pytest.mark.parametrize("elements", [8, 16, 32])
def test_unresolved_outlet_has_no_sawtooth(elements: int) -> None:
    """Cell Peclet numbers 62, 31, 16: one hump, where plain Galerkin oscillates up to 20 %."""
    assert abs(excess_variation(patch_pressure(elements, stabilised=True))) < 1e-6


def test_plain_galerkin_does_oscillate_there() -> None:
    assert excess_variation(patch_pressure(8, stabilised=False)) > 0.1
