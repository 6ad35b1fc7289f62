"""The surface of a body: what acts on it in states simple enough to be worked out by hand."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from scipy.integrate import dblquad

from porolub.fem.points import GRAD, Integrand
from porolub.mesh import build_mesh
from porolub.scene import scene_from_dict
from porolub.solve.derived import Derived, scalars
from porolub.solve.gather import gather_surface
from porolub.solve.model import Model, build_model, scales_of
from porolub.solve.report import SurfaceMap
from porolub.solve.surface_map import directions
from tests.mesh.scenes import box_file
from tests.scene.scenes import changed
from tests.solve.models import Array, model_of, vector
from tests.terms.case1 import BARREL, CUBOID

R, ANGLE, WIDTH, D = 0.1, np.deg2rad(5.0), 10e-3, 1e-3  # of the barrel
CYLINDER = changed(BARREL, geometry={"crown_radius": None}, mesh={"along": 20, "deep": 4})
FREE = changed(CUBOID, geometry={"symmetry": []})
ETA, SPEED = 1e-3, 0.1


def places(model: Model, name: str) -> Array:
    """Positions of a field's nodes, m."""
    return model.mesh.coordinates[model.dofs.nodes[name]] * model.scales.length


def fill(model: Model, **fields: Any) -> Array:
    """A local state with these fields in SI."""
    s, local = model.scales, np.zeros(model.dofs.size_local)
    for name, values in fields.items():
        unit = {"v0": s.length, "p": s.pressure, "l": s.pressure}[name]
        model.dofs.field(name, local)[:, -1] = np.asarray(values) / unit
    return local


def map_of(model: Model, local: Array) -> SurfaceMap:
    found = gather_surface(model, vector(model, local))
    assert isinstance(found, SurfaceMap)
    return found


def facet_area(surface: SurfaceMap) -> float:
    """Area of the facets, their four corners joined by straight lines."""
    a, b, c, d = (surface.nodes[surface.cells[:, k]] for k in range(4))
    return float(np.linalg.norm(np.cross(c - a, d - b), axis=1).sum() / 2)


@pytest.mark.parametrize("direction", ["x", "z"])
def test_the_flux_of_an_even_film_is_reynolds_own(direction: str) -> None:
    h, by_x, by_z = 4e-6, 2e7, -3e7
    scene = scene_from_dict(changed(FREE, motion={"direction": direction}))
    with model_of(scene) as model:
        X = places(model, "p")
        local = fill(model, v0=-h, p=1e5 + by_x * X[:, 0] + by_z * X[:, 2])
        surface = map_of(model, local)
    assert len(surface.s) == 9 * 7
    assert surface.cells.shape == (12, 9)
    assert (surface.cell_type, surface.degree) == ("quad", 2)
    assert facet_area(surface) == pytest.approx(4e-3 * 3e-3)
    np.testing.assert_allclose(surface.nodes[:, 1], D, rtol=1e-12)
    np.testing.assert_allclose(surface.h, h, rtol=1e-9)
    np.testing.assert_allclose(surface.p, 1e5 + by_x * surface.x + by_z * surface.z, rtol=1e-9)
    drag = {"x": (SPEED, 0.0), "z": (0.0, SPEED)}[direction]
    along, aside = (-(h**3) / (12 * ETA) * slope + h / 2 * u
                    for slope, u in zip((by_x, by_z), drag, strict=True))
    size = np.hypot(along, aside)
    np.testing.assert_allclose(surface.Q_s, along, atol=1e-8 * size)
    np.testing.assert_allclose(surface.Q_z, aside, atol=1e-8 * size)
    np.testing.assert_allclose(surface.Q, [[along, 0.0, aside]] * 63, atol=1e-8 * size)
    np.testing.assert_array_equal(surface.p_c, 0.0)


