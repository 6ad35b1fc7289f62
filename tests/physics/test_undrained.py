"""A sealed block under load: the fluid shares it at once, by how far it can be compressed.

No fluid leaves, so each point keeps its mass.  With rho = rho_0 exp(chi p) and confined stretch l
    exp(chi p) (eps_0 + a (l - 1) + S_s p) = eps_0,   P(l) - a p = -s,
S_s = S - eps_0 chi; without compressibility a (l - 1) + S p = 0.  Two equations for l and p, solved
here by scipy.  Linear law: P = M (l - 1), so B = p/s = a/(a^2 + M S) without compressibility.
"""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.physics.stepped import Look, Steps, stepped

BULK, SHEAR, THICKNESS = 5e6, 0.5e6, 1e-3
MODULUS = BULK + 4.0 * SHEAR / 3.0
BIOT, POROSITY, STORAGE = 0.9, 0.8, 2e-7  # storage in 1/Pa


def sealed(traction: Any, chi: float | None = None, law: str = "linear", **time: Any) -> Steps:
    pores: dict[str, Any] = {"biot": BIOT, "permeability": "1e-15 m^2", "viscosity": "1 mPa*s",
                             "storage": f"{STORAGE} 1/Pa"}
    if chi is not None:
        pores |= {"compressibility": f"{chi} 1/Pa", "porosity": POROSITY}
    return stepped({
        "geometry": {"shape": "block", "width": "0.5 mm", "thickness": f"{THICKNESS} m"},
        "mesh": {"along": 1, "across": 3},
        "solid": {"law": law, "shear_modulus": f"{SHEAR} Pa", "bulk_modulus": f"{BULK} Pa"},
        "pores": pores,
        "boundary": {"top": {"traction": traction}},
        "time": {"end": "1 s", "frames": 0, **time},
    }, looked)


def looked(look: Look) -> tuple[float, float, float]:
    """Lowest and highest pore pressure, Pa, and stretch."""
    _, p = look.pressure()
    return float(p.min()), float(p.max()), 1.0 + look.displacement()[:, 1].min() / THICKNESS


def stress(stretch: float, law: str) -> float:
    if law == "linear":
        return MODULUS * (stretch - 1.0)
    iso = 2.0 * BIOT * SHEAR / 3.0 * (stretch ** (1.0 / 3.0) - stretch ** (-5.0 / 3.0))
    return iso + (1.0 - BIOT) * BULK * (stretch - 1.0)


def undrained(load: float, chi: float, law: str) -> tuple[float, float]:
    """p in Pa and stretch."""
    grains = STORAGE - POROSITY * chi

    def stretch(p: float) -> float:
        return 1.0 + (POROSITY * np.expm1(-chi * p) - grains * p) / BIOT

    p = brentq(lambda p: stress(stretch(p), law) - BIOT * p + load, 0.0, 2.0 * load, xtol=1e-6)
    return p, stretch(p)


def test_share_of_the_fluid() -> None:
    """Skempton's coefficient of confined compression."""
    run = sealed("1 kPa")
    expected = 1e3 * BIOT / (BIOT**2 + MODULUS * STORAGE)
    assert run.sight[:, :2] == pytest.approx(np.full((len(run.seen), 2), expected), rel=1e-9)


@pytest.mark.parametrize("law", ["linear", "neo-hookean"])
@pytest.mark.parametrize("chi", [1e-9, 1e-7, 2.5e-7])
def test_a_compressible_fluid_yields(law: str, chi: float) -> None:
    """Up to chi p of 0.2: the law of the density is seen, not its first term alone."""
    load = 1e6
    run = sealed(f"{load} Pa", chi, law)
    p, stretch = undrained(load, chi, law)
    for lowest, highest, found in run.seen:
        assert (lowest, highest) == pytest.approx((p, p), rel=1e-8)
        assert found == pytest.approx(stretch, abs=1e-9)


def test_the_law_of_the_density_is_seen() -> None:
    """Against the same storage with a constant density, by a few per cent."""
    plain, curved = undrained(1e6, 0.0, "linear")[0], undrained(1e6, 2.5e-7, "linear")[0]
    assert sealed("1 MPa").seen[-1][0] == pytest.approx(plain, rel=1e-8)
    assert abs(curved / plain - 1.0) > 0.02


def test_a_load_that_swings_is_answered_at_once() -> None:
    chi = 2e-7
    swing = {"mean": "0.5 MPa", "amplitude": "0.4 MPa", "frequency": "1 Hz", "shape": "cosine"}
    run = sealed(swing, chi)
    load = 0.5e6 + 0.4e6 * np.cos(2.0 * np.pi * run["time"])
    exact = np.array([undrained(s, chi, "linear")[0] for s in load])
    assert run.sight[:, 0] == pytest.approx(exact, rel=1e-6)
    assert run.sight[:, 1] == pytest.approx(exact, rel=1e-6)


def test_mass_and_not_volume_is_kept() -> None:
    """Sealed means that the mass of fluid stays what it was, whatever the load does."""
    swing = {"mean": "0.5 MPa", "amplitude": "0.4 MPa", "frequency": "1 Hz", "shape": "sine"}
    run = sealed(swing, 2e-7, "neo-hookean")
    in_pores = 1000.0 * POROSITY * 0.5e-3 * THICKNESS  # kg/m, undeformed
    assert np.ptp(run.sight[:, 2]) > 0.01
    assert np.abs(run["fluid_content"]).max() < 1e-9 * in_pores
    assert np.abs(run["fluid_gained"]).max() < 1e-9 * in_pores
