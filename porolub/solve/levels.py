"""The meshes a scene is solved on, one after the other."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from porolub.solve.model import lubricated_name

COARSEST = {2: 80, 3: 40}  # elements along the surface on the first mesh, at most
FEWEST = 3  # elements across and deep on the first mesh
ALONE = {2: 3000, 3: 300}  # cells below which a mesh is left to one rank


@dataclass(frozen=True)
class Level:
    """A mesh of the sequence: element counts, and whether it is graded."""

    along: int
    across: int
    deep: int = 0  # 0: in 2D
    graded: bool = False

    @property
    def name(self) -> str:
        counts = [n for n in (self.along, self.across, self.deep) if n]
        return " x ".join(map(str, counts)) + (" graded" if self.graded else "")

    @property
    def cells(self) -> int:
        return self.along * self.across * max(self.deep, 1)

    def halved(self, fewest: int = 1) -> Level:
        """Half the elements each way, but ``fewest`` across and deep where there were as many."""
        across, deep = (min(n, max(fewest, -(-n // 2))) for n in (self.across, self.deep))
        return Level(-(-self.along // 2), across, deep, self.graded)


def levels_of(scene: Any) -> list[Level]:
    """Mesh sequence of a scene, coarsest first; one entry without coarser meshes."""
    mesh = scene.mesh
    last = Level(mesh.along, mesh.across, mesh.deep, mesh.grading == "contact")
    if scene.geometry.shape == "file" or lubricated_name(scene) is None:
        return [last]
    levels = [last]
    while levels[0].along > COARSEST[scene.dimension]:
        levels.insert(0, levels[0].halved(FEWEST))
    if last.graded:  # toward what?
        levels.insert(0, replace(levels[0], graded=False))
    return levels
