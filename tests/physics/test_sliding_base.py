"""How fluid and skeleton share the load over a frictionless, sliding base.

Linear theory of a thin layer carried through the contact fast: J stays what it was at the inlet
(e = e0), the column is shortened by the plane, eps(x), and no shear holds it, so the total
stress along x is constant:  a p = 2 G eps + const.  Across it,  p_c + b p = 4 G eps + const',
b = 1 (balanced) or a (paper).  Both constants vanish outside the contact, hence
    p/p_c = 1/(2a - 1)  (balanced),      p/p_c = 1/a  (paper).
The film adds to the fluid's share (some per cent in Case 1) and fades with its viscosity.
"""

from functools import cache

import numpy as np
import pytest

from tests.physics.rolling import rolling
from tests.physics.solved import Solved, solved


def theory(biot: float, traction: str) -> float:
    return 1.0 / (2.0 * biot - 1.0) if traction == "balanced" else 1.0 / biot


@cache
def shared(law: str, biot: float, traction: str, viscosity: float) -> Solved:
    """Case 1 on 200 x 8 elements with this law, Biot coefficient and film (mPa s)."""
    return solved(rolling(200, 8, traction=traction, solid={"law": law}, pores={"biot": biot},
                          film={"viscosity": f"{viscosity} mPa*s"}))


@pytest.mark.parametrize("traction", ["balanced", "paper"])
@pytest.mark.parametrize(("biot", "tolerance"), [(0.9, 0.02), (0.8, 0.03), (0.7, 0.06)])
def test_thin_film_leaves_the_share_of_the_theory(biot: float, tolerance: float,
                                                  traction: str) -> None:
    """Small strain, film of a hundredth of the viscosity; the lower a, the more seeps away.

    The theory's shares are 1.25, 1.67, 2.50 (balanced) and 1.11, 1.25, 1.43 (paper).
    """
    ratio = shared("linear", biot, traction, 0.01).values["load_ratio"]
    assert ratio == pytest.approx(theory(biot, traction), rel=tolerance)


@pytest.mark.parametrize("traction", ["balanced", "paper"])
@pytest.mark.parametrize("law", ["linear", "neo-hookean"])
def test_without_a_film_the_share_is_that_of_the_theory(law: str, traction: str) -> None:
    """No [film]: p = 0 beside the contact, sealed inside."""
    tables = rolling(200, 8, traction=traction, solid={"law": law})
    del tables["film"]
    s = solved(tables)
    assert s.values["load_ratio"] == pytest.approx(theory(0.9, traction), rel=0.03)
    assert s.values["mass_balance_error"] < 1e-8
    outside = (s.surface.p_c == 0.0) & (s.surface.h > 3e-6)
    assert np.abs(s.surface.p[outside]).max() < 2e-3 * s.surface.p.max()


@pytest.mark.parametrize("traction", ["balanced", "paper"])
def test_film_adds_to_the_share_of_the_fluid(traction: str) -> None:
    over = [shared("linear", 0.9, traction, viscosity).values["load_ratio"] / theory(0.9, traction)
            for viscosity in (1.0, 0.1, 0.01)]
    assert over[0] > over[1] > over[2], over
    assert np.all(np.array(over) < 1.15), over


@pytest.mark.parametrize("traction", ["balanced", "paper"])
def test_case1_is_near_the_theory(traction: str) -> None:
    """Finite strain and the full film: 5 to 9 % above."""
    over = shared("neo-hookean", 0.9, traction, 1.0).values["load_ratio"] / theory(0.9, traction)
    assert 1.04 < over < 1.10


def test_volume_is_carried_through_unchanged() -> None:
    """J along the middle of the layer varies by far less than the 1 - J it came in with."""
    s = shared("neo-hookean", 0.9, "balanced", 1.0)
    f = s.fields
    depth = 0.1 - np.hypot(f.nodes[:, 0], 0.1 - f.nodes[:, 1])
    x = f.nodes[:, 0]
    middle = (np.abs(depth - 0.5e-3) < 0.1e-3) & (x > -3e-3) & (x < 3e-3)
    volume = f.jacobian[middle]
    assert np.ptp(volume) < 0.1 * (1.0 - volume.mean())
