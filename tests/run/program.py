"""`porolub` as a user starts it: a process of its own."""

import os
import subprocess
import sys
from pathlib import Path

from tests.run.output import JOBS

RUN = "from porolub.cli import main; main()"
"""The program as each rank of an mpirun starts it."""
PICTURELESS = """
import sys
from types import SimpleNamespace

sys.modules["porolub.io.plots"] = SimpleNamespace(plot_directory=lambda directory: [])
from porolub.cli import main

main()
"""
"""The same without figures: drawing takes longer than a small run, and all other ranks wait."""


def drawn_on_two(ranks: int) -> str:
    """The program for a test that repeats a run on several numbers of ranks: one draws figures."""
    return RUN if ranks == 2 else PICTURELESS


def porolub(
    *arguments: object, cwd: Path, timeout: float = 120.0
) -> "subprocess.CompletedProcess[str]":
    """Run the program in `cwd`.

    The environment is given in full: MPI in this process has put variables into the inherited one.
    """
    return subprocess.run(
        [sys.executable, "-m", "porolub", *map(str, arguments)],
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": str(JOBS.parent)},
        capture_output=True, text=True, timeout=timeout, check=False,
    )  # fmt: skip


def small(along: int = 24, across: int = 3) -> list[str]:
    """Overrides for a mesh that is solved in a moment."""
    return ["--set", f"mesh.along={along}", "--set", f"mesh.across={across}"]
