"""The pressure along the surface: resolved without ringing, mirrored by reversed rotation."""

import numpy as np
import pytest

from porolub.solve.derived import scalars
from porolub.solve.gather import gather_surface
from porolub.solve.report import SurfaceData
from tests.hard.stable import assert_smooth, scene_of, solve, variation

Results = tuple[dict[str, float], SurfaceData]


def results(base: str, speed: float, along: int, across: int, *overrides: str) -> Results:
    outcome = solve(scene_of(base, speed, 1.5, base == "bonded", along, across, *overrides))
    assert outcome.converged, outcome.message
    surface = gather_surface(outcome.model, outcome.x)
    assert surface is not None
    return scalars(outcome.model, outcome.x), surface


@pytest.fixture(scope="module")
def graded() -> SurfaceData:
    return results("sliding", 1.0, 150, 15, "mesh.grading=contact")[1]


def test_a_uniform_mesh_does_not_ring(graded: SurfaceData) -> None:
    """It smears the trough at the outlet, but adds no variation of its own."""
    uniform = results("sliding", 1.0, 150, 15)[1]
    assert_smooth(uniform.p[::2])
    assert_smooth(graded.p[::2])
    assert variation(uniform.p[::2]) <= 1.05 * variation(graded.p[::2])


@pytest.mark.slow
def test_the_graded_mesh_has_the_variation_of_a_finer_one(graded: SurfaceData) -> None:
    finer = results("sliding", 1.0, 300, 30, "mesh.grading=contact")[1]
    assert_smooth(finer.p[::2])
    assert variation(graded.p[::2]) == pytest.approx(variation(finer.p[::2]), rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("base", ["sliding", "bonded"])
def test_the_shipped_uniform_mesh_does_not_ring(base: str) -> None:
    uniform = results(base, 1.0, 300, 30)[1]
    finer = results(base, 1.0, 300, 30, "mesh.grading=contact")[1]
    assert_smooth(uniform.p[::2])
    assert variation(uniform.p[::2]) <= 1.05 * variation(finer.p[::2])


@pytest.mark.parametrize("base", ["sliding", "bonded"])
def test_reversed_rotation_mirrors_everything(base: str) -> None:
    values, forward = results(base, 1.0, 60, 6)
    mirrored, backward = results(base, -1.0, 60, 6)
    for key in ("load_fluid", "load_solid", "approach", "friction_coefficient", "contact_length",
                "pressure_max", "pressure_min", "contact_pressure_max"):
        assert mirrored[key] == pytest.approx(values[key], rel=1e-8), key
    exchanged = max(values[f"{way}_{side}"] for way in ("inflow", "outflow")
                    for side in ("left", "right"))
    for way in ("inflow", "outflow"):
        for side, other in (("left", "right"), ("right", "left")):
            assert mirrored[f"{way}_{side}"] == pytest.approx(
                values[f"{way}_{other}"], rel=1e-8, abs=1e-9 * exchanged)
    assert mirrored["contact_left"] == pytest.approx(-values["contact_right"], rel=1e-9)
    for name, sign in (("p", 1), ("p_c", 1), ("h", 1), ("V", 1), ("Q", -1)):
        one, other = getattr(forward, name), getattr(backward, name)[::-1]
        np.testing.assert_allclose(sign * other, one, atol=1e-8 * np.abs(one).max(), err_msg=name)
