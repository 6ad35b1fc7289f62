"""SIGINT and SIGTERM as a request that all ranks see at the same point of the work.

Batch systems send SIGTERM some time before they kill.  The first signal asks the run to stop in
good order; one that comes a while later acts as it always does.  Those in between are the same
request again: ``timeout`` signals its child and then the group, batch systems every process and
mpirun its ranks once more.
"""

from __future__ import annotations

import signal
import time
from types import FrameType, TracebackType
from typing import Any, Self

from mpi4py import MPI

from porolub.errors import Interrupted

CAUGHT = (signal.SIGINT, signal.SIGTERM)
SAME_REQUEST = 2.0  # s from the first signal


class Interrupt:
    """Catches the signals while it is entered."""

    def __init__(self) -> None:
        self._number, self._since = 0, 0.0
        self._usual: dict[int, Any] = {}

    def __enter__(self) -> Self:
        self._usual = {number: signal.signal(number, self._note) for number in CAUGHT}
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 traceback: TracebackType | None) -> None:
        for number, handler in self._usual.items():
            signal.signal(number, handler)

    def _note(self, number: int, frame: FrameType | None) -> None:
        if not self._number:
            self._number, self._since = number, time.monotonic()
        elif time.monotonic() > self._since + SAME_REQUEST:
            signal.signal(number, self._usual[number])
            signal.raise_signal(number)

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
