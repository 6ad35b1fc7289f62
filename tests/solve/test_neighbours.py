"""Blends of solutions: what they keep, where they put the ends of contact, and in which units."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpi4py import MPI

from porolub.scene import load_scene
from porolub.solve.derived import Derived
from porolub.solve.model import Model
from porolub.solve.neighbours import (
    Neighbour,
    Solution,
    alike,
    blended,
    blended_edges,
    solution_of,
)
from porolub.solve.steady import SteadySolver
from porolub.solve.transfer import Snapshot
from porolub.solve.zones import zones
from tests.solve.models import JOBS, PORES, Array, block, case1, model_of, physical, vector, waves

LENGTH = 0.02  # m, of made-up surfaces
SAME = 1e-13
NAMES = ("closed 0", "closed 1", "pressurised 0", "pressurised 1")
GRADED = {"along": 90, "across": 5, "edges": (-2.5, 4.5), "edge_size": 0.05}


def touching(model: Model, left: float, right: float, depth: float = 0.1) -> Array:
    """A local, physical state: the surface lies on the plane at ``depth`` from ``left`` to
    ``right`` (thicknesses), under parabolas of contact pressure and, somewhat wider, of fluid's."""
    mesh, dofs = model.mesh, model.dofs
    local = np.zeros(dofs.size_local)
    shape, normal = mesh.shape, np.asarray(model.plane.toward)

    def logical(name: str) -> Array:
        return mesh.logical(mesh.coordinates[dofs.nodes[name]])

    def parabola(name: str, wider: float, size: float) -> Array:
        s = (logical(name)[:, 0] - 0.5) * shape.length
        middle, half = (left + right) / 2, wider * (right - left) / 2
        return size * np.maximum(0.0, 1.0 - ((s - middle) / half) ** 2)

    above = logical("u")
    across, above[:, 1] = above[:, 1].copy(), 1.0
    height = model.plane.offset - depth - shape.physical(above) @ normal
    dofs.field("u", local)[...] = (across * height)[:, None] * normal
    dofs.field("l", local)[:, 0] = parabola("l", 1.0, 3.0)
    dofs.field("p", local)[:, 0] = parabola("p", 1.3, 2.0)
    local[dofs.range["v0"]] = depth
    return local


def solution(model: Model, local: Array, conditions: bool = False) -> Solution:
    return solution_of(model, vector(model, local, conditions))


def made_up(closed: tuple[float, float] | None = None, pressed: tuple[float, float] | None = None,
            edges: tuple[float, ...] = ()) -> Solution:
    """A solution without fields; places in shares of the length from the middle."""
    ends = {"closed": closed, "pressurised": pressed}
    marks = {f"{name} {k}": LENGTH * pair[k] for name, pair in ends.items() if pair
             for k in range(2)}
    return Solution(Snapshot((), {}, {}, False), LENGTH, tuple(LENGTH * e for e in edges), marks)


def stretched(places: tuple[float, ...], *others: tuple[Solution, float],
              closed: tuple[float, float] | None = None,
              pressed: tuple[float, float] | None = None, weight: float = 0.5) -> Array:
    """Where a blend puts places of the nearest solution, in shares of the length."""
    nearest = made_up(closed, pressed, places)
    found = blended_edges([Neighbour(nearest, weight), *(Neighbour(*o) for o in others)])
    return np.array(found) / LENGTH


@pytest.mark.parametrize("weights", [(1.0,), (0.3, 0.7)], ids=["one", "twice the same"])
@pytest.mark.parametrize("kind", ["waves", "touching"])
def test_a_blend_of_one_solution_is_that_solution(weights: tuple[float, ...], kind: str) -> None:
    with model_of(case1(40, 4)) as model:
        local = waves(model.dofs) if kind == "waves" else touching(model, -3.0, 4.0)
        x = vector(model, local, conditions=True)
        one = solution_of(model, x)
        assert set(one.marks) == set(NAMES)
        y = blended(model, [Neighbour(one, w) for w in weights])
        y.axpy(-1.0, x)
        assert max(model.dofs.field_norms(y, np.inf).values()) < SAME


