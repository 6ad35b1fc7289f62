"""Assembly against the direct solver: residual + Jacobian over MUMPS refactor + solve.

    python tests/bench/assembly.py [SCENE ...] [--set key=value ...] [--repeats 9]

On 300 x 30 elements, serially, with one BLAS thread.  Each repeat does what a Newton iteration
does, in its order (so caches are as cold as there); medians are printed, the ratio is that of the
medians.  The Jacobian is added to the matrix while it is computed; what this insertion costs is
found by computing it once more with every entry dropped.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import time
from collections.abc import Callable
from dataclasses import replace
from statistics import median

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc
from rich.console import Console
from rich.table import Table

from porolub.mesh import build_mesh
from porolub.scene import load_scene
from porolub.solve.model import Model, build_model, scales_of
from porolub.solve.options import set_options

SCENES = ("jobs/case1.toml", "jobs/dry_contact.toml")
MESH = ("mesh.along=300", "mesh.across=30", "mesh.grading=none")
COLUMNS = ("residual", "Jacobian", "(insertion)", "refactor", "solve")


def model_of(path: str, overrides: list[str]) -> Model:
    scene = load_scene(path, [*MESH, *overrides])
    scales = scales_of(scene, scene.geometry.thickness)
    return build_model(scene, build_mesh(scene, MPI.COMM_WORLD, length_scale=scales.length), scales)


def without_insertion(model: Model, compute: Callable[[], None]) -> Callable[[], None]:
    """``compute`` with every matrix entry dropped."""
    system = model.system
    full = system._blocks
    dropped = {domain: {key: replace(block, slots=np.full_like(block.slots, -1))
                        for key, block in blocks.items()} for domain, blocks in full.items()}

    def run() -> None:
        system._blocks = dropped
        compute()
        system._blocks = full

    return run


def measure(model: Model, repeats: int) -> dict[str, float]:
    """Median times in ms."""
    system, x = model.system, model.dofs.vector()
    f, dx, matrix = x.duplicate(), x.duplicate(), system.create_matrix()
    system.apply_conditions(x)
    if "v0" in model.dofs.fields:
        model.dofs.set_scalar("v0", x, 0.05)  # pressed in by 5 % of the thickness
    solver = PETSc.KSP().create()
    solver.setFromOptions()

    def residual() -> None:
        system.residual(x, f)

    def jacobian() -> None:
        system.jacobian(x, matrix)

    def refactor() -> None:
        solver.setOperators(matrix)  # or PETSc would keep the old factors
        solver.setUp()

    steps = [("residual", residual), ("Jacobian", jacobian), ("refactor", refactor),
             ("solve", lambda: solver.solve(f, dx)), ("residual", residual),
             ("(insertion)", without_insertion(model, jacobian))]
    times: dict[str, list[float]] = {name: [] for name in COLUMNS}
    for _ in range(repeats + 1):
        for name, step in steps:
            start = time.perf_counter()
            step()
            times[name].append(1e3 * (time.perf_counter() - start))
    if solver.getConvergedReason() < 0:
        raise SystemExit("MUMPS failed: these times mean nothing")
    # the first repeat holds what is done once: symbolic analysis, tables, velocities
    result = {name: median(values[len(values) // (repeats + 1):]) for name, values in times.items()}
    result["(insertion)"] = max(0.0, result["Jacobian"] - result["(insertion)"])
    return result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--repeats", type=int, default=9)
    options = parser.parse_args()
    set_options("")
    table = Table(title="Assembly on 300 x 30 elements, ms")
    for name in ("scene", "unknowns", *COLUMNS, "ratio"):
        table.add_column(name, justify="left" if name == "scene" else "right")
    for path in options.scenes:
        model = model_of(path, options.set)
        t = measure(model, options.repeats)
        ratio = (t["residual"] + t["Jacobian"]) / (t["refactor"] + t["solve"])
        table.add_row(path, f"{model.dofs.size:,}", *(f"{t[name]:.1f}" for name in COLUMNS),
                      f"{ratio:.3f}")
    Console(width=110).print(table)


if __name__ == "__main__":
    main()
