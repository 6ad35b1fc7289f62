"""What an accuracy study found: the error of each setting and what it cost."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porolub.io.summary import number
from porolub.study.accuracy.convergence import Extrapolation, extrapolated, observed_order
from porolub.study.accuracy.quantities import estimate_of, value_of
from porolub.study.accuracy.strategies import Setting

Floats = NDArray[np.float64]
NOISE = 1e-8  # relative: what Newton leaves of a number
ORDERS_OF_MESHES = (0.5, 3.0)
"""Orders to believe: that of quadratic displacements is 3, contact edges make it less."""
ORDERS_OF_TOLERANCES = (0.3, 1.5)
"""An error grows about as the tolerance of a step, or slower."""
NOTHING = 1e-12  # a limit this small, of the largest value, is 0


@dataclass(frozen=True)
class Trial:
    """A setting and the run it led to; ``wall``: time of the solve on one rank, s, files left out;
    numbers are NaN of a run that failed. ``summary``: of the run, SI."""

    setting: Setting
    status: str
    message: str = ""
    wall: float = np.nan
    unknowns: float = np.nan
    steps: float = np.nan
    newton: float = np.nan
    summary: Mapping[str, Any] = field(default_factory=dict, repr=False)

    @property
    def converged(self) -> bool:
        """Whether there are results."""
        return self.status == "converged"


@dataclass(frozen=True)
class Measured:
    """The errors of one quantity, one for each trial.

    ``limit``: the value all errors are against, SI; ``uncertain``: by how much, in units of
    ``scale``; ``source``: the strategy it comes from, ``limits`` those of all strategies;
    ``scale``: |limit|, so that errors are ``relative``, or 1 where that is 0. Shape (trials,), NaN
    where there is none: ``values`` (SI), ``errors`` (over scale), ``orders`` (observed from the
    level and the two before), ``estimates`` (of the runs themselves, over scale).
    """

    quantity: str
    limit: float
    uncertain: float
    source: str
    scale: float
    relative: bool
    limits: Mapping[str, Extrapolation]
    values: Floats
    errors: Floats
    orders: Floats
    estimates: Floats

    @property
    def apart(self) -> float:
        """How far the limits of the strategies lie apart beyond their own uncertainty; over
        ``scale``."""
        gaps = [abs(self.limit - e.limit) - e.uncertain for e in self.limits.values()
                if np.isfinite(e.uncertain)]  # fmt: skip
        return max([0.0, *gaps]) / self.scale


def trial(setting: Setting, row: Mapping[str, Any] | None) -> Trial:
    """Return what became of a setting, from its row of the journal; None: it was refused."""
    if row is None:
        return Trial(setting, "refused")
    summary = row.get("summary") or {}
    if row["status"] != "converged":
        return Trial(setting, row["status"], row["message"])

    def of(table: Any, key: str) -> float:
        found = number(table or {}, key)
        return np.nan if found is None else found

    return Trial(
        setting,
        row["status"],
        wall=of(summary.get("wall_time"), "total"),
        unknowns=of(summary.get("dofs"), "total"),
        steps=of(summary, "time_steps"),
        newton=of(summary, "newton_iterations"),
        summary=summary,
    )


def measured(
    quantity: str,
    trials: Sequence[Trial],
    orders_believed: tuple[float, float] = ORDERS_OF_MESHES,
) -> Measured | None:
    """Return the errors of a quantity; None if no trial has it.

    All are against one limit, that of the strategy whose own extrapolation is the least uncertain.
    """
    values = np.array([_number(value_of(t.summary, quantity)) for t in trials])
    sizes = np.array([t.setting.size for t in trials])
    orders = np.full(len(trials), np.nan)
    limits: dict[str, Extrapolation] = {}
    for strategy in dict.fromkeys(t.setting.strategy for t in trials):
        mine = np.array([t.setting.strategy == strategy for t in trials]) & np.isfinite(values)
        rows = np.flatnonzero(mine)
        if len(rows):
            limits[strategy] = extrapolated(sizes[rows], values[rows], NOISE, orders_believed)
        for last in range(2, len(rows)):
            three = rows[last - 2 : last + 1]
            order = observed_order(sizes[three], values[three], NOISE, orders_believed)
            orders[three[-1]] = _number(order)
    if not limits:
        return None
    source = min(limits, key=lambda strategy: limits[strategy].uncertain)
    limit, uncertain = limits[source].limit, limits[source].uncertain
    relative = abs(limit) > NOTHING * np.nanmax(np.abs(values))
    scale = abs(limit) if relative else 1.0
    estimates = np.array([_number(estimate_of(t.summary, quantity)) for t in trials])
    return Measured(quantity, limit, uncertain / scale, source, scale, relative, limits, values,
                    np.abs(values - limit) / scale, orders, estimates / scale)  # fmt: skip


def _number(value: float | None) -> float:
    return np.nan if value is None else value
