"""What all tests share: one BLAS thread, and `run_mpi` to run code under mpirun."""

import os
import signal
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import settings

# a loaded machine is no failure; a commit is judged on the same examples each time
settings.register_profile("porolub", deadline=None, derandomize=bool(os.environ.get("CI")))
settings.load_profile("porolub")

for variable in (
    "OPENBLAS_NUM_THREADS",
    "OMP_NUM_THREADS",
    "OMPI_MCA_rmaps_base_oversubscribe",
    "OMPI_MCA_mpi_yield_when_idle",  # ranks that wait leave the core to those that work
):
    os.environ[variable] = "1"  # before NumPy is imported
os.environ.setdefault("MPLBACKEND", "Agg")
if os.geteuid() == 0:
    os.environ["OMPI_ALLOW_RUN_AS_ROOT"] = os.environ["OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"

ROOT = Path(__file__).resolve().parent.parent
RunMPI = Callable[..., str]


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


@pytest.fixture
def run_mpi(tmp_path: Path) -> RunMPI:
    """`run_mpi(n, script_or_code, *args, timeout=120, code=0)` -> what the ranks printed.

    Runs a script (a Path) or code (a string, dedented) on n ranks in `tmp_path` and fails with
    the end of the output when it takes longer than `timeout` seconds or ends with another exit
    code than `code`.
    """

    def run(
        ranks: int, what: str | Path, *args: object, timeout: float = 120.0, code: int = 0
    ) -> str:
        script = what if isinstance(what, Path) else tmp_path / "ranks.py"
        if isinstance(what, str):
            script.write_text(textwrap.dedent(what))
        path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
        command = ["mpirun", "-n", str(ranks), "--bind-to", "none", sys.executable]
        command = [*command, str(script), *map(str, args)]
        # env is given in full: MPI in this process has put variables of its own into the
        # environment behind Python's back, and mpirun fails when it inherits them
        process = subprocess.Popen(
            command,
            cwd=tmp_path,
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

    return run


@pytest.fixture(autouse=True)
def _options_of_one_test_are_not_those_of_the_next() -> Iterator[None]:
    """PETSc has one table of options a process; a test leaves it empty."""
    yield
    from porolub.solve.options import forget_options

    forget_options()
