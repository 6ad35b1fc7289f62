"""One job at a time writes into the directory of a sweep.

The kernel holds the lock (flock on ``.lock``) and lets go of it when the process ends, however it
ends; the file itself means nothing and may be left over. ``.lock.owner`` beside it tells others
who has it.
"""

import os
import socket
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from filelock import FileLock, Timeout

from porolub.errors import SceneError
from porolub.io.atomic import reported, write_text
from porolub.io.directory import prepare_directory
from porolub.together import ALONE, on_root

LOCK = ".lock"
OWNER = ".lock.owner"
PATIENCE = 5.0  # s


class Lock:
    """Holds a directory while it is entered; rank 0 of ``comm`` does, for all. Collective.

    Entering makes the directory if need be; it waits for a job that is being killed, whose ranks go
    one after the other, and no longer: it raises SceneError where another process has it or where
    it cannot be written, SolveError where its disk is full; on all ranks.
    """

    def __init__(self, directory: Path, comm: Any = ALONE) -> None:
        self.directory = Path(directory)
        self._comm = comm
        self._lock: FileLock | None = None

    def __enter__(self) -> Self:
        on_root(self._comm, self._take)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Not collective: an error may be on one rank alone."""
        if self._lock is not None:
            with suppress(OSError):
                (self.directory / OWNER).unlink(missing_ok=True)
            self._lock.release()
            self._lock = None

    def _take(self) -> None:
        prepare_directory(self.directory)
        with reported(self.directory, "the files of a sweep"):
            lock = FileLock(self.directory / LOCK)
            try:
                lock.acquire(timeout=PATIENCE)
            except Timeout:
                raise SceneError(self._refusal()) from None
            try:
                write_text(self.directory / OWNER, _who())
            except OSError:
                lock.release()
                raise
        self._lock = lock

    def _refusal(self) -> str:
        """Say who has it, as far as that is known: the file comes a moment after the lock."""
        try:
            owner = (self.directory / OWNER).read_text(encoding="utf-8").strip()
        except (OSError, ValueError):
            owner = ""
        doing = f"has been writing here {owner}" if owner else "is writing here"
        return f"{self.directory}: another sweep {doing}; wait for it or choose another --out."


def _who() -> str:
    now = datetime.now().strftime("%Y-%m-%d %H:%M")
    return f"since {now} (process {os.getpid()} on {socket.gethostname()})\n"
