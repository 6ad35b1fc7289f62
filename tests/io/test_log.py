"""log.txt takes what the package logs, one run at a time."""

import logging
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from porolub.errors import SceneError
from porolub.io.log import close_logging, setup_logging

LOGGER = logging.getLogger("porolub.test")


@pytest.fixture(autouse=True)
def _close() -> Iterator[None]:
    yield
    close_logging()


def test_messages_are_in_the_file_at_once_with_their_time(tmp_path: Path) -> None:
    setup_logging(tmp_path / "new" / "out")
    LOGGER.info("mesh of %d cells", 9000)
    LOGGER.debug("too fine")
    (line,) = (tmp_path / "new" / "out" / "log.txt").read_text().splitlines()
    assert re.fullmatch(
        r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d,\d{3} INFO    porolub\.test: mesh of 9000 cells", line
    )


def test_the_next_run_logs_to_its_own_file_only(tmp_path: Path) -> None:
    setup_logging(tmp_path / "a")
    setup_logging(tmp_path / "b")
    LOGGER.info("second")
    assert (tmp_path / "a" / "log.txt").read_text() == ""
    assert (tmp_path / "b" / "log.txt").read_text().count("second") == 1


def test_without_a_directory_nothing_is_logged(capfd: pytest.CaptureFixture[str]) -> None:
    setup_logging(None)
    LOGGER.error("not seen")
    assert not LOGGER.isEnabledFor(logging.CRITICAL)
    assert capfd.readouterr() == ("", "")


def test_closing_leaves_logging_as_it_was(tmp_path: Path) -> None:
    root = logging.getLogger("porolub")
    before = (root.level, list(root.handlers))
    setup_logging(tmp_path)
    close_logging()
    assert (root.level, root.handlers) == before


def test_a_log_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    (tmp_path / "log.txt").mkdir()
    with pytest.raises(SceneError, match=r"log\.txt: the log cannot be written \(Is a dir"):
        setup_logging(tmp_path)
