"""The presets solve what the direct solver solves, effect by effect, in few iterations."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from porolub.scene import Scene, load_scene, scene_from_dict
from porolub.solve.linear import Linear
from porolub.solve.model import Model
from porolub.solve.newton import Clock, Newton
from porolub.solve.options import set_options
from tests.solve.models import BLOCK, JOBS, PORES, case1, model_of, vector, waves

WET: dict[str, Any] = BLOCK | {
    "pores": PORES, "boundary": {"top": {"traction": "10 kPa", "pressure": "0 Pa"}}}
MOVING: dict[str, Any] = WET | {
    "solid": BLOCK["solid"] | {"inertia": True, "density": "1100 kg/m^3"},
    "time": {"end": "1 s", "start": "rest"}}
RIGID = {k: v for k, v in BLOCK.items() if k != "solid"} | {
    "film": {"viscosity": "1 mPa*s"}, "load": {"approach": "-10 um"},
    "motion": {"kind": "sliding", "speed": "0.1 m/s"}}
COARSE = ["mesh.along=16", "mesh.across=2", "mesh.deep=4"]

SCENES: dict[str, Scene] = {
    "every effect": case1(40, 5),
    "bonded, friction shears": case1(40, 5, job="case1_bonded"),
    "sliding plane": case1(40, 5, job="appendix_a"),
    "dry contact": case1(30, 4, job="dry_contact"),
    "linear solid": case1(40, 5, "solid.law=linear"),
    "linear elements": case1(40, 5, "mesh.degree=1"),
    "triangles": case1(30, 4, "mesh.element=triangle"),
    "prescribed approach": load_scene(JOBS / "case1.toml", [
        "mesh.along=40", "mesh.across=5", "load={approach='50 um'}"]),
    "pores alone": scene_from_dict(WET),
    "inertia": scene_from_dict(MOVING),
    "rigid film": scene_from_dict(RIGID),
    "a crown in 3D": load_scene(JOBS / "joint3d.toml", COARSE),
}


def stable(scene: Scene) -> bool:
    """Whether the elements of u and p make a stable pair; a Schur complement says if not."""
    return scene.pores is None or scene.mesh.pressure_degree < scene.mesh.degree


RATES = {"steady": 0.0, "short step": 1e4}  # per consolidation time of the layer


def newtons_step(model: Model, preset: str, rate: float, tolerance: float = 1e-11
                 ) -> tuple[NDArray[np.float64], int]:
    """Newton's step from a wavy, pressed state by a preset, and its linear iterations."""
    set_options(f"-ksp_rtol {tolerance}" if preset != "direct" else "")
    system = model.system
    x = vector(model, waves(model.dofs, 0.003), conditions=True)
    if "v0" in model.dofs.fields:
        model.dofs.set_scalar("v0", x, 0.05)
    system.steady()
    if rate:
        system.backward_euler(system.physical(model.dofs.to_local(x)), 1.0 / rate)
    newton = Newton(system, Clock(), linear=Linear(model, preset))
    system.residual(x, newton.residual)
    newton.jacobian(newton.snes, x, newton.matrix, newton.matrix)
    y, ksp = x.duplicate(), newton.snes.getKSP()
    ksp.setOperators(newton.matrix)
    ksp.solve(newton.residual, y)
    assert ksp.getConvergedReason() > 0
    found, count = y.array.copy(), ksp.getIterationNumber()
    for thing in (x, y):
        thing.destroy()
    newton.destroy()
    return found, count


@pytest.mark.parametrize("rate", RATES.values(), ids=RATES)
@pytest.mark.parametrize("preset", ["fieldsplit", "nested"])
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_newton_step_is_that_of_the_direct_solver(scene: Scene, preset: str, rate: float
                                                    ) -> None:
    with model_of(scene) as model:
        exact, _ = newtons_step(model, "direct", rate)
        found, iterations = newtons_step(model, preset, rate)
    assert np.abs(found - exact).max() < 1e-5 * np.abs(exact).max()
    assert iterations <= (60 if stable(scene) else 200)


@pytest.mark.parametrize("rate", RATES.values(), ids=RATES)
@pytest.mark.parametrize("job", ["case1", "case1_bonded"])
def test_iterations_hardly_grow_with_refinement(job: str, rate: float) -> None:
    """Eight digits, twelve times the elements; the benchmark tests.bench.iterations has more."""
    counts = []
    for along, across in ((40, 4), (70, 7), (140, 14)):
        with model_of(case1(along, across, job=job)) as model:
            counts.append(newtons_step(model, "fieldsplit", rate, 1e-8)[1])
    assert max(counts) <= 30
    assert counts[-1] <= 1.3 * counts[0] + 1, counts
