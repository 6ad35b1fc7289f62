"""SIGINT and SIGTERM as a request that all ranks see at the same point of the work.

Batch systems send SIGTERM some time before they kill.  The first signal asks the run to stop in
good order; a second one acts as it always does.
"""

from __future__ import annotations

import signal
from types import FrameType, TracebackType
from typing import Any, Self

from mpi4py import MPI

from porolub.errors import Interrupted

CAUGHT = (signal.SIGINT, signal.SIGTERM)


class Interrupt:
    """Catches the signals while it is entered."""

    def __init__(self) -> None:
        self._number = 0
        self._usual: dict[int, Any] = {}

    def __enter__(self) -> Self:
        self._usual = {number: signal.signal(number, self._note) for number in CAUGHT}
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 traceback: TracebackType | None) -> None:
        for number, handler in self._usual.items():
            signal.signal(number, handler)

    def _note(self, number: int, frame: FrameType | None) -> None:
        self._number = number
        for each, handler in self._usual.items():
            signal.signal(each, handler)

    def asked(self, comm: Any) -> str:
        """Which signal any rank of ``comm`` has got, in words; empty for none. Collective."""
        number = comm.allreduce(self._number, op=MPI.MAX)
        return f"Interrupted by {signal.Signals(number).name}" if number else ""

    def raise_if_asked(self, comm: Any) -> str:
        """Raise Interrupted on all ranks of ``comm`` once a signal has come; else "". Collective.

        For work that leaves nothing worth keeping.
        """
        if self.asked(comm):
            raise Interrupted(f"{self.asked(comm)} before there was a state to keep.")
        return ""
