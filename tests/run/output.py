"""A run of `porolub run` and what it wrote, read back from the files alone."""

import csv
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from porolub.io.fields import read_fields
from porolub.io.summary import read_summary
from porolub.io.surface import read_surface
from porolub.run import run_scene
from porolub.scene import Scene, load_scene
from porolub.solve.report import FieldData, SurfaceData

JOBS = Path(__file__).resolve().parents[2] / "jobs"


@dataclass
class Output:
    """An output directory and the scene that was asked for."""

    directory: Path
    scene: Scene

    @cached_property
    def summary(self) -> dict[str, Any]:
        return read_summary(self.directory / "summary.json")

    @cached_property
    def surface(self) -> SurfaceData:
        return read_surface(self.directory / "surface.csv")

    @cached_property
    def fields(self) -> FieldData:
        return read_fields(self.directory)

    @cached_property
    def history(self) -> list[dict[str, float]]:
        """Rows of history.csv; an empty cell is left out."""
        with (self.directory / "history.csv").open(encoding="utf-8", newline="") as file:
            return [{k: float(v) for k, v in row.items() if v} for row in csv.DictReader(file)]

    def gap(self) -> np.ndarray:
        """Signed gap to the plane at all nodes, m; the plane lies below and is pressed up."""
        y = self.fields.nodes[:, 1] + self.fields.displacement[:, 1]
        return y - self.fields.nodes[:, 1].min() - self.summary["approach"]


def run(directory: Path, scene: Scene, petsc: str = "") -> Output:
    """Run a scene in this process, without a word."""
    assert run_scene(scene, directory, petsc, quiet=True) == 0
    return Output(directory, scene)


def shipped(job: str, along: int, across: int, *overrides: str) -> Scene:
    """A shipped scene on a small mesh."""
    counts = [f"mesh.along={along}", f"mesh.across={across}"]
    return load_scene(JOBS / f"{job}.toml", [*counts, *overrides])
