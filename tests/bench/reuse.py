"""What it saves to keep the old factors where Newton is near its end: with and without, in one go.

    python -m tests.bench.reuse jobs/case2.toml --set mesh.along=150 --set mesh.across=15

Ratios of one run mean something on a shared machine, times alone do not.
"""

from __future__ import annotations

import argparse

from mpi4py import MPI
from rich.console import Console
from rich.table import Table

from porolub.scene import load_scene
from porolub.solve.options import set_options
from porolub.solve.stepping import TimeStepper
from porolub.solve.transient import TransientSolver


class Timed(TransientSolver):
    """A run whose reuse of matrices can be forbidden."""

    reuse = True

    def _create_stepper(self) -> None:
        super()._create_stepper()
        stepper: TimeStepper = self.stepper
        stepper.newton.reuse = self.reuse


def main() -> None:
    """Run both and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("--set", action="append", default=[], dest="overrides")
    chosen = parser.parse_args()
    set_options("")
    table = Table(title=load_scene(chosen.scene, chosen.overrides).title, title_justify="left")
    for name in ("old factors", "steps", "Newton/step", "factorisations", "linear solve",
                 "per Newton iteration", "mass balance error"):
        table.add_column(name, justify="right", no_wrap=True)
    for reuse in (False, True):
        solver = Timed(load_scene(chosen.scene, [*chosen.overrides, "time.frames=0"]),
                       MPI.COMM_WORLD)
        solver.reuse = reuse
        outcome = solver.solve()
        newton = solver.stepper.newton
        seconds = solver.clock.spent["linear_solve"]
        table.add_row("kept" if reuse else "never", str(outcome.time_steps),
                      f"{newton.iterations / outcome.time_steps:.2f}",
                      str(newton.iterations - newton.reused), f"{seconds:.1f} s",
                      f"{1e3 * seconds / newton.iterations:.0f} ms",
                      f"{outcome.overall['mass_balance_error']:.1e}")
    Console(width=110).print(table)


if __name__ == "__main__":
    main()
