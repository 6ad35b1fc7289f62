"""Time and memory of Newton steps in 3D: presets side by side, and ranks against one rank.

    python -m tests.bench.scale presets [--set key=value ...]     direct against fieldsplit
    python -m tests.bench.scale ranks [--ranks 2] [--repeats 3]   parallel efficiency

Each figure is of a process of its own (peak memory is), one after the other, on joint3d.toml:
from the undeformed layer, pressed in, a few Newton steps are made and their times printed.
Ratios of one run mean something on a shared machine, times alone do not.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path
from statistics import median
from typing import Any

STEPS = 3
JOB = "jobs/joint3d.toml"
ROOT = Path(__file__).resolve().parents[2]


def measure(overrides: list[str]) -> None:
    """Make the steps in this process and print what they cost. Collective."""
    from mpi4py import MPI

    from porolub.mesh import build_mesh
    from porolub.scene import load_scene
    from porolub.solve.linear import Linear
    from porolub.solve.model import build_model, scales_of
    from porolub.solve.newton import Clock, Newton
    from porolub.solve.options import set_options
    from porolub.solve.startup import PRESSED_IN, Starter

    comm = MPI.COMM_WORLD
    set_options("")
    scene = load_scene(ROOT / JOB, overrides)
    scales = scales_of(scene, scene.geometry.thickness)
    model = build_model(scene, build_mesh(scene, comm, length_scale=scales.length), scales)
    clock = Clock()
    newton = Newton(model.system, clock, linear=Linear(model))
    x = Starter(model, newton).zero(PRESSED_IN)
    newton.solve(x, max_iterations=1)  # what is done once: analysis, patterns, tables
    before, linear = clock.spent["linear_solve"], newton.linear_iterations
    newton.solve(x, max_iterations=STEPS)
    spent = {"assembly": assembly(newton, x),
             "linear_solve": (clock.spent["linear_solve"] - before) / STEPS}
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    found = {**{k: comm.allreduce(v, MPI.MAX) for k, v in spent.items()},
             "memory": comm.allreduce(memory), "unknowns": model.dofs.size,
             "iterations": (newton.linear_iterations - linear) / STEPS}
    if comm.rank == 0:
        print(json.dumps(found))


def assembly(newton: Any, x: Any) -> float:
    """Seconds of a residual, a matrix and the estimate of the Schur complement; the median."""
    system, comm = newton.system, newton.dofs.mesh.comm
    times = []
    for _ in range(7):
        comm.Barrier()
        start = time.perf_counter()
        system.residual(x, newton.residual)
        system.jacobian(x, newton.matrix)
        newton.linear.linearise(x)
        comm.Barrier()
        times.append(time.perf_counter() - start)
    return median(times)


def child(ranks: int, overrides: list[str]) -> dict[str, Any]:
    """``measure`` in processes of its own."""
    command = [sys.executable, "-m", "tests.bench.scale", "measure",
               *(word for o in overrides for word in ("--set", o))]
    if ranks > 1:
        command = ["mpirun", "-n", str(ranks), *command]
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    done = subprocess.run(command, cwd=ROOT, env=environment, check=True, text=True,
                          stdout=subprocess.PIPE)
    result: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    print(ranks, overrides, result, flush=True)
    return result


def presets(overrides: list[str]) -> None:
    """Direct against the iterative presets."""
    rows = {name: child(1, [*overrides, f"solver.preset={name}"])
            for name in ("fieldsplit", "nested", "direct")}
    base = rows["direct"]
    print(f"{base['unknowns']:,} unknowns, a Newton step:")
    print(f"{'preset':12s}{'iterations':>12s}{'linear solve':>14s}{'whole step':>12s}"
          f"{'memory':>10s}{'time':>8s}{'memory':>8s}")
    for name, r in rows.items():
        whole = r["assembly"] + r["linear_solve"]
        print(f"{name:12s}{r['iterations']:12.0f}{r['linear_solve']:12.1f} s{whole:10.1f} s"
              f"{r['memory'] / 1e9:7.2f} GB"
              f"{whole / (base['assembly'] + base['linear_solve']):8.2f}"
              f"{r['memory'] / base['memory']:8.2f}")


def ranks(overrides: list[str], count: int, repeats: int) -> None:
    """One rank against several, by turns; medians."""
    runs: dict[int, list[dict[str, Any]]] = {1: [], count: []}
    for _ in range(repeats):
        for n, found in runs.items():
            found.append(child(n, overrides))
    for what in ("assembly", "linear_solve"):
        one, several = (median(r[what] for r in runs[n]) for n in (1, count))
        print(f"{what:14s}{one:8.2f} s on 1 rank, {several:8.2f} s on {count}: "
              f"efficiency {one / several / count:.2f}")


def main() -> None:
    """Read the command line and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["presets", "ranks", "measure"])
    parser.add_argument("--set", action="append", default=[], dest="overrides")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--repeats", type=int, default=3)
    chosen = parser.parse_args()
    if chosen.what == "measure":
        measure(chosen.overrides)
    elif chosen.what == "presets":
        presets(chosen.overrides)
    else:
        ranks(chosen.overrides, chosen.ranks, chosen.repeats)


if __name__ == "__main__":
    main()
