"""What a running solve shows: a line for each Newton iteration, on a terminal a status line too.

The same lines go to the log (logger ``porolub.progress``), whatever is shown.
"""

import logging
import time
from types import TracebackType
from typing import Literal, Self

from rich.console import Console
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from porolub.io.newton_lines import NewtonLines
from porolub.io.words import seconds
from porolub.solve.report import NewtonRecord

Mode = Literal["auto", "live", "lines", "quiet"]
_log = logging.getLogger("porolub.progress")


class Progress:
    """Shows stages, Newton iterations and notes; ``done`` (or leaving ``with``) ends it.

    mode: ``live`` for a terminal; ``lines`` for batch logs: plain text, never wrapped; ``quiet``
    shows nothing; ``auto`` is live on a terminal and lines elsewhere.
    """

    def __init__(self, mode: Mode = "auto", console: Console | None = None) -> None:
        self._console = console or Console()
        if mode == "auto":
            terminal = self._console.is_terminal and not self._console.is_dumb_terminal
            mode = "live" if terminal else "lines"
        self.mode: Mode = mode
        self._lines = NewtonLines()
        self._live: Live | None = None
        self._start = time.monotonic()
        self._stage = ""
        self._fraction = 0.0

    def stage(self, name: str, fraction: float) -> None:
        """A continuation stage begins that is to reach this fraction of the target."""
        self._stage, self._fraction = name, fraction
        self._lines.restart()
        self._say(f"{name}: {100 * fraction:.3g} % of the target", "bold cyan")
        self._status("")

    def newton(self, record: NewtonRecord) -> None:
        """A Newton iteration is done."""
        if self.mode == "quiet" and not _log.isEnabledFor(logging.INFO):
            return
        header = self._lines.header(record)
        if header is not None:
            self._say(header, "dim")
        style = "yellow" if record.damping < 1 else ""
        self._say(self._lines.row(record), style, log_only=self._lines.updates(record))
        self._stage, self._fraction = record.stage, record.fraction
        self._status(f"iteration {record.iteration}")

    def note(self, text: str) -> None:
        """Something the user should know, such as a stage that is taken back."""
        self._say(text, "magenta")

    def done(self) -> None:
        """Nothing more will come; take the status line away."""
        if self._live is not None:
            self._live.stop()
            self._live = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.done()

    def _say(self, line: str, style: str, log_only: str = "") -> None:
        _log.info("%s%s", line, log_only)
        if self.mode == "live":
            self._console.print(Text(line, style=style), soft_wrap=True)
        elif self.mode == "lines":
            # no styles: a batch log is read with other tools
            print(line, file=self._console.file, flush=True)

    def _status(self, doing: str) -> None:
        """Renew the status line; it is not renewed in between, which would take a thread."""
        if self.mode != "live":
            return
        if self._live is None:
            self._live = Live(console=self._console, auto_refresh=False, transient=True)
            self._live.start()
        row = Table.grid(padding=(0, 2))
        bar = ProgressBar(total=1.0, completed=min(self._fraction, 1.0), width=24)
        elapsed = seconds(time.monotonic() - self._start)
        row.add_row(bar, f"{100 * self._fraction:.3g} %", self._stage, doing, elapsed)
        self._live.update(row, refresh=True)
