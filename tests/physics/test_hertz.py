"""Dry contact of a cylinder whose layer is thick against the contact: Hertz.

Half space (Johnson, Contact Mechanics, 4.2): a^2 = 4 P R/(pi E*), p0^2 = P E*/(pi R),
p = p0 sqrt(1 - x^2/a^2), E* = E/(1 - nu^2).  Half-widths are taken from the pressure itself,
a = 2 rms(x) (weighted by p_c), as the nodes resolve an edge only to their spacing.

A layer of thickness d bonded to its base differs from the half space by O((a/d)^2); the integral
equation of ``layer_kernel`` gives that correction, and the mesh is judged against it.
"""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.optimize import brentq

from tests.physics.layer_kernel import Indentation, indentation
from tests.physics.mesh_files import growing, layer_file
from tests.physics.solved import Solved, solved

R, E, NU = 1.0, 1e6, 0.3
A = 1e-3  # the half-width wanted, m
STAR = E / (1.0 - NU**2)
FORCE = np.pi * STAR * A**2 / (4.0 * R)
PEAK = np.sqrt(FORCE * STAR / (np.pi * R))


@cache
def pressed(depth: int, elements: int) -> Solved:
    """The contact on a layer of `depth` half-widths with `elements` of them per half-width."""
    size, d = A / elements, depth * A
    inner = np.linspace(0.0, 1.5 * A, 3 * elements // 2 + 1)
    half = np.concatenate([inner[:-1], 1.5 * A + growing(size, 3.0 * d - 1.5 * A, 1.25)])
    x = np.concatenate([-half[:0:-1], half])
    with TemporaryDirectory() as directory:
        path = layer_file(Path(directory) / "cylinder.msh", x, growing(size, d, 1.25),
                          lambda x: x**2 / (2.0 * R))
        return solved({
            "geometry": {"shape": "file", "path": str(path)},
            "solid": {"law": "linear", "young_modulus": f"{E} Pa", "poisson_ratio": NU,
                      "base": "bonded"},
            "contact": {},
            "load": {"force": f"{FORCE} N/m"},
        })


@cache
def on_layer(depth: int) -> tuple[float, Indentation]:
    """Half-width and indentation of the layer under the same load, from the kernel."""
    def at(a: float) -> Indentation:
        return indentation(a, R, depth * A, E / (2.0 * (1.0 + NU)), NU, terms=8)

    a = brentq(lambda a: at(a).force - FORCE, 0.5 * A, 1.5 * A, xtol=1e-15, rtol=1e-13)
    return a, at(a)


def half_width(of: Solved) -> float:
    """2 rms(x) weighted by the contact pressure; Simpson's rule is that of the elements."""
    x, p = of.surface.x, of.surface.p_c
    return 2.0 * float(np.sqrt(simpson(p * x**2, x=x) / simpson(p, x=x)))


def orders(errors: list[float]) -> np.ndarray:
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_approaches_the_half_space_with_the_square_of_the_depth() -> None:
    """Depth 8, 16, 32 half-widths, 16 elements each: errors 0.55, 0.14, 0.04 %."""
    found = [pressed(depth, 16) for depth in (8, 16, 32)]
    width = [abs(half_width(s) / A - 1.0) for s in found]
    assert width[-1] < 1e-3, width
    assert np.all(np.abs(orders(width) - 2.0) < 0.25), width
    assert found[-1].values["contact_pressure_max"] == pytest.approx(PEAK, rel=1e-3)


def test_pressure_is_the_ellipse_of_hertz() -> None:
    s = pressed(32, 16)
    x, p = s.surface.x, s.surface.p_c
    exact = PEAK * np.sqrt(np.maximum(1.0 - (x / A) ** 2, 0.0))
    inside = np.abs(x) < 0.9 * A
    assert np.abs(p - exact)[inside].max() < 0.01 * PEAK
    assert np.all(p[np.abs(x) > A * (1.0 + 1.0 / 16.0)] == 0.0)
    assert s.values["contact_length"] / 2.0 == pytest.approx(A, abs=A / 16.0)


def test_converges_to_the_layer_with_the_square_of_the_element_size() -> None:
    """Depth 16, with 4, 8, 16 elements per half-width, against the kernel of the layer."""
    _, exact = on_layer(16)
    found = [pressed(16, n) for n in (4, 8, 16)]
    peak = [abs(s.values["contact_pressure_max"] / exact.peak - 1.0) for s in found]
    width = [abs(half_width(s) / (2.0 * exact.spread) - 1.0) for s in found]
    assert peak[-1] < 5e-4, peak
    assert width[-1] < 1e-4, width
    assert np.all(orders(peak) > 1.8), peak
    assert orders(width).mean() > 1.8, width


@pytest.mark.parametrize("depth", [8, 16, 32])
def test_follows_the_correction_of_the_layer(depth: int) -> None:
    a, exact = on_layer(depth)
    s = pressed(depth, 16)
    assert s.values["approach"] == pytest.approx(exact.approach, rel=1e-3)
    assert s.values["contact_pressure_max"] == pytest.approx(exact.peak, rel=5e-4)
    assert half_width(s) == pytest.approx(2.0 * exact.spread, rel=1e-4)
    assert s.values["contact_length"] / 2.0 == pytest.approx(a, abs=A / 16.0)
