"""What is done on one rank or on each of them, and known on all."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from porolub.errors import PorolubError

Failure = PorolubError | OSError


class Alone:
    """A communicator of one rank, for programs that start no MPI: what is used of mpi4py's."""

    rank, size = 0, 1

    def bcast(self, value: Any, root: int = 0) -> Any:
        return value

    def gather(self, value: Any, root: int = 0) -> list[Any]:
        return [value]

    def allgather(self, value: Any) -> list[Any]:
        return [value]

    def allreduce(self, value: Any) -> Any:
        return value

    def scan(self, value: Any) -> Any:
        return value


ALONE = Alone()


def on_root(comm: Any, work: Callable[[], Any]) -> Any:
    """Do something on rank 0 and return it on all; its errors (PorolubError, OSError) are raised
    on all. Collective.

    Ranks that did not know would wait for the one that has left.
    """
    result: Any = None
    problem: Failure | None = None
    if comm.rank == 0:
        try:
            result = work()
        except (PorolubError, OSError) as error:
            problem = error
    result, problem = comm.bcast((result, problem), root=0)
    if problem is not None:
        raise problem
    return result


def on_each(comm: Any, work: Callable[[], Any]) -> Any:
    """Do something that is not collective on each rank and return what it gave there; the error
    (PorolubError, OSError) of the first rank that has one is raised on all. Collective."""
    result: Any = None
    problem: Failure | None = None
    try:
        result = work()
    except (PorolubError, OSError) as error:
        problem = error
    first = min(comm.allgather(comm.size if problem is None else comm.rank))
    if first < comm.size:
        raise comm.bcast(problem, root=first)
    return result
