"""What a stable steady state is, and the checks of it.

1. It is a steady state: one more Newton iteration of the steady equations changes nothing.
2. The material is not turned inside out: J > 0 at all points.
3. The load asked for is carried; the fluid that enters leaves.
4. Contact: no node penetrates, none pulls, and none that is open presses.
5. The fluid pressure along the surface does not oscillate from node to node: it rises and falls
   between its two extremes and the ambient ends, and no further.
"""

from pathlib import Path

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.scene import Scene, load_scene
from porolub.solve.derived import Derived, scalars
from porolub.solve.gather import gather_surface
from porolub.solve.linear import Linear
from porolub.solve.newton import Clock, Newton
from porolub.solve.steady import Outcome, SteadySolver

Array = NDArray[np.float64]
JOBS = Path(__file__).resolve().parents[2] / "jobs"

STEADY = 1e-8  # largest change by a further iteration, in thicknesses and layer moduli
BALANCE = 1e-8  # relative
PENETRATION = 1e-9  # m
PULL = 1e-9  # of the layer's modulus
SAWTOOTH = 0.01  # of the range of p: steps to and fro between neighbours
VARIATION = 1.05  # total variation of p over the least its extremes allow


def scene_of(base: str, speed: float, load: float, friction: bool, along: int, across: int,
             *overrides: str) -> Scene:
    """Case 1 with one of the two bases; rad/s, kN/m."""
    job = {"sliding": "case1.toml", "bonded": "case1_bonded.toml"}[base]
    return load_scene(JOBS / job, [
        f"mesh.along={along}", f"mesh.across={across}", f"motion.speed={speed} rad/s",
        f"load.force={load} kN/m", f"contact.friction_traction={str(friction).lower()}",
        *overrides])


def solve(scene: Scene) -> Outcome:
    return SteadySolver(scene, MPI.COMM_SELF).solve()


def variation(p: Array) -> float:
    """Total variation of nodal values."""
    return float(np.abs(np.diff(p)).sum())


def least_variation(p: Array) -> float:
    """The total variation that values from 0 through their extremes and back cannot avoid."""
    return 2.0 * (max(p.max(), 0.0) - min(p.min(), 0.0))


def sawtooth(p: Array) -> float:
    """Largest step that neighbours take to and fro: the least of three alternating steps."""
    steps = np.diff(p)
    first, second, third = steps[:-2], steps[1:-1], steps[2:]
    alternate = (first * second < 0) & (second * third < 0)
    least = np.minimum(np.minimum(np.abs(first), np.abs(second)), np.abs(third))
    return float((least * alternate).max(initial=0.0))


def assert_stable(outcome: Outcome) -> None:
    """All five."""
    assert outcome.converged, outcome.message
    model, x = outcome.model, outcome.x
    assert model.system.lowest_jacobian > 0.0
    assert_steady(outcome)
    values = scalars(model, x)
    assert values["load_balance_error"] < BALANCE
    assert values["mass_balance_error"] < BALANCE
    assert_contact(Derived(model, x))
    surface = gather_surface(model, x)
    assert surface is not None
    assert_smooth(surface.p[::2])  # p is linear between the vertices


def assert_steady(outcome: Outcome) -> None:
    assert further_change(outcome) < STEADY


def further_change(outcome: Outcome) -> float:
    """Largest change of an unknown by one more Newton iteration of the steady equations, scaled."""
    model = outcome.model
    assert model.system.rate == 0.0
    before = outcome.x.copy()
    newton = Newton(model.system, Clock(), linear=Linear(model))
    newton.solve(before, max_iterations=1)
    before.axpy(-1.0, outcome.x)
    change = max(model.dofs.field_norms(before, np.inf).values())
    before.destroy()
    newton.destroy()
    return float(change)


def assert_contact(d: Derived) -> None:
    gap, pressure = d.gap()[d.mine], d.nodal("l")[d.mine, 0]  # the unknown, nothing cut off
    assert gap.min() * d.model.scales.length > -PENETRATION
    assert pressure.min() >= -PULL
    assert np.all((pressure <= PULL) | (gap * d.model.scales.length < PENETRATION))


def assert_smooth(p: Array) -> None:
    size = least_variation(p)
    assert variation(p) <= VARIATION * size
    assert sawtooth(p) <= SAWTOOTH * size / 2.0
