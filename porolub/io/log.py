"""log.txt: what happened in a run, through Python's logging (loggers below ``porolub``)."""

import logging
import sys
from contextlib import suppress
from pathlib import Path

from porolub.errors import SceneError
from porolub.io.directory import prepare_directory

FORMAT = "%(asctime)s %(levelname)-7s %(name)s: %(message)s"
ROOT = "porolub"
_installed: list[logging.Handler] = []


class _LogFile(logging.FileHandler):
    """A log that ends where the disk is full; the files that matter say so in a sentence."""

    def handleError(self, record: logging.LogRecord) -> None:
        if not isinstance(sys.exception(), OSError):
            super().handleError(record)

    def close(self) -> None:
        with suppress(OSError):  # of what could not be written before
            super().close()


def setup_logging(directory: Path | None, level: int = logging.INFO, *,
                  resume: bool = False) -> None:
    """Send the log to log.txt in ``directory``, which is made if need be; end any earlier log.

    ``resume``: go on in an earlier log. With None, as on all ranks but the first, nothing is
    logged. Raises SceneError if the directory or the file cannot be written.
    """
    close_logging()
    handler: logging.Handler = logging.NullHandler()
    if directory is not None:
        prepare_directory(directory)
        path = directory / "log.txt"
        try:
            handler = _LogFile(path, mode="a" if resume else "w", encoding="utf-8")
        except OSError as error:
            raise SceneError(f"{path}: the log cannot be written ({error.strerror}).") from error
        handler.setFormatter(logging.Formatter(FORMAT))
    logger = logging.getLogger(ROOT)
    # off below: with nobody listening no message is even put together
    logger.setLevel(level if directory is not None else logging.CRITICAL + 1)
    logger.addHandler(handler)
    _installed.append(handler)


def close_logging() -> None:
    """Close log.txt, if there is one, and leave logging as it was before setup_logging."""
    logger = logging.getLogger(ROOT)
    while _installed:
        handler = _installed.pop()
        logger.removeHandler(handler)
        handler.close()
    logger.setLevel(logging.NOTSET)
