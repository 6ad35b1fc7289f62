"""One small run of Case 1 for all tests that only look at its files."""

import pytest

from tests.run.output import Output, run, shipped


@pytest.fixture(scope="session")
def case1(tmp_path_factory: pytest.TempPathFactory) -> Output:
    return run(tmp_path_factory.mktemp("case1"), shipped("case1", 60, 6))
