"""Estimated errors beside true ones, for scenes that differ in what makes them hard.

    python -m tests.bench.estimates                    # steady ones, 75 x 8 to 300 x 30
    python -m tests.bench.estimates --only transient

The truth is the same scene on a graded mesh of 600 x 60 elements (in time: 300 x 30, at a tenth of
the tolerance).  A scene holds where every estimate of COMPARED bounds the error or is within a
factor of 3 of it.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from mpi4py import MPI
from rich.console import Console
from rich.table import Table

from porolub.scene import Scene, load_scene
from porolub.solve.derived import scalars
from porolub.solve.options import set_options
from porolub.solve.steady import SteadySolver
from porolub.solve.transient import TransientSolver

JOBS = Path(__file__).resolve().parents[2] / "jobs"
COMPARED = ("friction_coefficient", "load_solid", "load_fluid", "load_ratio", "approach",
            "contact_length", "pressure_max")
WITHIN = 3.0
EXACT = 1e-9  # relative error below which a number is not judged: it is given, or rounding

STEADY: dict[str, tuple[str, list[str]]] = {
    "Case 1": ("case1", []),
    "0.05 rad/s": ("case1", ["motion.speed=0.05 rad/s"]),
    "-2 rad/s": ("case1", ["motion.speed=-2 rad/s"]),
    "3 kN/m": ("case1", ["load.force=3 kN/m"]),
    "300 N/m": ("case1", ["load.force=300 N/m"]),
    "film of 4 um": ("case1", ["load={approach='-4 um'}"]),
    "60 um deep": ("case1", ["load={approach='60 um'}"]),
    "20 um^3/mm": ("case1", ["pores.permeability=20 um^3/mm"]),
    "0.1 um^3/mm": ("case1", ["pores.permeability=0.1 um^3/mm"]),
    "bonded": ("case1_bonded", []),
    "bonded, 500 N/m": ("case1_bonded", ["load.force=500 N/m", "motion.speed=0.3 rad/s"]),
    "Appendix A": ("appendix_a", []),
    "20 mPa s": ("case1_bonded", ["film.viscosity=20 mPa*s"]),
    "dry": ("dry_contact", []),
    "soft": ("case1", ["solid.shear_modulus=0.3 MPa", "solid.bulk_modulus=2 MPa"]),
    "2 mm thick": ("case1", ["geometry.thickness=2 mm"]),
}
TRANSIENT: dict[str, tuple[str, list[str]]] = {
    "Case 2": ("case2", []),
    "Case 3": ("case3", []),
    "Case 4": ("case4", []),
    "Case 2, bonded": ("case2", ["solid.base=bonded"]),
}
MESHES = {"uniform": "none", "graded": "contact"}
LENGTH = "0.6 s"  # of the runs in time


@dataclass(frozen=True)
class Compared:
    """Numbers of a run and the absolute errors estimated for them, SI."""

    numbers: Mapping[str, float | None]
    errors: Mapping[str, float]

    def beside(self, truth: Mapping[str, float | None]) -> Iterator[tuple[str, float, float]]:
        """Name, relative error estimated and true one, of each of COMPARED that has both."""
        for name in COMPARED:
            value, exact = self.numbers.get(name), truth.get(name)
            if value is None or not exact:
                continue
            true = abs(value - exact) / abs(exact)
            if true > EXACT:
                yield name, self.errors.get(name, 0.0) / abs(exact), true


def run(scene: Scene) -> Compared:
    """Solve a scene. Raises RuntimeError where it fails."""
    if scene.time is not None:
        solver = TransientSolver(scene, MPI.COMM_WORLD)
        outcome = solver.solve()
        numbers, errors = dict(solver.records[-1].values), dict(outcome.errors)
        converged, message = outcome.converged, outcome.message
        solver.destroy()
    else:
        state = SteadySolver(scene, MPI.COMM_WORLD).solve()
        numbers, errors = scalars(state.model, state.x), dict(state.errors)
        converged, message = state.converged, state.message
        state.destroy()
    if not converged:
        raise RuntimeError(message)
    return Compared(numbers, errors)


def on_mesh(job: str, changes: list[str], along: int, grading: str, *more: str) -> Scene:
    """A shipped scene, changed, on a mesh ten times longer than deep."""
    return load_scene(JOBS / f"{job}.toml", [
        *changes, f"mesh.along={along}", f"mesh.across={-(-along // 10)}",
        f"mesh.grading={grading}", *more])


def truth_of(job: str, changes: list[str], in_time: bool) -> Compared:
    """The scene on a mesh, and with steps, that leave next to no error."""
    if in_time:
        return run(on_mesh(job, changes, 300, "contact", f"time.end={LENGTH}", "time.frames=0",
                           "time.tolerance=1e-4"))
    more = ["mesh.edge_size=5 um"]
    return run(on_mesh(job, changes, 600, "contact", *more))


def holds(found: Compared, truth: Compared) -> bool:
    """Whether all estimates bound their errors or come near them."""
    return all(WITHIN * guess >= true for _, guess, true in found.beside(truth.numbers))


def main() -> None:
    """Print a row for each scene and mesh, and how many hold."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", choices=["steady", "transient"], default="steady")
    parser.add_argument("--along", default="75,150,300")
    parser.add_argument("--scenes", default="", help="names, separated by semicolons")
    chosen = parser.parse_args()
    set_options("")
    in_time = chosen.only == "transient"
    more = [f"time.end={LENGTH}", "time.frames=0"] if in_time else []
    table = Table(title="estimated error / true error, in %", title_justify="left")
    for name in ("scene", "mesh", "friction", "L_s", "approach", "contact", "least ratio", "holds"):
        table.add_column(name, no_wrap=True, justify="left" if name == "scene" else "right")
    count = held = 0
    for name, (job, changes) in (TRANSIENT if in_time else STEADY).items():
        if chosen.scenes and name not in chosen.scenes.split(";"):
            continue
        truth = truth_of(job, changes, in_time)
        for kind, grading in MESHES.items():
            for along in map(int, chosen.along.split(",")):
                found = run(on_mesh(job, changes, along, grading, *more))
                rows = {key: (guess, true) for key, guess, true in found.beside(truth.numbers)}
                cells = [f"{100 * rows[key][0]:.2g} / {100 * rows[key][1]:.2g}" if key in rows
                         else "" for key in ("friction_coefficient", "load_solid", "approach",
                                             "contact_length")]
                ratio, worst = min(((guess / true, key) for key, (guess, true) in rows.items()),
                                   default=(1.0, ""))
                good = holds(found, truth)
                count, held = count + 1, held + good
                table.add_row(name, f"{kind} {along}", *cells, f"{ratio:.2g} {worst}",
                              "yes" if good else "NO")
                print(name, kind, along, *cells, f"{ratio:.2g} {worst}", good, flush=True)
    Console(width=150).print(table)
    print(f"{held} of {count} hold")


if __name__ == "__main__":
    main()
