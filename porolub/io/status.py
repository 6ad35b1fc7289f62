"""The status line at the foot of a terminal: a steady solve in one line, a transient run in two."""

import math

from rich.console import Group, RenderableType
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from porolub.io.pace import Pace
from porolub.io.step_lines import fluid_share
from porolub.io.words import seconds, short_time
from porolub.solve.report import StepRecord

_BAR = 24


def solve_status(fraction: float, stage: str, doing: str, elapsed: float) -> RenderableType:
    """Return the line of a solve that has reached this fraction of its target."""
    row = Table.grid(padding=(0, 2))
    bar = ProgressBar(total=1.0, completed=min(fraction, 1.0), width=_BAR)
    row.add_row(bar, f"{100 * fraction:.3g} %", stage, doing, seconds(elapsed))
    return row


class StepStatus:
    """Where a transient run from ``start`` to ``end`` (s) stands; ``wall`` is the clock now, s."""

    def __init__(self, start: float, end: float, wall: float) -> None:
        self.start, self.end = start, end
        self.pace = Pace(start, end, wall)
        self.steps = self.rejected = 0
        self.iteration: int | None = None
        """Newton iteration of the step that is being computed."""
        self._time = start
        self._values: dict[str, float] = {}

    def step(self, record: StepRecord, wall: float) -> None:
        """A step was accepted."""
        self.steps += 1
        self.iteration = None
        self._time, self._values = record.time, record.values
        self.pace.step(record.time, wall)

    def lines(self, elapsed: float) -> RenderableType:
        """Return both lines."""
        span = self.end - self.start
        done = min(max((self._time - self.start) / span, 0.0), 1.0) if span > 0 else 1.0
        left = self.pace.left()
        top = Table.grid(padding=(0, 2))
        top.add_row(
            ProgressBar(total=1.0, completed=done, width=_BAR),
            f"{100 * done:5.1f} %",
            f"t = {self._time:.6g} of {self.end:.6g} s",
            "" if left is None else f"{seconds(left)} left",
        )
        return Group(top, Text("  ".join(self._facts(elapsed)), no_wrap=True, overflow="ellipsis"))

    def _facts(self, elapsed: float) -> list[str]:
        facts = [f"step {self.steps} ({self.rejected} rejected)"]
        if (step := self._get("time_step")) is not None:
            facts.append(f"dt {short_time(step)}")
        newton = self._get("newton_iterations")
        known = [] if newton is None else [f"Newton {newton:.0f}"]
        if self.iteration is not None:
            known.append(f"now {self.iteration}")
        facts += [", ".join(known)] if known else []
        if (friction := self._get("friction_coefficient")) is not None:
            facts.append(f"mu {friction:.4f}")
        if math.isfinite(share := fluid_share(self._values)):
            facts.append(f"fluid {100 * share:.1f} %")
        return [*facts, seconds(elapsed)]

    def _get(self, key: str) -> float | None:
        value = self._values.get(key)
        return value if value is not None and math.isfinite(value) else None
