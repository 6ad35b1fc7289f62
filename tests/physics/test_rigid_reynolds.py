"""Films between rigid surfaces, one of which moves at U: Reynolds' closed forms.

Linear slider of length L, gap from K h0 to h0 (Reynolds 1886; Pinkus and Sternlicht, 3.1):
    W = 6 eta U L^2/h0^2 [ln K/(K - 1)^2 - 2/(K^2 - 1)]   (0.158883 for K = 2),
    p = 6 eta U L/h0^2 (K - 1) X (1 - X)/((K + 1) H^2),   H = h/h0 = K - (K - 1) X,
    q = U h0 K/(K + 1).
Cylinder, full Sommerfeld: p = -2 eta U x/h^2 with p -> 0 far away and no net load.  On a finite
arc with p = 0 at its ends the constant flux is h* U/2 with h* = I2/I3, In = int h^-n ds.
Scenes without [solid]: the film's pressure is the only unknown (and v0 under a load).
"""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from tests.physics.mesh_files import layer_file
from tests.physics.solved import Solved, solved

ETA, U = 0.01, 0.5  # Pa s, m/s
LENGTH, H0 = 0.01, 2e-5  # of the slider, m
RADIUS, GAP = 0.1, 5e-6  # of the cylinder and under it, m

Array = NDArray[np.float64]


@cache
def slider(elements: int, degree: int = 1, ratio: float = 2.0, speed: float = U,
           load: str = f"approach = {-H0} m") -> Solved:
    """A slanted rigid body, its high end to the left; the plane below slides with `speed`."""
    key, _, value = load.partition(" = ")
    x = np.linspace(-LENGTH / 2, LENGTH / 2, elements + 1)
    with TemporaryDirectory() as directory:
        path = layer_file(Path(directory) / "slider.msh", x, np.array([0.0, 1e-3]),
                          lambda x: (ratio - 1.0) * H0 * (0.5 - x / LENGTH))
        return solved({
            "geometry": {"shape": "file", "path": str(path)},
            "mesh": {"pressure_degree": degree},
            "film": {"viscosity": f"{ETA} Pa*s"},
            "motion": {"kind": "sliding", "speed": f"{speed} m/s"},
            "load": {key: value},
        })


def slider_load(ratio: float, lowest: float = H0) -> float:
    shape = np.log(ratio) / (ratio - 1.0) ** 2 - 2.0 / (ratio**2 - 1.0)
    return 6.0 * ETA * U * LENGTH**2 / lowest**2 * shape


def slider_pressure(x: Array, ratio: float) -> Array:
    X = 0.5 + x / LENGTH
    H = ratio - (ratio - 1.0) * X
    size = 6.0 * ETA * U * LENGTH / H0**2
    return size * (ratio - 1.0) * X * (1.0 - X) / ((ratio + 1.0) * H**2)


def orders(errors: list[float]) -> Array:
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_number_of_the_textbook() -> None:
    assert slider_load(2.0) == pytest.approx(0.158883 * ETA * U * LENGTH**2 / H0**2, rel=5e-6)


@pytest.mark.parametrize("ratio", [1.5, 2.0, 3.0])
def test_slider_carries_its_load(ratio: float) -> None:
    s = slider(32, 2, ratio)
    x, exact = s.surface.x, slider_pressure(s.surface.x, ratio)
    assert s.values["load_fluid"] == pytest.approx(slider_load(ratio), rel=1e-5)
    assert s.surface.p == pytest.approx(exact, abs=5e-5 * exact.max())
    flux = s.surface.Q
    assert flux == pytest.approx(np.full(len(x), U * H0 * ratio / (ratio + 1.0)), rel=1e-4)
    assert s.values["film_min"] == pytest.approx(H0, rel=1e-9)
    assert s.values["mass_balance_error"] < 1e-8


@pytest.mark.parametrize(("degree", "meshes", "least"), [(1, (8, 16, 32, 64), 1.9),
                                                         (2, (4, 8, 16), 3.5)])
def test_slider_orders(degree: int, meshes: tuple[int, ...], least: float) -> None:
    """Load: order 2 for linear, 4 for quadratic pressure (the energy of the error)."""
    errors = [abs(slider(n, degree).values["load_fluid"] / slider_load(2.0) - 1.0) for n in meshes]
    assert np.all(orders(errors) > least), errors
    assert errors[-1] < 1e-3, errors


def test_slider_profile_converges() -> None:
    """Largest error of the nodal pressure: order 2, linear pressure."""
    errors = []
    for n in (16, 32, 64):
        surface = slider(n).surface
        exact = slider_pressure(surface.x, 2.0)
        errors.append(float(np.abs(surface.p - exact)[::2].max() / exact.max()))
    assert np.all(orders(errors) > 1.9), errors
    assert errors[-1] < 1e-3, errors


