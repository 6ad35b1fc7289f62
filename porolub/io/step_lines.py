"""Accepted steps of a transient run as aligned columns, one plain line each.

    awk '/^#/ { on = 1; next } on { print $2, $7 }' run.log      # time in s and mu of every step

The header, rejected steps and notes begin with ``#``, the first of them comes after the lines of
the steady start; what a step does not have is ``-``.
"""

import math
from collections.abc import Callable

from porolub.io.words import clock
from porolub.solve.report import StepRecord

EVERY = 40
"""Lines from one header to the next."""

COMMENT = "# "
"""Begins the lines that are no step."""

_Values = dict[str, float]


def fluid_share(values: _Values) -> float:
    """Return what fraction of the load the fluid carries; NaN where there is none."""
    total = values.get("load_total")
    fluid = values.get("load_fluid")
    return fluid / total if total and fluid is not None else math.nan


def _of(key: str, form: str, unit: float = 1.0) -> Callable[[_Values], str]:
    def cell(values: _Values) -> str:
        value = values.get(key)
        return _number(math.nan if value is None else value / unit, form)

    return cell


def _number(value: float, form: str) -> str:
    return format(value, form) if math.isfinite(value) else "-"


_COLUMNS: tuple[tuple[str, int, Callable[[_Values], str]], ...] = (
    ("dt/s", 9, _of("time_step", ".3e")),
    ("order", 5, _of("order", ".0f")),
    ("newton", 6, _of("newton_iterations", ".0f")),
    ("rejected", 8, _of("rejected_steps", ".0f")),
    ("mu", 8, _of("friction_coefficient", ".5f")),
    ("fluid/%", 7, lambda values: _number(100 * fluid_share(values), ".2f")),
    ("contact/mm", 10, _of("contact_length", ".4f", 1e-3)),
    ("p_max/kPa", 9, _of("pressure_max", ".2f", 1e3)),
)
"""Heading, width and cell of each column, after the step's number and time."""


class StepLines:
    """Numbers the steps and knows when a header is due."""

    def __init__(self) -> None:
        self._steps = 0

    def header(self) -> str | None:
        """Return the header where one is due before the next row."""
        if self._steps % EVERY:
            return None
        cells = [f"{name:>{width}}" for name, width, _ in _COLUMNS]
        return "  ".join([f"{'#step':<6}", f"{'t/s':>12}", *cells, f"{'left':>8}"])

    def row(self, record: StepRecord, left: float | None) -> str:
        """Return the line of a step; ``left``: estimated wall time to the end, s."""
        self._steps += 1
        cells = [f"{cell(record.values):>{width}}" for _, width, cell in _COLUMNS]
        time = f"{record.time:>12.9g}"
        end = "-" if left is None else clock(left)
        return "  ".join([f"{self._steps:<6}", time, *cells, f"{end:>8}"])


def rejected_line(time: float, step: float, why: str) -> str:
    """Return the line of a step of ``step`` s from ``time`` s that was not accepted."""
    return f"{COMMENT}rejected  t = {time:.9g} s  dt = {step:.3e} s  {' '.join(why.split())}"
