"""What all tests share: one BLAS thread, as many workers as cores, code under mpirun."""

import os
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest
from hypothesis import settings

from tests.mpirun import mpirun

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
# fonts as this environment has them: the home's list may be that of one which has gone since
os.environ.setdefault("MPLCONFIGDIR", str(Path(sys.prefix, "var", "matplotlib")))
if os.geteuid() == 0:
    os.environ["OMPI_ALLOW_RUN_AS_ROOT"] = os.environ["OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"

MOST_WORKERS = 4  # each takes up to 1.5 GB and starts up to six ranks
RunMPI = Callable[..., str]


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """`-n auto`: a worker for each core this process may use."""
    return min(len(os.sched_getaffinity(0)), MOST_WORKERS)


def pytest_sessionstart(session: pytest.Session) -> None:
    """List the fonts once, before workers do it side by side."""
    if not hasattr(session.config, "workerinput"):
        import matplotlib.font_manager  # noqa: F401


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes() -> None:
    """Workers inherit this process's environment, and mpirun fails in one that MPI has changed."""
    if {"mpi4py.MPI", "petsc4py.PETSc"} & sys.modules.keys():
        raise pytest.UsageError("a conftest.py imports MPI; let it do so in its fixtures")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files that start ranks come first: they take longest, and at the end workers would wait."""
    starting = {item.path for item in items if item.get_closest_marker("mpi")}
    items.sort(key=lambda item: item.path not in starting)


@pytest.fixture
def run_mpi(tmp_path: Path) -> RunMPI:
    """`run_mpi(n, script_or_code, *args, timeout=120, code=0)`: `mpirun` in `tmp_path`."""
    return partial(mpirun, tmp_path)


@pytest.fixture(autouse=True)
def _options_of_one_test_are_not_those_of_the_next() -> Iterator[None]:
    """PETSc has one table of options a process; a test leaves it empty."""
    yield
    from porolub.solve.options import forget_options

    forget_options()
