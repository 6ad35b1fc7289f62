"""How far the numbers of a run are from those of infinitely fine meshes and steps.

In space: what a number changes by from a mesh to one of twice the elements each way says how far it
still is from its limit, whatever the number is.  With order p it is |q_h - q_2h| / (2^p - 1); p is
at least 1 where the meshes resolve what happens, so the last change itself is taken for the error:
rather too large, by 3 for order 2.  Roache (1994) calls the like a grid convergence index.  A
steady solve goes through such meshes anyway; porolub.solve.coarser adds those that are missing.

In time: what a number differs by from the polynomial through its last values is the scheme's local
error but for a factor (Milne's device; Hairer, Norsett, Wanner 1993, III.7).  A layer forgets, so
errors of many steps add up like random ones: the root of the sum of their squares is taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from porolub.solve.report import StepRecord

Array = NDArray[np.float64]

QUANTITIES = ("friction_coefficient", "friction_fluid", "load_total", "load_solid", "load_fluid",
              "load_ratio", "approach", "film_min", "contact_length", "penetration_length",
              "inflow_left", "inflow_right", "outflow_left", "outflow_right", "pressure_max",
              "contact_pressure_max")
"""Numbers of a summary that have an error estimate."""

MESHES = 3
"""How many meshes are compared, at least where they can be had: two changes tell more than one,
which is small by chance where a number comes to its limit from both sides."""

SLOWEST = 1.2  # ratio of two changes below which convergence is not believed
FASTEST = 4.0  # of order 2; above it the last change is small by chance

MARK = "error "  # before names among the totals of a checkpoint

Numbers = Mapping[str, float | None]


def mesh_error(levels: Sequence[Numbers], node: float) -> dict[str, float]:
    """Absolute error of each of QUANTITIES on the last mesh, SI.

    ``levels``: the numbers on meshes of which each has twice the elements of the one before, along
    and across, coarsest first (of graded meshes the first may be one that is not graded yet);
    ``node``: size of the elements where contact ends (m), for its ends are nodes.  Empty with
    fewer than two; quantities without a number are left out.
    """
    if len(levels) < 2:
        return {}
    found = {}
    for name in QUANTITIES:
        values = [level.get(name) for level in levels]
        if None not in values[-2:]:
            first = max((i + 1 for i, value in enumerate(values) if value is None), default=0)
            found[name] = _error([float(v or 0.0) for v in values[first:]])
    if found.get("contact_length") is not None and levels[-1]["contact_length"]:
        found["contact_length"] = max(found["contact_length"], node)
    return found


def _error(values: Sequence[float]) -> float:
    """Of the last of two or more values."""
    changes = np.diff(values)[::-1]  # the last first
    expected = np.abs(changes) / FASTEST ** np.arange(len(changes))
    last = float(expected.max())
    if len(changes) == 1 or changes[0] * changes[1] <= 0.0 or last == 0.0:
        return last
    ratio = abs(float(changes[1])) / last
    return last / (max(ratio, SLOWEST) - 1.0) if ratio < 2.0 else last


def relative(errors: Numbers, numbers: Numbers) -> dict[str, float]:
    """Errors over the numbers they belong to; those of numbers that are 0 or missing left out."""
    return {k: e / abs(v) for k, e in errors.items() if e is not None and (v := numbers.get(k))}


def absolute(relative_errors: Numbers, numbers: Numbers) -> dict[str, float]:
    """Relative errors times the numbers; those of numbers that are missing left out."""
    return {k: e * abs(v) for k, e in relative_errors.items()
            if e is not None and (v := numbers.get(k)) is not None}


def time_error(times: Array, values: Array, order: int) -> float:
    """Of numbers (n,) found at times (n,) by BDF of an order, over all of the run."""
    n = order + 1  # points that the polynomial goes through
    if len(times) <= n:
        return 0.0
    t = np.lib.stride_tricks.sliding_window_view(times, n + 1)
    y = np.lib.stride_tricks.sliding_window_view(values, n + 1)
    t, y = (part[np.all(np.diff(t, axis=1) > 0.0, axis=1)] for part in (t, y))
    ahead = np.zeros(len(t))
    for i in range(n):  # Lagrange
        others = [j for j in range(n) if j != i]
        ahead += y[:, i] * np.prod((t[:, n:] - t[:, others]) / (t[:, [i]] - t[:, others]), axis=1)
    share = (t[:, n] - t[:, n - 1]) / (t[:, n] - t[:, 0])
    return float(np.sqrt(np.sum((share * (y[:, n] - ahead)) ** 2)))


@dataclass
class RunErrors:
    """Of a run in time; ``space``: relative errors of the steady state it starts from."""

    space: dict[str, float] = field(default_factory=dict)

    @classmethod
    def from_totals(cls, totals: Mapping[str, float]) -> RunErrors:
        """From what a checkpoint holds."""
        return cls({k.removeprefix(MARK): v for k, v in totals.items() if k.startswith(MARK)})

    def totals(self) -> dict[str, float]:
        """What a checkpoint is to hold."""
        return {f"{MARK}{name}": error for name, error in self.space.items()}

    def at_end(self, records: Sequence[StepRecord], order: int) -> dict[str, float]:
        """Absolute errors of the last step's numbers, SI: in space, as large relatively as at the
        start, and in time.  Empty where the run did not start from a steady state."""
        if not records:
            return {}
        times = np.array([record.time for record in records])
        found = absolute(self.space, records[-1].values)
        for name in found:
            values = np.array([record.values.get(name, np.nan) for record in records], dtype=float)
            if np.isfinite(values).all():
                found[name] += time_error(times, values, order)
        return found
