"""Code under mpirun, started from a test."""

import os
import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def _stop_session(process: "subprocess.Popen[str]") -> None:
    """End mpirun and, if it does not end its ranks, these too (they share its session)."""
    process.send_signal(signal.SIGTERM)
    try:
        process.wait(5)
    except subprocess.TimeoutExpired:
        process.kill()
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            if os.getsid(int(entry.name)) == process.pid:
                os.kill(int(entry.name), signal.SIGKILL)
        except ProcessLookupError:
            continue


def mpirun(
    directory: Path,
    ranks: int,
    what: str | Path,
    *args: object,
    timeout: float = 120.0,
    code: int = 0,
) -> str:
    """What `ranks` ranks printed that ran a script (a Path) or code (a string, dedented).

    They run in `directory`. The test fails with the end of the output when they take longer than
    `timeout` seconds or end with another exit code than `code`.
    """
    script = what if isinstance(what, Path) else directory / "ranks.py"
    if isinstance(what, str):
        script.write_text(textwrap.dedent(what))
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    command = ["mpirun", "-n", str(ranks), "--bind-to", "none", sys.executable]
    command = [*command, str(script), *map(str, args)]
    # env is given in full: MPI in this process has put variables of its own into the
    # environment behind Python's back, and mpirun fails when it inherits them
    process = subprocess.Popen(
        command,
        cwd=directory,
        env={**os.environ, "PYTHONPATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    )
    try:
        output, _ = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        _stop_session(process)
        output, _ = process.communicate()
        pytest.fail(f"{ranks} ranks took longer than {timeout} s:\n{output[-4000:]}")
    except BaseException:
        _stop_session(process)
        raise
    if process.returncode != code:
        pytest.fail(f"exit code {process.returncode} on {ranks} ranks:\n{output[-8000:]}")
    return output
