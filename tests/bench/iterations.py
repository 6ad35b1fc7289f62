"""Linear iterations of a Newton step with the fieldsplit preset, over refinement.

For Case 1 in 2D and a crowned joint in 3D, at Peclet numbers 0 to 500 (speed times thickness over
consolidation coefficient), with contact, film, carry and load balance on: the steady state is
found first; then the load is raised by 5 %, and Newton goes on to the steady state, or to the end
of one time step of the given size.  Printed: the mean number of linear iterations over that
Newton's steps, for three meshes, and the growth from the coarsest to the finest.

    python -m tests.bench.iterations [2] [3] [--preset NAME] [--bonded] [--small] [--petsc "..."]
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI
from rich.console import Console
from rich.table import Table

from porolub.scene import load_scene
from porolub.scene.derived import derived
from porolub.solve.linear import Linear
from porolub.solve.model import Model
from porolub.solve.newton import Clock, Newton
from porolub.solve.options import set_options
from porolub.solve.startup import STEP_LIMIT
from porolub.solve.steady import SteadySolver

JOBS = Path(__file__).resolve().parents[2] / "jobs"
MESHES = {2: ((75, 8, 0), (150, 15, 0), (300, 30, 0)), 3: ((20, 2, 5), (40, 4, 10), (80, 8, 20))}
JOB = {2: "case1", 3: "joint3d"}
PECLETS = (0.0, 50.0, 500.0)
STEPS = (1e-4, 1e-3, 1e-2, 1e-1, 1.0, np.inf)  # s


def counts(model: Model, start: Any, step: float) -> list[int]:
    """Linear iterations of each Newton step after a rise of the load, from a steady state."""
    system, operation = model.system, model.operation
    force = operation.force
    linear = Linear(model)
    newton = Newton(system, Clock(), linear=linear)
    newton.limits = dict(STEP_LIMIT)
    seen: list[int] = []
    newton.observe = lambda record: seen.append(newton.snes.getKSP().getIterationNumber())
    if np.isinf(step):
        system.steady()
    else:
        dofs = model.dofs
        system.backward_euler(system.physical(dofs.to_local(start)), step / model.scales.time)
    operation.force = 1.05 * force
    x = start.copy()
    result = newton.solve(x, tolerance=1e-7, max_iterations=25)
    x.destroy()
    newton.destroy()
    operation.force = force
    system.steady()
    return seen if result.converged else []


def row(dim: int, mesh: tuple[int, ...], peclet: float, preset: str, more: list[str]
        ) -> tuple[int, list[str]]:
    """Unknowns, and a cell of the table for each time step."""
    names = ("along", "across", "deep")[:dim]
    overrides = [f"mesh.{k}={n}" for k, n in zip(names, mesh, strict=False)] + more
    nominal = derived(load_scene(JOBS / f"{JOB[dim]}.toml", overrides)).peclet
    assert nominal is not None
    scene = load_scene(JOBS / f"{JOB[dim]}.toml",
                       [*overrides, f"motion.speed={peclet / nominal:.9g} rad/s",
                        f"solver.preset={preset}"])
    outcome = SteadySolver(scene, MPI.COMM_WORLD).solve()
    if not outcome.converged:
        return outcome.model.dofs.size, ["no steady state"] * len(STEPS)
    cells = []
    for step in STEPS:
        found = counts(outcome.model, outcome.x, step)
        cells.append(f"{np.mean(found):.0f}" if found else "failed")
    size = outcome.model.dofs.size
    outcome.x.destroy()
    outcome.model.destroy()
    return size, cells


def main(dims: list[int], preset: str, petsc: str, bonded: bool, small: bool) -> None:
    set_options(petsc)
    more = ["solid.base=bonded", "contact.friction_traction=true"] if bonded else []
    for dim in dims:
        table = Table("Peclet", "mesh", "unknowns", *(
            "steady" if np.isinf(s) else f"{s:g} s" for s in STEPS), "wall s",
            title=f"{JOB[dim]}{' bonded' if bonded else ''}, {preset}: linear iterations a step")
        for peclet in PECLETS:
            rows = []
            for mesh in MESHES[dim][: 2 if small else 3]:
                begin = time.perf_counter()
                size, cells = row(dim, mesh, peclet, preset, more)
                rows.append(cells)
                table.add_row(f"{peclet:g}", " x ".join(str(n) for n in mesh if n), f"{size:,}",
                              *cells, f"{time.perf_counter() - begin:.0f}")
                print((peclet, mesh, size, cells), flush=True)
            growth = [f"{int(b) / int(a) - 1:+.0%}" if a.isdigit() and b.isdigit() else "-"
                      for a, b in zip(rows[0], rows[-1], strict=True)]
            table.add_row("", "growth", "", *growth, end_section=True)
        Console(width=120).print(table)


if __name__ == "__main__":
    words = sys.argv[1:]

    def given(option: str, default: str) -> str:
        return words[words.index(option) + 1] if option in words else default

    main([int(w) for w in words if w in ("2", "3")] or [2, 3], given("--preset", "fieldsplit"),
         given("--petsc", ""), "--bonded" in words, "--small" in words)
