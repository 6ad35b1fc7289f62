"""What a running sweep shows: cases done, failed and running, the time it will still take.

On a terminal a status at the foot says so and only cases without a result scroll by; elsewhere
each case has a line. All lines go to the log too (logger ``porolub.sweep``).
"""

import logging
import textwrap
import time
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from porolub.io.summary import number
from porolub.io.terminal import new_console
from porolub.io.words import seconds
from porolub.study.work.label import case_label
from porolub.study.work.outcome import facts, one_line, troubles
from porolub.study.work.pace import SweepPace

Row = Mapping[str, Any]
_BAR = 24
_INDENT = 7
_WIDTH = 80  # of messages in a batch log
_NAME = 17  # "Newton iterations"
_START = 12  # "cases 12, 14"
_SHOWN = 4  # running cases that are named
_log = logging.getLogger("porolub.sweep")


class SweepProgress:
    """Follows the cases of a sweep; to be used on one thread of one rank.

    total: cases of the sweep, of which ``done_before`` need not be computed; groups: of ranks that
    work side by side; units: SI units of the axes that have one.
    """

    def __init__(
        self,
        total: int,
        groups: int,
        done_before: int = 0,
        quiet: bool = False,
        console: Console | None = None,
        units: Mapping[str, str] | None = None,
    ) -> None:
        self.total, self.done_before = total, done_before
        self._units = units or {}
        self._pace = SweepPace(total - done_before, groups)
        self._found: Counter[str] = Counter()  # by status
        self._running: dict[int, str] = {}  # labels by group
        self._width = 0
        self._start = time.monotonic()
        self._console = console or new_console()
        self._live: Live | None = None
        terminal = self._console.is_terminal and not self._console.is_dumb_terminal
        self.mode = "quiet" if quiet else "live" if terminal else "lines"

    @property
    def done(self) -> int:
        """Cases that need no more work, whatever came of them."""
        return self.done_before + self._found.total()

    def label(self, axes: Mapping[str, float | str]) -> str:
        """Return what a case is called, from the axes of its row."""
        return case_label(axes, self._units)

    def started(self, case_label: str, group: int) -> None:
        """A group of ranks has begun a case."""
        self._running[group] = case_label
        self._pace.started(group, time.monotonic())
        self.refresh()

    def finished(self, row: Row, group: int | None = None) -> None:
        """A case has this row now; without ``group`` the one that runs a case of its label."""
        label = self.label(row["axes"])
        if group is None:
            group = next((g for g, running in self._running.items() if running == label), None)
        if group is not None:
            self._running.pop(group, None)
        self._pace.finished(group, None if row["status"] == "refused" else row["wall"])
        self._found[row["status"]] += 1
        converged = row["status"] == "converged"
        message = "" if converged else one_line(row["message"])
        self._show(self._line(label, row), message, keep=not converged)
        self.refresh()

    def note(self, text: str) -> None:
        """Something the user should know."""
        self._show(text, "", keep=True)

    def refresh(self) -> None:
        """Renew the status; nothing else does while cases run, which would take a thread."""
        if self.mode != "live":
            return
        if self._live is None:
            self._live = Live(console=self._console, auto_refresh=False, transient=True)
            self._live.start()
        self._live.update(self.lines(), refresh=True)

    def lines(self) -> RenderableType:
        """Return the status: how far it is, how long it will take, what is running."""
        now = time.monotonic()
        left = self._pace.left(now)
        top = Table.grid(padding=(0, 2))
        top.add_row(
            ProgressBar(total=max(self.total, 1), completed=self.done, width=_BAR),
            f"{self.done}/{self.total} cases",
            "" if left is None else f"{seconds(left)} left",
        )
        counts = [f"{self._found[status]} {status}" for status in sorted(self._found)]
        counts.append(seconds(now - self._start))
        names = list(self._running.values())
        more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
        running = f"{len(names)} running: {'; '.join(names[:_SHOWN])}{more}" if names else "waiting"
        return Group(top, Text(", ".join(counts)), Text(running, no_wrap=True, overflow="ellipsis"))

    def summary(self, rows: Iterable[Row], directory: Path | None = None) -> None:
        """Show what came of all cases of the sweep, and where its table is; take the status away.

        ``rows``: of all cases, those of earlier runs included.
        """
        self.close()
        found = list(rows)
        if self.mode != "quiet":
            self._console.print()
        for name, value in facts(found, time.monotonic() - self._start, directory):
            self._show(f"{name:<{_NAME}}  {value}", "", keep=True)
        for heading, message in troubles(found, self._units):
            self._show(heading, message, keep=True)

    def close(self) -> None:
        """Take the status away."""
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
        self.close()

    def _line(self, label: str, row: Row) -> str:
        """Return the line of a case that is done."""
        self._width = max(self._width, len(label))
        summary = row.get("summary") or {}
        done = f"{self.done:>{len(str(self.total))}}/{self.total}"
        cells = [done, f"{label:<{self._width}}", f"{row['status']:<9}"]
        if (friction := number(summary, "friction_coefficient")) is not None:
            cells.append(f"mu {friction:.5f}")
        if (newton := number(summary, "newton_iterations")) is not None:
            cells.append(f"{newton:>2.0f} Newton from {row['start']:<{_START}}")
        cells.append(f"{seconds(row['wall']):>6}")
        left = self._pace.left(time.monotonic())
        if left is not None and self.done < self.total:
            cells.append(f"left {seconds(left)}")
        return "  ".join(cells)

    def _show(self, line: str, message: str, keep: bool) -> None:
        """Log a line and show it with the message below; on a terminal only one to ``keep``."""
        _log.info("%s: %s" if message else "%s%s", line, message)
        indent = " " * _INDENT
        live = self.mode == "live"
        width = self._console.width if live else _WIDTH
        below = textwrap.wrap(message, width, initial_indent=indent, subsequent_indent=indent,
                              break_long_words=False, break_on_hyphens=False)  # fmt: skip
        if live and keep:
            head = Text(line, style="yellow" if message else "")
            self._console.print(Text("\n").join([head, *map(Text, below)]), soft_wrap=True)
        elif self.mode == "lines":
            # no styles: a batch log is read with other tools
            print("\n".join([line, *below]), file=self._console.file, flush=True)