def test_reversed_slider_sucks() -> None:
    """Reynolds' equation without cavitation is linear: p changes its sign with U."""
    forth, back = slider(16), slider(16, speed=-U)
    assert back.surface.p == pytest.approx(-forth.surface.p, abs=1e-9 * forth.surface.p.max())


@pytest.mark.parametrize("lowest", [5e-5, 2e-5, 5e-6, 1e-6])
def test_film_under_a_given_load(lowest: float) -> None:
    """From zero to the film that carries the load, K = 1.4 to 21."""
    force = slider_load(1.0 + H0 / lowest, lowest)  # the slope stays: K h0 - h0 = 20 um
    s = slider(64, 2, load=f"force = {force} N/m")
    assert -s.values["approach"] == pytest.approx(lowest, rel=1e-3)
    assert s.values["load_balance_error"] < 1e-8


@pytest.mark.parametrize("speed", [5.0, 500.0])
def test_no_pressure_is_too_high_for_rigid_walls(speed: float) -> None:
    """0.3 and 31 MPa: the equation is linear in p, so two iterations do."""
    s = slider(32, 2, speed=speed)
    assert s.values["load_fluid"] == pytest.approx(slider_load(2.0) * speed / U, rel=1e-5)
    assert s.outcome.newton_iterations <= 3


HALF = 10.0 * np.sqrt(2.0 * RADIUS * GAP)  # of the arc of the cylinder, m


@cache
def cylinder(elements: int, degree: int = 1, kind: str = "rotation", solid: bool = False) -> Solved:
    """A cylinder over a plane; it turns, or the plane slides."""
    speed = f"{U / RADIUS} rad/s" if kind == "rotation" else f"{U} m/s"
    tables = {
        "geometry": {"shape": "sector", "outer_radius": f"{RADIUS} m", "thickness": "1 mm",
                     "half_angle": f"{HALF / RADIUS} rad"},
        "mesh": {"along": elements, "across": 1, "pressure_degree": degree},
        "film": {"viscosity": f"{ETA} Pa*s"},
        "motion": {"kind": kind, "speed": speed},
        "load": {"approach": f"{-GAP} m"},
    }
    if solid:
        tables["solid"] = {"law": "linear", "young_modulus": "100 GPa", "poisson_ratio": 0.3,
                           "base": "bonded"}
    return solved(tables)


def cylinder_pressure(s: Array) -> Array:
    """On the finite arc, p = 0 at both ends."""
    fine = np.linspace(-HALF, HALF, 200001)
    h = GAP + 2.0 * RADIUS * np.sin(fine / RADIUS / 2.0) ** 2
    two, three = (cumulative_trapezoid(h**-n, fine, initial=0.0) for n in (2.0, 3.0))
    return np.interp(s, fine, 6.0 * ETA * U * (two - two[-1] / three[-1] * three))


def test_cylinder_orders() -> None:
    """Largest error of the nodal pressure, linear pressure: order 2."""
    errors = []
    for n in (160, 320, 640):
        surface = cylinder(n).surface
        exact = cylinder_pressure(surface.s)
        errors.append(float(np.abs(surface.p - exact)[::2].max() / exact.max()))
    assert np.all(orders(errors) > 1.9), errors
    assert errors[-1] < 2e-3, errors


def test_cylinder_has_the_pressure_of_sommerfeld_and_no_load() -> None:
    s = cylinder(160, 2)
    x = s.surface.s
    exact = cylinder_pressure(x)
    assert s.surface.p == pytest.approx(exact, abs=1e-4 * exact.max())
    h = GAP + x**2 / (2.0 * RADIUS)
    assert s.surface.p == pytest.approx(-2.0 * ETA * U * x / h**2, abs=5e-3 * exact.max())
    assert abs(s.values["load_fluid"]) < 1e-10 * exact.max() * HALF
    flux = s.surface.Q
    assert flux == pytest.approx(np.full(len(x), 2.0 / 3.0 * U * GAP), rel=5e-3)


def test_turning_cylinder_and_sliding_plane_pump_alike() -> None:
    """Both carry the film with U/2; along the chord of the arc to (s/R)^2."""
    turning, sliding = cylinder(160, 2).surface.p, cylinder(160, 2, "sliding").surface.p
    assert sliding == pytest.approx(turning, abs=1e-3 * turning.max())


def test_stiff_layer_is_a_rigid_one() -> None:
    """With a skeleton of 100 GPa the film and its upwinding give the pressure of rigid walls."""
    stiff, rigid = cylinder(160, 1, solid=True).surface.p, cylinder(160).surface.p
    assert stiff == pytest.approx(rigid, abs=1e-3 * rigid.max())
