"""Mesh refinement of a scene: the table of results, differences and observed orders.

    python tests/bench/refinement.py jobs/case1.toml 150x15 300x30 600x60 [--set key=value ...]

Each mesh is solved from zero.  A mesh written 300x30g is graded toward the contact edges.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import itertools
import time

import numpy as np
from mpi4py import MPI
from rich.console import Console
from rich.table import Table

from porolub.scene import load_scene
from porolub.solve.derived import Derived, scalars
from porolub.solve.steady import SteadySolver

COLUMNS = {  # column: (value from the scalars, unit)
    "L_s": (lambda v: v["load_solid"], "N/m"),
    "L_f": (lambda v: v["load_fluid"], "N/m"),
    "v0": (lambda v: v["approach"] * 1e6, "um"),
    "b": (lambda v: v["contact_length"] * 1e3, "mm"),
    "M_in": (lambda v: (v["inflow_left"] + v["inflow_right"]) * 1e3, "g/(m s)"),
    "M_out": (lambda v: (v["outflow_left"] + v["outflow_right"]) * 1e3, "g/(m s)"),
    "mu": (lambda v: v["friction_coefficient"], ""),
    "TV(p)": (lambda v: v["variation"] / 1e3, "kPa"),
}


def total_variation(model, x) -> float:
    """Total variation of the pressure along the lubricated surface, Pa."""
    d = Derived(model, x)
    nodes = np.intersect1d(d.mine, model.dofs.nodes["p"])
    order = np.argsort(d.arc()[nodes])
    return float(np.abs(np.diff(d.nodal("p")[nodes, 0][order])).sum() * model.scales.pressure)


def solve(path: str, mesh: str, overrides: list[str]) -> tuple[dict[str, float], int, float]:
    along, across = mesh.rstrip("g").split("x")
    grading = "contact" if mesh.endswith("g") else "none"
    scene = load_scene(path, [*overrides, f"mesh.along={along}", f"mesh.across={across}",
                              f"mesh.grading={grading}"])
    start = time.perf_counter()
    outcome = SteadySolver(scene, MPI.COMM_WORLD).solve()
    if not outcome.converged:
        raise SystemExit(outcome.message)
    values = scalars(outcome.model, outcome.x)
    values["variation"] = total_variation(outcome.model, outcome.x)
    return values, outcome.newton_iterations, time.perf_counter() - start


def halves(meshes: list[str]) -> bool:
    """Whether each mesh halves the elements of the one before, so that orders mean something."""
    counts = [[int(n) for n in mesh.rstrip("g").split("x")] for mesh in meshes]
    graded = {mesh.endswith("g") for mesh in meshes}
    return len(graded) == 1 and all(
        b == 2 * a for one, two in itertools.pairwise(counts)
        for a, b in zip(one, two, strict=True))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    table = Table(title=f"Refinement of {options.scene}")
    table.add_column("mesh")
    for name, (_, unit) in COLUMNS.items():
        table.add_column(f"{name} {unit}".strip(), justify="right")
    table.add_column("Newton", justify="right")
    table.add_column("time s", justify="right")
    rows = []
    for mesh in options.meshes:
        values, newton, seconds = solve(options.scene, mesh, options.set)
        rows.append([f(values) for f, _ in COLUMNS.values()])
        table.add_row(mesh, *(f"{x:.5g}" for x in rows[-1]), str(newton), f"{seconds:.1f}")
    if len(rows) >= 2:
        last = np.array(rows[-1])
        for mesh, row in zip(options.meshes[:-1], rows[:-1], strict=True):
            change = [f"{100 * (a / b - 1):+.2f} %" for a, b in zip(row, last, strict=True)]
            table.add_row(f"{mesh} - last", *change, "", "")
    if len(rows) >= 3 and halves(options.meshes[-3:]):
        a, b, c = (np.array(r) for r in rows[-3:])
        orders = np.log2(np.abs((a - b) / np.where(b == c, np.nan, b - c)))
        table.add_row("order", *(f"{o:.1f}" for o in orders), "", "")
    Console(width=150).print(table)


if __name__ == "__main__":
    main()
