"""The composition root of ``porolub sweep``: cases -> groups of ranks -> journal, table, plots."""

from __future__ import annotations

import logging
import shutil
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from mpi4py import MPI

from porolub.errors import Interrupted, PorolubError, SceneError, SolveError
from porolub.interrupt import Interrupt
from porolub.io.atomic import replacing, reported
from porolub.io.log import close_logging, setup_logging
from porolub.solve.options import forget_options, set_options
from porolub.study.figures.sweep_plots import plot_sweep
from porolub.study.plan.cases import Case, cases_of
from porolub.study.plan.definition import Sweep
from porolub.study.plan.parts import part_of, read_part
from porolub.study.plan.sweep_file import write_resolved_sweep
from porolub.study.work.case_directories import arrange, with_results
from porolub.study.work.journal import JOURNAL, Journal, rows_of
from porolub.study.work.lock import Lock
from porolub.study.work.outcome import in_words, one_line
from porolub.study.work.progress import SweepProgress
from porolub.study.work.queue import Queue
from porolub.study.work.run_case import STATES, Cases, Trouble
from porolub.study.work.table import write_table
from porolub.study.work.tasks import Row, Work
from porolub.together import on_root

log = logging.getLogger(__name__)
RESOLVED = "sweep.resolved.toml"
SPARINGLY = 20.0  # the table is written anew after so many times what the last one took
LOOKS = 0.02  # s between two looks whether the other ranks are through


def run_sweep(sweep: Sweep, out_dir: Path, part: str = "", retry: bool = False,
              petsc_options: str = "", quiet: bool = False) -> int:
    """Compute the cases of a sweep that have no row yet; write table and plots. Collective.

    ``part``: "K/N", the K-th of N parts, into a directory of its own within ``out_dir``; ``retry``:
    compute failed cases again. Returns 0, or 3 if no case converged. Raises SceneError for what
    cannot be a sweep, Interrupted, and SolveError or Trouble where files cannot be written; all
    rows that are done are kept then, and the same call goes on.
    """
    comm, part_dir = MPI.COMM_WORLD, Path(out_dir)
    if part:
        part_dir /= "part-{}-of-{}".format(*read_part(part))
    groups = comm.size // sweep.ranks_per_case
    if groups == 0:
        raise SceneError(f"sweep.ranks_per_case = {sweep.ranks_per_case}: there are only "
                         f"{comm.size} ranks; run the sweep under mpirun -n "
                         f"{sweep.ranks_per_case} or more.")
    own = comm.rank // sweep.ranks_per_case
    group = comm.Split(own if own < groups else MPI.UNDEFINED)
    user_options = set_options(petsc_options)
    ledger = Ledger(sweep, part_dir, quiet)
    try:
        on_root(comm, lambda: ledger.find_cases(part))
        with Lock(part_dir, comm):
            setup_logging(None)
            on_root(comm, lambda: ledger.open(Path(out_dir), groups, retry))
            work = ledger.work() if comm.rank == 0 else None
            with Interrupt() as interrupt, Queue(comm, own, groups, work) as queue:
                if group != MPI.COMM_NULL:
                    cases = Cases(part_dir, group, sweep.keep == "results", user_options,
                                  interrupt)
                    _compute(queue, cases)
                _meet(comm)
            problem = work.problem if work is not None else None
            return int(on_root(comm, lambda: ledger.close(problem)))
    finally:
        ledger.progress.close()
        close_logging()
        forget_options()
        if group != MPI.COMM_NULL:
            group.Free()


def _compute(queue: Queue, cases: Cases) -> None:
    """Take cases until there are none; one that ends the sweep is told to rank 0. Collective on a
    group."""
    comm = cases.comm
    if comm.rank > 0:
        while (task := comm.bcast(None)) is not None:
            with suppress(PorolubError):  # rank 0 of the group tells
                cases.row(task)
        return
    for task in queue.tasks():
        comm.bcast(task)
        try:
            queue.done(cases.row(task))
        except PorolubError as problem:
            queue.stop(problem)
    comm.bcast(None)


def _meet(comm: Any) -> None:
    """Wait for all ranks without keeping a core from those that still work."""
    request = comm.Ibarrier()
    while not request.Test():
        time.sleep(LOOKS)


