"""Run by mpirun: made-up cases of random length through the queue. Argument: what is to happen.

What a rank has done is in rank-N.json of the directory it was started in.
"""

import json
import random
import sys
import time
from pathlib import Path

from mpi4py import MPI

from porolub.errors import PorolubError, SolveError
from porolub.study.work.queue import Queue
from porolub.study.work.tasks import Work
from tests.study.grids import grid

COMM = MPI.COMM_WORLD
RANKS_PER_CASE = 2 if "pairs" in sys.argv else 1
GROUPS = COMM.size // RANKS_PER_CASE
GROUP = COMM.rank // RANKS_PER_CASE
CASES = grid([float(k) for k in range(8)], [float(k) for k in range(5)])
LENGTH = 0.05  # s, of the longest case
LONG = 0.4  # s, of a case under way while something happens elsewhere
FAILED = 7


def main(what: str) -> None:
    begun: list[tuple[int, int]] = []
    noted: list[tuple[int, int]] = []

    def note(row: dict[str, int], group: int) -> None:
        if what == "disk full" and len(noted) == 5:
            raise SolveError("journal.jsonl: No space left on device")
        if what == "defect" and len(noted) == 5:
            raise ZeroDivisionError("division by zero")
        noted.append((row["case"], group))

    work = None
    if COMM.rank == 0:
        work = Work(CASES, {}, lambda case, group: begun.append((case.index, group)), note)
    mine: list[int] = []
    ended = ""
    try:
        with Queue(COMM, GROUP, GROUPS, work) as queue:
            if GROUP < GROUPS and COMM.rank % RANKS_PER_CASE == 0:
                compute(queue, what, mine)
    except ZeroDivisionError as error:
        ended = str(error)
    problem = str(work.problem) if work and work.problem else ""
    said = {"rank": COMM.rank, "mine": mine, "begun": begun, "noted": noted, "problem": problem,
            "ended": ended}  # fmt: skip
    Path(f"rank-{COMM.rank}.json").write_text(json.dumps(said))


def compute(queue: Queue, what: str, mine: list[int]) -> None:
    length = random.Random(COMM.rank)
    for task in queue.tasks():
        time.sleep(length.random() * LENGTH)
        if len(mine) >= 3:
            if what == f"stop from {GROUP}":
                queue.stop(PorolubError(f"asked by group {GROUP}"))
                continue
            if what.startswith("stop"):
                time.sleep(LONG)
            if what == "exception" and COMM.rank == 0:
                raise ZeroDivisionError("on rank 0")
        mine.append(task.case.index)
        status = "failed" if task.case.index == FAILED else "converged"
        queue.done({"case": task.case.index, "key": task.case.key, "status": status,
                    "ballast": "x" * 100_000})  # fmt: skip


main(sys.argv[1])