def test_the_integral_of_the_flux_is_kept() -> None:
    with model_of(scene_from_dict(BARREL)) as model:
        X = places(model, "p")
        local = fill(model, v0=20e-6, p=1e5 * np.cos(200 * X[:, 0]) * np.cos(300 * X[:, 2]))
        d = Derived(model, vector(model, local))
        at, film = d.surface, d.film
        assert film is not None
        assert model.surface is not None
        weights = model.surface.weights[d.mine]
        surface = map_of(model, local)
        numbers = np.sort(model.mesh.natural_node[d.mine])
        on = np.searchsorted(numbers, model.mesh.natural_node[d.mine])
        rows = Integrand(jacobian=False)
        film.flow(at, rows)  # with what upwinds it: transported is transported
        expected = -(at.weights[..., None] * rows.f["p", GRAD]).sum((0, 1))
        unit = model.scales.speed * model.scales.length
    size = np.abs(expected).max()
    np.testing.assert_allclose(weights @ surface.Q[on] / unit, expected, atol=1e-9 * size)


def test_flow_out_of_the_layer_is_darcys() -> None:
    with model_of(scene_from_dict(changed(CUBOID, motion={"speed": "1 mm/s"}))) as model:
        y = places(model, "p")[:, 1]
        surface = map_of(model, fill(model, v0=-1e-9, p=1e5 * (1 - y / D)))
    np.testing.assert_allclose(surface.V, 1e-15 / 1e-3 * 1e5 / D, rtol=1e-6)


def test_a_patch_has_an_area_a_width_and_a_length() -> None:
    half, wide = np.deg2rad(2.1), 2.4e-3
    with model_of(scene_from_dict(CYLINDER)) as model:
        X = places(model, "l")
        theta = np.arctan2(X[:, 0], R - X[:, 1])
        closed = (np.abs(theta) < half) & (np.abs(X[:, 2]) < wide)
        local = fill(model, v0=1e-3, l=np.where(closed, 3e4, 0.0))
        found = scalars(model, vector(model, local))
        surface = map_of(model, local)
    assert found["contact_area"] == pytest.approx(2 * R * half * 2 * wide, rel=0.2)  # whole nodes
    assert found["contact_area"] == pytest.approx(found["load_solid"] / 3e4, rel=1e-9)
    assert found["contact_width"] == pytest.approx(2 * np.abs(X[closed, 2]).max(), rel=1e-9)
    assert found["contact_right"] == pytest.approx(R * theta[closed].max(), rel=1e-9)
    assert found["contact_left"] == pytest.approx(R * theta[closed].min(), rel=1e-9)
    np.testing.assert_array_equal(np.sort(surface.p_c), np.sort(np.where(closed, 3e4, 0.0)))
    np.testing.assert_array_equal(surface.h[surface.p_c > 0], 0.0)


def test_without_contact_there_is_no_patch() -> None:
    with model_of(scene_from_dict(CYLINDER)) as model:
        found = scalars(model, vector(model, fill(model, v0=-1e-5)))
    assert (found["contact_area"], found["contact_width"], found["contact_length"]) == (0, 0, 0)
    assert found["contact_left"] is None
    with model_of(scene_from_dict(changed(CYLINDER, contact=None))) as model:
        found = scalars(model, model.dofs.vector())
    assert found["contact_area"] is found["contact_width"] is None


def test_loads_are_integrals_over_the_surface() -> None:
    with model_of(scene_from_dict(CYLINDER)) as model:
        found = scalars(model, vector(model, fill(model, p=2e4, l=5e4)))
    area = 2 * ANGLE * R * WIDTH
    assert found["load_fluid"] == pytest.approx(2e4 * area, rel=1e-9)
    assert found["load_solid"] == pytest.approx(5e4 * area, rel=1e-9)


@pytest.mark.parametrize("speed", [0.0, 2.0])
def test_a_spin_has_the_moment_about_its_axis(speed: float) -> None:
    """A flat block turning about y on its top, all of it pressed alike: M = int mu_s p_c r dA."""
    motion = {"kind": "rotation", "speed": f"{speed} rad/s", "axis": "y", "direction": None,
              "centre": ["0 mm", "0 mm", "1.5 mm"]}
    with model_of(scene_from_dict(changed(FREE, motion=motion))) as model:
        local = fill(model, v0=-5e-6, l=5e4)
        found = scalars(model, vector(model, local))
    moment = dblquad(lambda z, x: np.hypot(x, z), 0, 2e-3, 0, 1.5e-3)[0] * 4
    arm = np.hypot(2e-3, 1.5e-3)
    area = 4e-3 * 3e-3
    dry = 0.45 * moment / arm / area
    viscous = 1e-3 * speed / 5e-6 * dblquad(lambda z, x: x * x + z * z, 0, 2e-3, 0, 1.5e-3)[0] * 4
    expected = dry + viscous / arm / (5e4 * area)
    assert found["friction_coefficient"] == pytest.approx(expected, rel=3e-3)  # nodal sums


