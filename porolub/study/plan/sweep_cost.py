"""What a sweep will cost before anything is computed: the cases' Newton steps and memory."""

import heapq
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass

from porolub.scene import Scene, effects
from porolub.scene.cost import Solving, expected_cost, preset_used
from porolub.study.plan.cases import Case

STEPS = {"zero": (10, 20), "neighbour": (4, 10)}
"""Newton steps of most steady cases, by where they start from."""


GROUPS = (1, 16, 128)
"""Numbers of cases side by side for which the time is told."""


@dataclass(frozen=True)
class SweepCost:
    """``unknowns`` and ``step`` (s of a Newton step on one rank): least and most of all cases.

    ``memory``: bytes of the fullest rank of a case. ``wall``: s from and to by the number of cases
    computed side by side, each on one rank; empty where cases run through time, in steps nobody
    can count.
    """

    unknowns: tuple[int, int]
    step: tuple[float, float]
    memory: float
    presets: tuple[str, ...]
    wall: dict[int, tuple[float, float]]


@dataclass(frozen=True)
class _Costs:
    unknowns: int
    preset: str
    solving: Solving


@dataclass(frozen=True)
class _Job:
    case: Case
    scene: Scene
    seconds: float  # of a Newton step on one rank


def sweep_cost(cases: Iterable[Case], ranks: int) -> SweepCost | None:
    """Return what the cases cost on ``ranks`` ranks each; None if all of them were refused.

    Cases of one mesh and model are counted once. Raises SceneError if a mesh file is unreadable.
    """
    known: dict[Hashable, _Costs] = {}
    jobs: list[_Job] = []
    for case in sorted(cases, key=lambda case: case.order):
        if case.scene is not None:
            same = _alike(case.scene)
            if same not in known:
                known[same] = _costs(case.scene)
            jobs.append(_Job(case, case.scene, known[same].solving.seconds))
    if not jobs:
        return None
    unknowns = [costs.unknowns for costs in known.values()]
    seconds = [costs.solving.seconds for costs in known.values()]
    return SweepCost(
        (min(unknowns), max(unknowns)),
        (min(seconds), max(seconds)),
        max(costs.solving.memory_per_rank(ranks) for costs in known.values()),
        tuple(sorted({costs.preset for costs in known.values()})),
        {} if any(job.scene.time for job in jobs) else _walls(jobs),
    )


def _alike(scene: Scene) -> Hashable:
    """Return what decides the cost of a scene."""
    return (scene.dimension, scene.geometry, scene.mesh, scene.solver, tuple(effects(scene)))


def _costs(scene: Scene) -> _Costs:
    cost = expected_cost(scene)
    preset = preset_used(scene.solver.preset, scene.dimension, cost.unknowns)
    return _Costs(cost.unknowns, preset, cost.direct if preset == "direct" else cost.fieldsplit)


def _walls(jobs: Sequence[_Job]) -> dict[int, tuple[float, float]]:
    groups = [n for n in GROUPS if n == 1 or n <= len(jobs)]
    return {n: (_wall(jobs, n, 0), _wall(jobs, n, 1)) for n in groups}


def _wall(jobs: Sequence[_Job], groups: int, guess: int) -> float:
    """Return the s that ``groups`` need; a case waits for those it starts from."""
    free, done = [0.0] * groups, dict[int, float]()
    for job in jobs:
        ready = max((done.get(parent, 0.0) for parent, _ in job.case.parents), default=0.0)
        steps = STEPS["neighbour" if job.case.parents else "zero"][guess]
        end = max(heapq.heappop(free), ready) + steps * job.seconds
        heapq.heappush(free, end)
        done[job.case.index] = end
    return max(free)
