"""What ranks and starts from neighbours save in a sweep: `python -m tests.bench.sweeps`.

Runs one sweep (by default the 10 x 10 Stribeck map) from neighbours on one rank and on two, and
from zero on two.  Prints wall time, processor time and Newton iterations, and whether the tables
of one and two ranks are the same.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from porolub.study.work.table import comparable, read_table

PROGRAM = Path(sys.executable).with_name("porolub")


@dataclass(frozen=True)
class Run:
    """wall and processor time (s) of a sweep, its Newton iterations and failures, its columns."""

    wall: float
    processor: float
    newton: int
    failed: int
    columns: dict[str, np.ndarray]


def run(sweep: Path, ranks: int, *changes: str) -> Run:
    """The sweep in a directory of its own."""
    launch = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    options = [word for change in changes for word in ("--set", change)]
    with tempfile.TemporaryDirectory() as directory:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.perf_counter()
        subprocess.run([*launch, PROGRAM, "sweep", sweep, "--out", directory, "--quiet", *options],
                       check=True, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"})
        wall = time.perf_counter() - start
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        table = read_table(Path(directory))
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    newton, status = table.columns["newton_iterations"], table.columns["status"]
    return Run(wall, used, int(np.nansum(newton)), int((status != "converged").sum()),
               comparable(table))


def same(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> bool:
    """Whether two tables hold the same, digit for digit."""
    return one.keys() == other.keys() and all(
        np.array_equal(one[k], other[k], equal_nan=one[k].dtype != object) for k in one)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sweep", nargs="?", type=Path, default=Path("jobs/stribeck_map.toml"))
    parser.add_argument("--starts-only", action="store_true", help="leave out the run on one rank")
    given = parser.parse_args()
    runs = {} if given.starts_only else {"1 rank": run(given.sweep, 1)}
    runs["2 ranks"] = run(given.sweep, 2)
    runs["2 ranks, from zero"] = run(given.sweep, 2, "sweep.start=zero")
    table = Table("", "wall [s]", "processor [s]", "Newton", "failed", title=str(given.sweep))
    for name, r in runs.items():
        table.add_row(name, f"{r.wall:.1f}", f"{r.processor:.1f}", f"{r.newton:,}", str(r.failed))
    console = Console()
    console.print(table)
    two, zero = runs["2 ranks"], runs["2 ranks, from zero"]
    console.print(f"Newton iterations saved by neighbours: {1 - two.newton / zero.newton:.0%}, "
                  f"processor time {1 - two.processor / zero.processor:.0%}")
    if not given.starts_only:
        one = runs["1 rank"]
        console.print(f"2 ranks over 1: wall {two.wall / one.wall:.2f}, tables "
                      f"{'the same' if same(one.columns, two.columns) else 'DIFFER'}")


if __name__ == "__main__":
    main()
