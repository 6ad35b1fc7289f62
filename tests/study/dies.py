"""`python dies.py WHERE COUNT [RANK] sweep FILE ...`: porolub that ends as by kill -9, or halts.

WHERE: in a case | in a line (of the journal) | in a state | in the table | halts (in a case: says
"halted" and waits to be killed); COUNT: the how-manieth time it gets there. On several ranks RANK
does it.
"""

import os
import signal
import sys
import time
from pathlib import Path
from typing import Any

from mpi4py import MPI

from porolub.cli import main
from porolub.io import hdf5
from porolub.solve.newton import Newton
from porolub.study import sweep
from porolub.study.work.journal import Journal

where, count = sys.argv.pop(1), int(sys.argv.pop(1))
MINE = MPI.COMM_WORLD.rank == (int(sys.argv.pop(1)) if sys.argv[1].isdigit() else 0)
jacobian, write, write_structure = Newton.jacobian, Journal._write, hdf5._write_structure


def has_come(*places: str) -> bool:
    """Count how often a place is reached."""
    global count
    count -= MINE and where in places
    return MINE and count == 0 and where in places


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def in_a_case(*arguments: Any) -> None:
    if has_come("in a case", "halts"):
        if where == "in a case":
            die()
        print("halted", flush=True)
        time.sleep(60)
    jacobian(*arguments)


def in_a_line(self: Journal, line: bytes) -> None:
    if has_come("in a line"):
        with self.path.open("ab") as file:
            file.write(line[:100])
        die()
    write(self, line)


def in_a_file(path: Path, *arguments: Any) -> dict[str, int]:
    """The structure is there, the rows are not."""
    places = write_structure(path, *arguments)
    if has_come("in the table" if "table.h5" in path.name else "in a state"):
        die()
    return places


if __name__ == "__main__":
    Newton.jacobian = in_a_case  # type: ignore[method-assign]
    Journal._write = in_a_line  # type: ignore[method-assign]
    hdf5._write_structure = in_a_file
    sweep.plot_sweep = lambda directory: []
    main()
