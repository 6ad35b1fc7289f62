"""The work queue over MPI: groups of ranks take cases from rank 0 as they become free.

A thread on rank 0 answers the other groups while the main thread computes cases of its own, so no
rank is kept from work.  Needs MPI_THREAD_MULTIPLE, which mpi4py asks for.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from types import TracebackType
from typing import Any, Self

from mpi4py import MPI

from porolub.errors import PorolubError, SceneError
from porolub.study.work.tasks import End, Row, Task, Wait, Work

ASK, TOLD = 1, 2  # tags
LISTENS_EVERY = 0.005  # s between two looks for messages
WAITS = 0.05  # s before a group without work asks again
REFRESHED = 0.5  # s between two pictures of the status


class Queue:
    """Rank 0 has the ``work``, the leaders of the other ``groups`` ask for it; use as a context.

    A leader goes on until ``tasks`` ends, also after ``stop``.  Made on all ranks of ``comm``.
    """

    def __init__(self, comm: Any, group: int, groups: int, work: Work | None = None) -> None:
        if groups > 1 and MPI.Query_thread() < MPI.THREAD_MULTIPLE:
            raise SceneError("this MPI has no MPI_THREAD_MULTIPLE: run the sweep without mpirun, "
                             "or in parts (--part).")
        self._comm, self.group, self.groups = comm.Dup(), group, groups
        self._work = work
        self._over = threading.Event()
        self._thread: threading.Thread | None = None

    def __enter__(self) -> Self:
        if self._work is not None:
            self._thread = threading.Thread(target=self._serve, daemon=True)
            self._thread.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 traceback: TracebackType | None) -> None:
        if self._work is not None and kind is not None:
            self._work.stop(PorolubError(f"ended by {kind.__name__} on rank 0"))
        self._over.set()
        if self._thread is not None:
            self._thread.join()
        if kind is None:
            self._comm.Free()

    def tasks(self) -> Iterator[Task]:
        """Cases for this group, on its leader, until there are none."""
        answer = self._ask("next", None)
        while not isinstance(answer, End):
            if isinstance(answer, Task):
                yield answer
            else:
                time.sleep(WAITS)
            answer = self._ask("next", None)

    def done(self, row: Row) -> None:
        """Hand in a row."""
        self._ask("done", row)

    def stop(self, problem: PorolubError) -> None:
        """End the whole work."""
        self._ask("stop", problem)

    def _ask(self, what: str, content: Any) -> Any:
        if self._work is not None:
            return _answer(self._work, what, content, self.group)
        self._comm.send((what, content, self.group), dest=0, tag=ASK)
        return self._comm.recv(source=0, tag=TOLD)

    def _serve(self) -> None:
        """Answer until the main thread is through and all other groups have been told the end."""
        assert self._work is not None
        waiting, status = self.groups - 1, MPI.Status()
        due = 0.0
        while waiting or not self._over.is_set():
            if time.monotonic() > due:
                self._work.refresh()
                due = time.monotonic() + REFRESHED
            if not waiting or not self._comm.Iprobe(tag=ASK, status=status):
                time.sleep(LISTENS_EVERY)
                continue
            rank = status.Get_source()
            answer = _answer(self._work, *self._comm.recv(source=rank, tag=ASK))
            self._comm.send(answer, dest=rank, tag=TOLD)
            waiting -= isinstance(answer, End)


def _answer(work: Work, what: str, content: Any, group: int) -> Task | Wait | End | None:
    if what == "next":
        return work.next(group)
    if what == "done":
        work.done(content, group)
    else:
        work.stop(content)
    return None
