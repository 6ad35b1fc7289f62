"""Started from neighbours: the state found from zero, sooner; and from zero where that fails."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from porolub.scene import Scene, scene_from_dict
from porolub.solve.model import Model
from porolub.solve.neighbours import Neighbour, Solution, blended_edges, solution_of
from porolub.solve.steady import EDGES_MOVED, Outcome, SteadySolver
from porolub.solve.zones import contact_edges
from tests.scene.scenes import changed
from tests.solve.models import PORES, block, case1
from tests.terms.case1 import BARREL

SCRIPT = Path(__file__).with_name("warm_ranks.py")
SAME = 1e-8  # scaled, largest difference of any unknown
SLIDES = {"kind": "sliding", "speed": "0.1 m/s"}


class Observed(SteadySolver):
    """Notes what each mesh it makes was refined toward."""

    def model(self, edges: tuple[float, ...] = ()) -> Model:
        self.__dict__.setdefault("meshes", []).append(edges)
        return super().model(edges)


@contextmanager
def solved(
    scene: Scene, neighbours: Sequence[Neighbour] = ()
) -> Iterator[tuple[Observed, Outcome]]:
    solver = Observed(scene, MPI.COMM_SELF, neighbours=neighbours)
    outcome = solver.solve()
    try:
        assert outcome.converged, outcome.message
        yield solver, outcome
    finally:
        outcome.destroy()


def solution(scene: Scene) -> Solution:
    with solved(scene) as (solver, outcome):
        assert not solver.warm
        return solution_of(outcome.model, outcome.x)


def difference(one: Outcome, other: Outcome) -> float:
    y = one.x.copy()
    y.axpy(-1.0, other.x)
    found = max(one.model.dofs.field_norms(y, np.inf).values())
    y.destroy()
    return found


def between(scene: Callable[[float], Scene], low: float, here: float,
            high: float) -> list[Neighbour]:
    """The solutions at both ends, weighted as for a straight line between them."""
    share = (here - low) / (high - low)
    return [Neighbour(solution(scene(low)), 1.0 - share), Neighbour(solution(scene(high)), share)]


def rolling(force: float) -> Scene:
    return case1(75, 8, f"load.force={force} kN/m")


def softer(modulus: float) -> Scene:
    return case1(75, 8, f"solid.shear_modulus={modulus} MPa",
                 f"solid.bulk_modulus={10 * modulus} MPa")


def bonded(force: float) -> Scene:
    return case1(75, 8, f"load.force={force} kN/m", job="case1_bonded")


def held(approach: float) -> Scene:
    return case1(75, 8, f"load={{approach='{approach} um'}}")


def sliding(force: float) -> Scene:
    return case1(150, 3, f"load.force={force} kN/m", "mesh.grading=none", job="appendix_a")


def flat(force: float) -> Scene:
    return block(contact={"friction": 0.3}, motion=SLIDES, pores=PORES,
                 load={"force": f"{force} kN/m"})


def barrel(force: float) -> Scene:
    return scene_from_dict(changed(
        BARREL, mesh={"along": 36, "across": 2, "deep": 2}, geometry={"crown_radius": "200 mm"},
        load={"force": f"{force} N"}))


@pytest.mark.parametrize(
    ("scene", "low", "here", "high"),
    [(rolling, 1.2, 1.5, 1.8), (softer, 0.4, 0.5, 0.6), (held, 100.0, 110.0, 120.0),
     (sliding, 1.8, 2.0, 2.4), (flat, 1.0, 1.5, 2.0), (barrel, 12.0, 14.0, 18.0)],
    ids=["load", "modulus", "approach", "sliding plane", "flat block", "barrel"],
)
def test_it_is_the_state_found_from_zero_in_half_the_iterations(
    scene: Callable[[float], Scene], low: float, here: float, high: float
) -> None:
    neighbours = between(scene, low, here, high)
    with solved(scene(here)) as (_, cold), solved(scene(here), neighbours) as (solver, warm):
        assert solver.warm
        assert difference(cold, warm) < SAME
        assert 2 * warm.newton_iterations <= cold.newton_iterations
        assert warm.rejected_steps == 0
        assert warm.newton_iterations == len(warm.newton)


def test_where_the_ends_of_contact_are_uncertain_it_is_the_same_state_none_the_less() -> None:
    """Under a bonded layer a few nodes bear 5 % of the load; which of them is a matter of luck."""
    neighbours = between(bonded, 1.3, 1.5, 1.7)
    with solved(bonded(1.5)) as (_, cold), solved(bonded(1.5), neighbours) as (solver, warm):
        assert solver.warm
        assert difference(cold, warm) < SAME
        assert warm.newton_iterations < cold.newton_iterations


def test_its_own_solution_is_known_at_once() -> None:
    with solved(rolling(1.5)) as (_, cold):
        own = solution_of(cold.model, cold.x)
        with solved(rolling(1.5), [Neighbour(own, 1.0)]) as (_, warm):
            assert warm.newton_iterations <= 1
            assert difference(cold, warm) < SAME


def graded(force: float) -> Scene:
    return case1(60, 6, f"load.force={force} kN/m", "mesh.grading=contact")


def test_a_graded_mesh_is_refined_where_the_neighbours_say() -> None:
    neighbours = between(graded, 1.4, 1.5, 1.6)
    with solved(graded(1.5), neighbours) as (solver, warm):
        assert solver.warm
        expected = [e * 1e3 for e in blended_edges(neighbours)]
        assert solver.meshes == [pytest.approx(expected)]
        assert warm.edges == solver.meshes[0]
        finest = np.diff(warm.model.mesh.vertex_ticks[0]).argmin()
        tick = (warm.model.mesh.vertex_ticks[0][finest] - 0.5) * warm.model.mesh.shape.length
        assert min(abs(tick - e) for e in warm.edges) < 0.1


def test_a_graded_mesh_whose_edges_moved_is_refined_anew() -> None:
    """From 0.9 to 2 kN/m contact grows by a millimetre to each side."""
    light = solution(graded(0.9))
    with solved(graded(2.0), [Neighbour(light, 1.0)]) as (solver, warm):
        assert solver.warm
        first, second = (np.array(edges) for edges in solver.meshes)
        np.testing.assert_allclose(first, np.array(light.edges) * 1e3)
        assert np.abs(second - first).min() > 5 * EDGES_MOVED
        assert tuple(second) == warm.edges
        now = np.array(contact_edges(warm.model, warm.x))
        assert np.abs(second - now).max() < 0.3 * np.abs(first - now).min()
        assert sum(record.iteration == 1 for record in warm.newton) == 2


def test_from_neighbours_too_far_off_it_starts_from_zero() -> None:
    """From deep contact to a full film: Newton does not get there."""
    pressed = Neighbour(solution(held(150.0)), 1.0)
    with solved(held(-8.0)) as (_, cold), solved(held(-8.0), [pressed]) as (solver, warm):
        assert not solver.warm
        assert difference(cold, warm) < SAME
        assert warm.rejected_steps == 1
        assert warm.newton_iterations > cold.newton_iterations
        assert len(warm.newton) == warm.newton_iterations


def test_where_a_new_mesh_fails_it_starts_from_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    light = solution(graded(0.9))
    carried = SteadySolver._warm
    meshes: list[Model] = []

    def fails_the_second_time(self, model, x):
        meshes.append(model)
        found = carried(self, model, x)
        return found if len(meshes) < 2 else None

    monkeypatch.setattr(SteadySolver, "_warm", fails_the_second_time)
    with solved(graded(2.0)) as (_, cold), \
            solved(graded(2.0), [Neighbour(light, 1.0)]) as (solver, warm):
        assert len(meshes) == 2
        assert not solver.warm
        assert difference(cold, warm) < SAME


@pytest.mark.mpi
def test_ranks_start_from_the_same_blend(run_mpi, tmp_path: Path) -> None:
    found = {}
    for ranks in (1, 2):
        path = tmp_path / f"{ranks}.npz"
        run_mpi(ranks, SCRIPT, path)
        found[ranks] = dict(np.load(path))
    for name, values in found[1].items():
        np.testing.assert_allclose(found[2][name], values, rtol=0, atol=SAME, err_msg=name)
    assert {"plane u", "plane iterations", "barrel l", "barrel edges"} <= set(found[1])
