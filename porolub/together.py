"""Work that rank 0 does for all, such as writing files: what goes wrong is raised on all ranks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from porolub.errors import PorolubError


def on_root(comm: Any, work: Callable[[], Any]) -> Any:
    """Do something on rank 0 and return it on all; its PorolubErrors are raised on all. Collective.

    Ranks that did not know would wait for the one that has left.
    """
    result: Any = None
    problem: PorolubError | None = None
    if comm.rank == 0:
        try:
            result = work()
        except PorolubError as error:
            problem = error
    result, problem = comm.bcast((result, problem), root=0)
    if problem is not None:
        raise problem
    return result
