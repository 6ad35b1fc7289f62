"""Error of friction and solid load over time against the tolerance asked for, with wall time.

    python -m tests.bench.tolerance jobs/case3.toml --set mesh.along=60 --set mesh.across=6

Each run is compared with one of order 2 at a tenth of the smallest tolerance, at its own steps.
Errors are relative to the largest value; wall time is that of the steps, the start left out.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from scipy.integrate import trapezoid
from scipy.interpolate import PchipInterpolator

from porolub.scene import load_scene
from porolub.solve.options import set_options
from porolub.solve.transient import TransientSolver
from porolub.solve.watch import Watch

Array = NDArray[np.float64]
COMPARED = ("friction_coefficient", "load_solid")


@dataclass
class Run:
    """One run: times (n,), the compared quantities (n,) by name, and what it cost."""

    times: Array
    values: dict[str, Array]
    steps: int
    rejected: int
    newton: float
    factorisations: int
    seconds: float


def run(scene: Any) -> Run:
    """Run a scene. Raises RuntimeError if it fails."""
    began: list[float] = []
    watch = Watch(begin=lambda start, end: began.append(time.perf_counter()))
    solver = TransientSolver(scene, MPI.COMM_WORLD, watch)
    outcome = solver.solve()
    seconds = time.perf_counter() - began[0]
    if not outcome.converged:
        raise RuntimeError(outcome.message)
    rows = solver.records
    times = np.array([r.time for r in rows])
    values = {k: np.array([r.values[k] for r in rows]) for k in COMPARED}
    iterations = sum(r.values["newton_iterations"] for r in rows[1:])
    newton = solver.stepper.newton
    return Run(times, values, outcome.time_steps, outcome.rejected_steps,
               iterations / outcome.time_steps, newton.iterations - newton.reused, seconds)


def errors(found: Run, exact: Run, name: str) -> tuple[float, float]:
    """Largest and root mean square error relative to the largest value."""
    reference = PchipInterpolator(exact.times, exact.values[name])
    off = np.abs(found.values[name] - reference(found.times)) / np.abs(exact.values[name]).max()
    mean_square = trapezoid(off**2, found.times)
    return float(off.max()), float(np.sqrt(mean_square / np.ptp(found.times)))


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("--tolerances", default="1e-2,1e-3,1e-4,1e-5")
    parser.add_argument("--orders", default="1,2,3")
    parser.add_argument("--set", action="append", default=[], dest="overrides")
    chosen = parser.parse_args()
    tolerances = sorted(map(float, chosen.tolerances.split(",")), reverse=True)
    set_options("")

    def scene(tolerance: float, order: int) -> Any:
        return load_scene(chosen.scene, [*chosen.overrides, "time.frames=0",
                                         f"time.tolerance={tolerance!r}", f"time.order={order}"])

    exact = run(scene(tolerances[-1] / 10, 2))
    table = Table(title=load_scene(chosen.scene, chosen.overrides).title, title_justify="left")
    for name in ("order", "tolerance", "steps", "rejected", "Newton/step", "factorisations",
                 "time", "mu, largest", "mu, rms", "L_s, largest"):
        table.add_column(name, justify="right", no_wrap=True)
    for order in map(int, chosen.orders.split(",")):
        for tolerance in tolerances:
            found = run(scene(tolerance, order))
            mu, solid = (errors(found, exact, name) for name in COMPARED)
            table.add_row(str(order), f"{tolerance:.0e}", str(found.steps), str(found.rejected),
                          f"{found.newton:.2f}", str(found.factorisations),
                          f"{found.seconds:.1f} s", f"{mu[0]:.1e}", f"{mu[1]:.1e}",
                          f"{solid[0]:.1e}")
    Console(width=120).print(table)
    print(f"reference: order 2, tolerance {tolerances[-1] / 10:.0e}, {exact.steps} steps, "
          f"{exact.seconds:.1f} s")


if __name__ == "__main__":
    main()
