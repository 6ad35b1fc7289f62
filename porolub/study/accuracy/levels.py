"""The levels of an accuracy study: the scene's own mesh and tolerance, finer and coarser."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from typing import Any

from porolub.scene import Scene
from porolub.solve.steady import EDGE_SIZE

LEVELS = (3, 8)
"""How many levels there may be: three make an order."""
COUNTS = ("along", "across", "deep")
TENFOLD = 10.0  # between two tolerances
LOOSEST = 0.5


@dataclass(frozen=True)
class Level:
    """``size``: of elements or tolerance, over the scene's own; ``values``: by key of the scene;
    ``edge_size``: of a graded mesh on this level, m."""

    name: str
    size: float
    values: dict[str, Any]
    edge_size: float


def mesh_levels(scene: Scene, count: int) -> list[Level]:
    """Return meshes, coarsest first: each doubles the elements of the one before each way.

    The scene's own is the last but one. A graded mesh is refined at the edges too, or it would
    have another limit.
    """
    keys = [key for key in COUNTS if getattr(scene.mesh, key)]
    own = [getattr(scene.mesh, key) for key in keys]
    edge = scene.mesh.edge_size or EDGE_SIZE
    levels: dict[tuple[int, ...], Level] = {}
    for power in range(2 - count, 2):
        counts = tuple(max(1, round(n * 2.0**power)) for n in own)
        size = (prod(own) / prod(counts)) ** (1 / len(own))
        values = {f"mesh.{key}": n for key, n in zip(keys, counts, strict=True)}
        name = " x ".join(map(str, counts))
        levels.setdefault(counts, Level(name, size, values, edge * 2.0**-power))
    return list(levels.values())


def tolerance_levels(scene: Scene, count: int) -> list[Level]:
    """Return tolerances of a step, each a tenth of the one before; the scene's own is the second.

    It is the first where ten times as much would be no tolerance.
    """
    assert scene.time is not None
    own = scene.time.tolerance
    first = 1 if own * TENFOLD <= LOOSEST else 0
    levels = []
    for power in range(first, first - count, -1):
        tolerance = float(f"{own * TENFOLD**power:.6g}")
        size = tolerance / own
        levels.append(Level(f"{tolerance:g}", size, {"time.tolerance": tolerance}, 0.0))
    return levels


def both(meshes: Sequence[Level], tolerances: Sequence[Level]) -> list[Level]:
    """Return levels on which mesh and tolerance are refined together, the finest with the finest.

    Their sizes are those of the meshes.
    """
    pairs = list(zip(reversed(meshes), reversed(tolerances), strict=False))
    return [
        Level(f"{mesh.name}, {tolerance.name}", mesh.size, mesh.values | tolerance.values,
              mesh.edge_size)
        for mesh, tolerance in reversed(pairs)
    ]  # fmt: skip
