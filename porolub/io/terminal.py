"""Whether someone watches what is printed, or it goes to a file."""

import os
from pathlib import Path

from rich.console import Console


def new_console() -> Console:
    """Return a console that styles and redraws only what reaches a terminal."""
    console = Console()
    return Console(force_terminal=False) if console.is_terminal and not _watched() else console


def _watched() -> bool:
    """Whether the pseudo-terminal that mpirun may have put under stdout leads to a real one.

    Open MPI gives its ranks one wherever its own output goes, such as to the log of a batch system.
    """
    if "OMPI_COMM_WORLD_RANK" not in os.environ:
        return True
    try:
        output_of_mpirun = Path(f"/proc/{os.getppid()}/fd/1").readlink()
    except OSError:
        return False
    return str(output_of_mpirun).startswith(("/dev/pts/", "/dev/tty"))
