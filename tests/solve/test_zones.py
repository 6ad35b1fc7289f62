"""Where contact and the pressurised zone end, and which of these places want fine elements."""

from collections.abc import Callable

import numpy as np
import pytest

from porolub.scene import scene_from_dict
from porolub.solve.model import Model
from porolub.solve.zones import EDGES_APART, PRESSURISED, contact_edges, zones
from tests.scene.scenes import changed
from tests.solve.models import Array, block, case1, model_of, vector
from tests.terms.case1 import BARREL

ON_AXIS = 1e-12
Profile = Callable[[Array], Array]


def along(model: Model, name: str) -> Array:
    """Arc positions (n,) of the nodes of a field, thicknesses."""
    logical = model.mesh.logical(model.mesh.coordinates[model.dofs.nodes[name]])
    return (logical[:, 0] - 0.5) * model.mesh.shape.length


def state(model: Model, contact: Profile, pressure: Profile) -> Array:
    """A local, physical state with these pressures by arc position, else zero."""
    local = np.zeros(model.dofs.size_local)
    for name, profile in (("l", contact), ("p", pressure)):
        model.dofs.field(name, local)[:, 0] = profile(along(model, name))
    return local


def between(left: float, right: float, size: float = 20.0) -> Profile:
    """``size`` in an interval, 0 outside; contact pressures must exceed the gap to count."""
    return lambda s: np.where((s > left) & (s < right), size, 0.0)


def nothing(s: Array) -> Array:
    return np.zeros_like(s)


def found(model: Model, local: Array) -> dict[str, tuple[float, float]]:
    return dict(zones(model, vector(model, local)))


def inside(ticks: Array, left: float, right: float) -> tuple[float, float]:
    """First and last of the ticks in an interval."""
    within = ticks[(ticks > left) & (ticks < right)]
    return float(within[0]), float(within[-1])


def test_the_ends_are_those_nodes_that_lie_in_the_zone() -> None:
    with model_of(case1(30, 3)) as model:
        ends = found(model, state(model, between(-3.1, 4.2), between(-5.0, 2.0, 1.0)))
        nodes, vertices = np.unique(along(model, "l")), np.unique(along(model, "p"))
    assert ends["closed"] == pytest.approx(inside(nodes, -3.1, 4.2), abs=ON_AXIS)
    assert ends["pressurised"] == pytest.approx(inside(vertices, -5.0, 2.0), abs=ON_AXIS)


def test_a_tenth_of_the_largest_pressure_is_where_the_pressurised_zone_ends() -> None:
    with model_of(case1(30, 3)) as model:
        ends = found(model, state(model, nothing, lambda s: np.exp(-np.abs(s - 1.0))))
        vertices = np.unique(along(model, "p"))
        reach = -np.log(PRESSURISED * np.exp(-np.abs(vertices - 1.0)).max())
    assert ends.keys() == {"pressurised"}
    assert ends["pressurised"] == pytest.approx(inside(vertices, 1.0 - reach, 1.0 + reach))


@pytest.mark.parametrize("pressure", [nothing, between(-9.0, 9.0, -1.0)], ids=["none", "suction"])
def test_where_nothing_presses_there_is_no_zone(pressure: Profile) -> None:
    with model_of(case1(12, 3)) as model:
        local = state(model, nothing, pressure)
        assert found(model, local) == {}
        assert contact_edges(model, vector(model, local)) == ()


def test_a_contact_pressure_below_the_gap_closes_nothing() -> None:
    with model_of(case1(12, 3)) as model:
        lifted = state(model, between(-2.0, 2.0, 0.05), nothing)
        lifted[model.dofs.range["v0"]] = -0.1
        assert found(model, lifted) == {}


def test_places_close_together_are_one_to_refine_toward() -> None:
    near, far = 0.4 * EDGES_APART, 2.0 * EDGES_APART
    with model_of(case1(300, 1)) as model:
        local = state(model, between(-3.0, 3.0), between(-3.0 - near, 3.0 + far, 1.0))
        ends, edges = found(model, local), contact_edges(model, vector(model, local))
    assert edges == (*ends["closed"], ends["pressurised"][1])  # ascending, and contact comes first


def test_in_3d_a_zone_reaches_as_far_as_it_does_at_any_width() -> None:
    scene = scene_from_dict(changed(BARREL, mesh={"along": 20, "across": 1, "deep": 2}))
    with model_of(scene) as model:
        local = state(model, nothing, nothing)
        z = model.mesh.coordinates[model.dofs.nodes["l"], 2]
        s = along(model, "l")
        right = np.where(np.abs(z) < 1.0, 5.0, 2.0)
        model.dofs.field("l", local)[:, 0] = np.where((s > -3.0) & (s < right), 90.0, 0.0)
        ends = found(model, local)
    assert ends["closed"] == pytest.approx(inside(np.unique(s), -3.0, 5.0), abs=1e-9)


def test_without_a_lubricated_surface_there_are_no_zones() -> None:
    with model_of(block(boundary={"top": {"traction": "1 kPa"}})) as model:
        x = model.dofs.vector()
        assert dict(zones(model, x)) == {}
        assert contact_edges(model, x) == ()
