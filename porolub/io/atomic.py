"""Files that are either the old ones or the new ones, never half of either."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from porolub.errors import SolveError
from porolub.together import ALONE, on_root


@contextmanager
def replacing(*targets: Path, comm: Any = ALONE) -> Iterator[tuple[Path, ...]]:
    """Yield a temporary path for each target; when the block ends well they take their places.

    All targets lie in one directory. If the block raises, the targets are as they were. Of
    several targets the later ones refer to the first (an index to its data): they are taken away
    before it is replaced, so that no interruption leaves old and new together. The ranks of
    ``comm`` write the same files together; the block ends alike on all of them.
    """
    temporary = tuple(target.with_name(f".{target.name}.tmp") for target in targets)

    def put_in_place() -> None:
        for path in temporary:
            to_disk(path)
        for target in targets[1:]:
            target.unlink(missing_ok=True)
        for path, target in zip(temporary, targets, strict=True):
            path.replace(target)
        to_disk(targets[0].parent)

    try:
        yield temporary
        on_root(comm, put_in_place)
    finally:
        if comm.rank == 0:
            for path in temporary:
                path.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a UTF-8 text file in one go."""
    with replacing(path) as (temporary,):
        temporary.write_text(text, encoding="utf-8", newline="\n")


@contextmanager
def reported(path: Path, what: str = "this file") -> Iterator[None]:
    """Turn an OSError into a SolveError: the scene is not to blame for a full disk."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or error
        raise SolveError(f"{path}: {what} cannot be written ({reason}).") from error


def to_disk(path: Path) -> None:
    """Make what was written (for a directory: its entries) survive a loss of power."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
