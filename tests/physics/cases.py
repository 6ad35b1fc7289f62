"""The paper's transient cases on small meshes: history of a run, and what was seen at every step.

Times in s, all else in SI.
"""

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from porolub.scene import Scene, load_scene
from porolub.solve.derived import Derived
from porolub.solve.gather import gather_surface
from porolub.solve.report import StepRecord, SurfaceData
from porolub.solve.transient import TransientSolver
from porolub.solve.watch import Watch

Array = NDArray[np.float64]
JOBS = Path(__file__).resolve().parents[2] / "jobs"
PHASES = 400  # equal parts of a period

# mesh and number of periods
QUICK_ONE, QUICK_TWO = (60, 6, 1), (60, 6, 2)
LONG = pytest.param((100, 10, 5), marks=[pytest.mark.slow, pytest.mark.timeout(1800)],
                    id="five periods")


@dataclass
class Run:
    """A run that has ended.

    gaps and pressures: the least gap (m) and contact pressure (Pa) on the surface after each step;
    rejections: time, size, why; surface: the last state along it.
    """

    scene: Scene
    converged: bool = False
    message: str = ""
    overall: dict[str, float] = field(default_factory=dict)
    records: list[StepRecord] = field(default_factory=list)
    gaps: list[float] = field(default_factory=list)
    pressures: list[float] = field(default_factory=list)
    rejections: list[tuple[float, float, str]] = field(default_factory=list)
    surface: SurfaceData | None = None

    def __getitem__(self, key: str) -> Array:
        """A column of the history, (n,); the row of the start is the first."""
        if key == "time":
            return np.array([r.time for r in self.records])
        return np.array([r.values.get(key, np.nan) for r in self.records])

    @property
    def newton_per_step(self) -> float:
        """Iterations per accepted step, those of rejected ones included, without the start."""
        return float(self["newton_iterations"][1:].mean())

    @property
    def rejected_share(self) -> float:
        return len(self.rejections) / (len(self.records) - 1)

    def moved(self) -> float:
        """Mass (kg/m) that has gone through the surface, in and out, by the trapezoidal rule."""
        flows = [f"{way}_{side}" for way in ("inflow", "outflow") for side in ("left", "right")]
        return float(trapezoid(sum(self[key] for key in flows), self["time"]))

    def over_period(self, key: str, back: int = 0) -> Array:
        """(PHASES,) a column at equal phases of the last period, or of one before it."""
        period = self.scene.period
        assert period is not None
        times = self["time"]
        return np.interp(times[-1] - period * (1.0 + back - phases()), times, self[key])


def phases() -> Array:
    """(PHASES,) shares of a period."""
    return np.arange(PHASES) / PHASES


def lead(first: Array, second: Array) -> float:
    """Share of the period by which the first harmonic of one quantity is ahead of another's."""
    turn = np.exp(-2j * np.pi * phases())
    return float(np.angle(np.sum(first * turn) / np.sum(second * turn)) / (2.0 * np.pi))


def correlation(first: Array, second: Array) -> float:
    return float(np.corrcoef(first, second)[0, 1])


def scene(job: str, along: int, across: int, *overrides: str) -> Scene:
    """A shipped scene on a small uniform mesh, without pictures."""
    return load_scene(JOBS / f"{job}.toml", [
        f"mesh.along={along}", f"mesh.across={across}", "time.frames=0", *overrides])


def run(asked: Scene) -> Run:
    """From zero in one go."""
    done = Run(asked)

    def after(record: StepRecord) -> None:
        d, scales = Derived(solver.model, solver.stepper.x), solver.model.scales
        done.gaps.append(float(d.gap()[d.mine].min()) * scales.length)
        least = float(d.nodal("l")[d.mine, 0].min()) * scales.pressure  # nothing is cut off
        done.pressures.append(round(least, 6))  # what is left out is rounding

    watch = Watch(step=after, rejected=lambda *what: done.rejections.append(what))
    solver = TransientSolver(asked, MPI.COMM_SELF, watch)
    outcome = solver.solve()
    done.converged, done.message = outcome.converged, outcome.message
    done.overall, done.records = outcome.overall, solver.records
    done.surface = gather_surface(outcome.model, outcome.x)
    return done


@cache
def periods(job: str, along: int, across: int, count: int) -> Run:
    """So many periods of a shipped scene; each is 1 s long. Computed once for all tests."""
    done = run(scene(job, along, across, f"time.end={count} s"))
    assert done.converged, done.message
    return done