def test_contact_comes_to_lie_where_the_blend_has_it() -> None:
    """A mean of two solutions would touch as far as the wider one, under a pressure that bends
    where the narrower one ends; carried to a graded mesh, too."""
    scene = case1(240, 5)
    with model_of(scene) as model, model_of(scene, **GRADED) as fine:
        near, far = (solution(model, touching(model, *ends, depth))
                     for ends, depth in (((-2.0, 4.0), 0.06), ((-4.0, 6.0), 0.14)))
        x = blended(fine, [Neighbour(near, 0.75), Neighbour(far, 0.25)])
        expected = touching(fine, -2.5, 4.5, 0.08)
        ends = dict(zones(fine, x))["closed"]
        found = physical(fine, x)
        element = fine.mesh.shape.length / 240
        assert ends == pytest.approx((-2.5, 4.5), abs=element)
        for name in ("l", "p"):
            off = fine.dofs.field(name, found) - fine.dofs.field(name, expected)
            assert np.abs(off).max() < 0.05
        assert fine.dofs.scalar_value("v0", x) == pytest.approx(0.08)


def test_the_surface_stays_on_the_plane_where_both_neighbours_touch_it() -> None:
    """The mean of the displacements alone, shifted by 1 mm along the arc, would miss it."""
    with model_of(case1(240, 5)) as model:
        near = solution(model, touching(model, -1.0, 5.0, 0.06))
        far = solution(model, touching(model, -3.0, 7.0, 0.14))
        x = blended(model, [Neighbour(near, 0.5), Neighbour(far, 0.5)])
        d = Derived(model, x)
        s = d.arc()[d.nodes]
        gap = d.gap()[d.nodes][(s > -1.8) & (s < 5.8)]
    missed = 1.0**2 / (2 * 100.0)  # shift squared over twice the radius, thicknesses
    assert np.abs(gap).max() < 0.01 * missed


def test_pressures_are_kept_in_pascal_and_lengths_in_metres() -> None:
    """Modulus, permeability and thickness set the scaled units; all differ here."""
    stiff = ("solid.shear_modulus=2 MPa", "solid.bulk_modulus=9 MPa")
    scenes = (case1(30, 3), case1(30, 3, *stiff, "pores.permeability=7 um^3/mm"))
    neighbours, largest = [], {"p": 0.0, "l": 0.0}
    for scene, weight, depth in zip(scenes, (0.4, 0.6), (0.03, 0.01), strict=True):
        with model_of(scene) as model:
            local, unit = touching(model, -3.0, 4.0, depth), model.scales.pressure
            found = solution(model, local)
            for name in largest:
                most = model.dofs.field(name, local).max() * unit
                assert found.data.rows[name].max() == pytest.approx(most)
                largest[name] += weight * most
        assert found.length == pytest.approx(np.deg2rad(10.0) * 0.1)
        assert found.data.scalars["v0"] == pytest.approx(depth * 1e-3)
        assert found.marks["closed 1"] == pytest.approx(4e-3, abs=0.6e-3)
        neighbours.append(Neighbour(found, weight))
    with model_of(case1(30, 3, "geometry.thickness=2 mm")) as model:
        x, s = blended(model, neighbours), model.scales
        for name, expected in largest.items():
            most = model.dofs.field(name, physical(model, x)).max() * s.pressure
            assert most == pytest.approx(expected, rel=1e-9)
        v0 = model.dofs.scalar_value("v0", x) * s.length
    assert v0 == pytest.approx(0.4 * 3e-5 + 0.6 * 1e-5)


def test_a_blend_meets_the_conditions_of_its_own_scene() -> None:
    sides = {"left": {"displacement": {"normal": "0.1 mm"}}, "top": {"traction": "1 kPa"}}
    with model_of(block(pores=PORES, boundary={"top": {"traction": "5 kPa"}})) as model, \
            model_of(block(pores=PORES, boundary=sides)) as other:
        found = solution(model, waves(model.dofs), conditions=True)
        assert found.marks == {}
        x = blended(other, [Neighbour(found, 1.0)])
        conditions = other.system.constraints
        assert np.abs(conditions.values).max() > 0.05
        local = other.dofs.to_local(x)
        np.testing.assert_array_equal(local[conditions.fixed], conditions.values)