@pytest.mark.parametrize("axis", ["x", "z"])
def test_friction_of_a_plane_that_slides_opposes_it(axis: str) -> None:
    """Whichever way it goes; int (h/2 dp/ds + eta U / h) dA, with dp/ds along the motion."""
    h, slope = 5e-6, 4e7
    with model_of(scene_from_dict(changed(FREE, motion={"direction": axis}))) as model:
        X = places(model, "p")[:, "xyz".index(axis)]
        local = fill(model, v0=-h, p=1e5 + slope * X)
        found = scalars(model, vector(model, local))
    shear = (h / 2 * slope + ETA * SPEED / h) * 12e-6
    assert found["friction_fluid"] == pytest.approx(shear / found["load_fluid"], rel=1e-9)


def test_directions_lie_in_the_surface() -> None:
    with model_of(scene_from_dict(BARREL)) as model:
        at = Derived(model, model.dofs.vector()).surface
        along, aside = directions(at)
    for vectors in (along, aside):
        np.testing.assert_allclose(np.linalg.norm(vectors, axis=-1), 1.0)
        np.testing.assert_allclose((vectors * at.normal).sum(-1), 0.0, atol=1e-12)
    np.testing.assert_allclose((along * aside).sum(-1), 0.0, atol=1e-12)
    np.testing.assert_allclose(along[..., 2], 0.0, atol=1e-12)
    assert along[..., 0].min() > 0.9
    assert aside[..., 2].min() > 0.9


SIDES = {"top": "lubricated", "bottom": "bone", "left": "inlet", "right": "outlet"}


def test_tetrahedra_have_maps_too(tmp_path: Path) -> None:
    """Contact acts in the middles of their sides: the corners have the mean around them."""
    path = box_file(tmp_path / "box.msh", order=2, hexahedra=False, names=SIDES)
    geometry = {"shape": "file", "path": str(path), "plane_normal": [0, 1, 0], "symmetry": []}
    tables = changed(CUBOID, mesh=None)
    wanted = scene_from_dict({**tables, "geometry": geometry})
    h, by_x, by_z = 4e-6, 2e7, -3e7
    mesh = build_mesh(wanted, MPI.COMM_SELF, length_scale=D)
    model = build_model(wanted, mesh, scales_of(wanted, D))
    assert model.surface is not None
    X = places(model, "p")
    local = fill(model, v0=-h, p=1e5 + by_x * X[:, 0] + by_z * X[:, 2], l=3e4)
    surface, found = map_of(model, local), scalars(model, vector(model, local))
    pressed = fill(model, v0=1e-5, l=3e4)
    touching = map_of(model, pressed)
    model.destroy()
    assert (surface.cell_type, surface.degree) == ("triangle", 2)
    assert surface.cells.shape[1] == 6
    corners = surface.nodes[surface.cells[:, :3]]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                           axis=1) / 2  # fmt: skip
    area = found["load_solid"] / 3e4
    assert areas.sum() == pytest.approx(area, rel=1e-9)
    np.testing.assert_allclose(surface.p, 1e5 + by_x * surface.x + by_z * surface.z, rtol=1e-9)
    np.testing.assert_allclose(surface.Q_s, -(h**3) / 12 / ETA * by_x + h / 2 * SPEED, rtol=1e-8)
    np.testing.assert_allclose(surface.Q_z, -(h**3) / 12 / ETA * by_z, rtol=1e-8)
    np.testing.assert_allclose(touching.p_c, 3e4, rtol=1e-12)