class Ledger:
    """What rank 0 knows of a sweep: its cases, their rows, and what is written of them."""

    def __init__(self, sweep: Sweep, directory: Path, quiet: bool) -> None:
        self.sweep, self.directory, self._quiet = sweep, directory, quiet
        self.cases: list[Case] = []
        self.numbers: dict[str, int] = {}  # of all cases by key, be they of another part
        self.rows: dict[str, Row] = {}
        self.journal = Journal(directory / JOURNAL)
        self.progress = SweepProgress(0, 1, quiet=True)
        self._due = 0.0

    def find_cases(self, part: str) -> None:
        """Raises SceneError for keys that no scene knows."""
        self.cases = cases_of(self.sweep)
        self.numbers = {case.key: case.index for case in self.cases}
        if part:
            self.cases = part_of(self.cases, *read_part(part))

    def open(self, whole: Path, groups: int, retry: bool) -> None:
        """Take up the rows there are, of all parts of the ``whole`` sweep, and begin to show."""
        known = rows_of(whole)
        with reported(self.directory, "the files of a sweep"):
            setup_logging(self.directory, resume=bool(known))
            with replacing(self.directory / RESOLVED) as (temporary,):
                write_resolved_sweep(temporary, self.sweep)
            (self.directory / STATES).mkdir(exist_ok=True)
        if retry:
            known = {key: row for key, row in known.items() if row["status"] == "converged"}
        if self.sweep.keep == "results":
            arrange(self.directory, self.cases)
            there = with_results(whole)
            known = {key: row for key, row in known.items()
                     if key in there or row["status"] != "converged"}
        for case in self.cases:
            if case.scene is None:
                self.rows[case.key] = _refused(case)
            elif case.key in known:
                self.rows[case.key] = _renumbered(known[case.key], case, self.numbers)
        units = {axis.name: axis.unit for axis in self.sweep.axes}
        self.progress = SweepProgress(len(self.cases), groups, len(self.rows), self._quiet,
                                      units=units)
        idle = MPI.COMM_WORLD.size - groups * self.sweep.ranks_per_case
        if idle:
            self.progress.note(f"{idle} of {MPI.COMM_WORLD.size} ranks have nothing to do: "
                               f"sweep.ranks_per_case = {self.sweep.ranks_per_case}")
        if self.rows:
            self.progress.note(f"{len(self.rows)} of {len(self.cases)} cases need no work")

    def work(self) -> Work:
        """What is left to do."""
        return Work(self.cases, self.rows, self._begun, self._note, self.progress.refresh)

    def _begun(self, case: Case, group: int) -> None:
        self.progress.started(self.progress.label(case.axes), group)

    def _note(self, row: Row, group: int) -> None:
        self.journal.append(dict(row))
        self.rows[row["key"]] = row
        self.progress.finished(row, group)
        start = time.perf_counter()
        if start >= self._due:
            self._write_table()
            done = time.perf_counter()
            self._due = done + SPARINGLY * (done - start)

    def _write_table(self) -> None:
        write_table(self.directory, self.sweep, self.rows.values())

    def close(self, problem: PorolubError | None) -> int:
        """Write the table and, at the end of the work, the plots; returns the exit code.

        Raises the problem that ended the work before its end.
        """
        self.progress.close()
        try:
            if problem is None or isinstance(problem, Interrupted):
                self._write_table()
            if problem is not None:
                raise problem
            rows = list(self.rows.values())
            self.progress.summary(rows, self.directory)
            converged = any(row["status"] == "converged" for row in rows)
            if converged:
                plot_sweep(self.directory)
        except (Interrupted, SolveError, Trouble) as error:
            if "the same command" in str(error):
                raise
            raise type(error)(f"{one_line(error)} {len(self.rows)} of {len(self.cases)} cases are "
                              "done; the same command goes on from there.") from error
        if not any(row["status"] == "failed" for row in rows):  # a retry would start from them
            shutil.rmtree(self.directory / STATES, ignore_errors=True)
        return 0 if converged or not rows else 3


def _renumbered(row: Row, case: Case, numbers: Mapping[str, int]) -> Row:
    """A row of before, with the numbers that cases have since points were added or taken away."""
    start = in_words([numbers.get(key) for key in row.get("starts", ())])
    return {**row, "case": case.index, "axes": case.axes, "start": start}


def _refused(case: Case) -> Row:
    """The row of a case that is no scene."""
    return {"key": case.key, "case": case.index, "status": "refused", "message": case.refusal,
            "axes": case.axes, "values": case.values, "sommerfeld_number": None, "regime": "",
            "start": "", "starts": [], "wall": 0.0, "summary": {}}
