"""What a running solve shows: lines as it goes, on a terminal a status at the foot too.

A steady solve (also the one a transient run starts from) has a line for each Newton iteration. A
transient run, from ``begin`` on, has one for each accepted and each rejected step; on a terminal
the status shows the accepted ones and only the rejected stay. The lines of steps and notes go to
the log (logger ``porolub.progress``) whatever is shown; Newton iterations of a transient run go
there alone, at debug level.
"""

import logging
import time
from types import TracebackType
from typing import Literal, Self

from rich.console import Console, RenderableType
from rich.live import Live
from rich.text import Text

from porolub.io.newton_lines import NewtonLines
from porolub.io.status import StepStatus, solve_status
from porolub.io.step_lines import COMMENT, StepLines, rejected_line
from porolub.io.terminal import new_console
from porolub.solve.report import NewtonRecord, StepRecord

Mode = Literal["auto", "live", "lines", "quiet"]
_log = logging.getLogger("porolub.progress")


class Progress:
    """Shows stages, Newton iterations, steps, notes; ``done`` (or leaving ``with``) ends it.

    mode: ``live`` for a terminal; ``lines`` for batch logs: plain text, never wrapped; ``quiet``
    shows nothing; ``auto`` is live on a terminal and lines elsewhere.
    """

    def __init__(self, mode: Mode = "auto", console: Console | None = None) -> None:
        self._console = console or new_console()
        if mode == "auto":
            terminal = self._console.is_terminal and not self._console.is_dumb_terminal
            mode = "live" if terminal else "lines"
        self.mode: Mode = mode
        self._lines = NewtonLines()
        self._step_lines = StepLines()
        self._steps: StepStatus | None = None  # of a transient run, once it has begun
        self._live: Live | None = None
        self._start = time.monotonic()
        self._stage = ""
        self._fraction = 0.0

    def stage(self, name: str, fraction: float) -> None:
        """A continuation stage begins that is to reach this fraction of the target."""
        self._stage, self._fraction = name, fraction
        self._lines.restart()
        line = f"{name}: {100 * fraction:.3g} % of the target"
        if self._steps is not None:
            _log.debug(line)
            return
        self._say(line, "bold cyan")
        self._status("")

    def newton(self, record: NewtonRecord) -> None:
        """A Newton iteration is done."""
        if self._steps is not None:
            self._newton_of_step(record)
            return
        if self._idle():
            return
        header = self._lines.header(record)
        if header is not None:
            self._say(header, "dim")
        style = "yellow" if record.damping < 1 else ""
        self._say(self._lines.row(record), style, log_only=self._lines.updates(record))
        self._stage, self._fraction = record.stage, record.fraction
        self._status(f"iteration {record.iteration}")

    def begin(self, start: float, end: float) -> None:
        """A transient run begins (or goes on) at ``start``, to end at ``end``, in s."""
        self._steps = StepStatus(start, end, time.monotonic())
        self._step_lines = StepLines()
        self._lines.restart()
        self.note(f"time steps from {start:.9g} to {end:.9g} s")
        self._status()

    def step(self, record: StepRecord) -> None:
        """A time step was accepted; the state at the start, before ``begin``, is none."""
        if self._steps is None or self._idle():
            return
        self._steps.step(record, time.monotonic())
        header = self._step_lines.header()
        if header is not None:
            self._say(header, keep=False)
        self._say(self._step_lines.row(record, self._steps.pace.left()), keep=False)
        self._status()

    def rejected(self, time: float, step: float, why: str) -> None:
        """A step of ``step`` s from ``time`` s was not accepted; why in a sentence."""
        if self._steps is None or self._idle():
            return
        self._steps.rejected += 1
        self._steps.iteration = None
        self._lines.restart()
        self._say(rejected_line(time, step, why), "yellow")
        self._status()

    def note(self, text: str) -> None:
        """Something the user should know, such as a stage that is taken back."""
        self._say(text if self._steps is None else COMMENT + text, "magenta")

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

    def _idle(self) -> bool:
        """Whether nobody would see a line, as on all ranks but the first."""
        return self.mode == "quiet" and not _log.isEnabledFor(logging.INFO)

    def _newton_of_step(self, record: NewtonRecord) -> None:
        """Iterations of a time step do not scroll by."""
        if _log.isEnabledFor(logging.DEBUG):
            header = self._lines.header(record)
            if header is not None:
                _log.debug(header)
            _log.debug("%s%s", self._lines.row(record), self._lines.updates(record))
        if self._steps is not None and self.mode == "live":
            self._steps.iteration = record.iteration
            self._status()

    def _say(self, line: str, style: str = "", log_only: str = "", keep: bool = True) -> None:
        """Log a line and show it; on a terminal only if it is one to ``keep``."""
        _log.info("%s%s", line, log_only)
        if self.mode == "live" and keep:
            self._console.print(Text(line.removeprefix(COMMENT), style=style), soft_wrap=True)
        elif self.mode == "lines":
            # no styles: a batch log is read with other tools
            print(line, file=self._console.file, flush=True)

    def _status(self, doing: str = "") -> None:
        """Renew the status; it is not renewed in between, which would take a thread."""
        if self.mode != "live":
            return
        if self._live is None:
            self._live = Live(console=self._console, auto_refresh=False, transient=True)
            self._live.start()
        elapsed = time.monotonic() - self._start
        status: RenderableType
        if self._steps is not None:
            status = self._steps.lines(elapsed)
        else:
            status = solve_status(self._fraction, self._stage, doing, elapsed)
        self._live.update(status, refresh=True)