def test_a_mesh_file_has_no_solution_to_hand_on() -> None:
    model = SteadySolver(load_scene(JOBS / "case1_file.toml"), MPI.COMM_SELF).model()
    with pytest.raises(ValueError, match="structured meshes"):
        solution_of(model, model.dofs.vector())
    model.destroy()


# -- marks, without fields ---------------------------------------------------------------

places = st.lists(st.integers(-49, 49), min_size=4, max_size=4, unique=True).map(
    lambda found: tuple(k / 100 for k in sorted(found)))


@given(places, places, st.floats(0.5, 0.99))
def test_the_stretch_keeps_order_and_ends_and_brings_marks_to_their_mean(
        mine: tuple[float, ...], other: tuple[float, ...], weight: float) -> None:
    line = tuple(np.linspace(-0.5, 0.5, 201))
    far = made_up((other[1], other[2]), (other[0], other[3]))
    found = stretched(line, (far, 1 - weight), closed=(mine[1], mine[2]),
                      pressed=(mine[0], mine[3]), weight=weight)
    assert (np.diff(found) > 0).all()
    np.testing.assert_allclose(found[[0, -1]], [-0.5, 0.5], atol=1e-15)
    at = np.searchsorted(line, np.array(mine) - 1e-9)
    np.testing.assert_allclose(found[at], weight * np.array(mine) + (1 - weight) * np.array(other),
                               atol=1e-12)


def test_of_marks_that_change_places_the_later_named_is_left_out() -> None:
    far = made_up((-0.2, 0.2), (-0.1, 0.3))  # its pressure begins within the contact
    found = stretched((-0.3, -0.2, 0.1, 0.2), (far, 0.5), closed=(-0.2, 0.1), pressed=(-0.3, 0.2))
    # closed and the end of the pressure are where they should be; -0.3 just goes with the rest
    np.testing.assert_allclose(found, [-0.3, -0.2, 0.15, 0.25], atol=1e-15)


def test_marks_that_coincide_in_a_neighbour_are_not_pulled_apart() -> None:
    single = made_up((0.1, 0.1))  # one node touches
    for near, far in ((made_up((0.1, 0.1), edges=(0.1,)), made_up((0.1, 0.3))),
                      (made_up((0.1, 0.3), edges=(0.1,)), single)):
        found = blended_edges([Neighbour(near, 0.6), Neighbour(far, 0.4)])
        np.testing.assert_allclose(np.array(found) / LENGTH, [0.1])


@pytest.mark.parametrize("weight", [0.6, 0.4])
def test_marks_at_the_ends_of_the_surface_stay_out_of_it(weight: float) -> None:
    """A block that touches all over, beside one that does not."""
    line = tuple(np.linspace(-0.5, 0.5, 11))
    whole, part = made_up((-0.5, 0.5), edges=line), made_up((-0.3, 0.4), edges=line)
    found = np.array(blended_edges([Neighbour(whole, weight), Neighbour(part, 1 - weight)]))
    np.testing.assert_allclose(found / LENGTH, line, atol=1e-15)


def test_without_marks_in_common_nothing_is_stretched() -> None:
    line = (-0.4, 0.0, 0.1)
    for far in (made_up(), made_up(pressed=(-0.3, 0.2))):
        np.testing.assert_allclose(stretched(line, (far, 0.4), weight=0.6), line, atol=1e-15)


def test_where_contact_begins_only_what_touches_is_a_start() -> None:
    """Halfway between an open and a closed neighbour there is nothing."""
    closed, wider, open_ = made_up((-0.1, 0.1)), made_up((-0.3, 0.3)), made_up(pressed=(-0.2, 0.2))
    assert closed.closed
    assert not open_.closed
    assert alike([Neighbour(open_, 0.75), Neighbour(closed, 0.25)]) == [Neighbour(closed, 1.0)]
    mixed = [Neighbour(closed, 0.1), Neighbour(open_, 0.5), Neighbour(wider, 0.4)]
    assert alike(mixed) == [Neighbour(closed, pytest.approx(0.2)),
                            Neighbour(wider, pytest.approx(0.8))]
    both_open = [Neighbour(open_, 0.5), Neighbour(made_up(), 0.5)]
    assert alike(both_open) == both_open
    edge = stretched((-0.1,), (open_, 0.4), closed=(-0.1, 0.1), weight=0.6)
    np.testing.assert_allclose(edge, [-0.1])
