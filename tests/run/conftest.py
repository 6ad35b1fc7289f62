"""One small run of Case 1 for all tests that only look at its files."""

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.run.output import Output


@pytest.fixture(scope="session")
def case1(tmp_path_factory: pytest.TempPathFactory) -> "Output":
    # Not before: pytest reads this file in the process that starts the workers, too. With MPI in
    # it, they would inherit its variables, and mpirun fails in such an environment.
    from tests.run.output import run, shipped

    return run(tmp_path_factory.mktemp("case1"), shipped("case1", 60, 6))
