"""When a run has become periodic: its last period repeats the one before."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from porolub.solve.report import StepRecord

COMPARED = {"load_solid": "load_applied", "load_fluid": "load_applied",
            "friction_coefficient": "friction_coefficient", "approach": "approach"}
"""What must repeat, and what its largest value is measured by."""
PHASES = 201


def difference_of_periods(records: Sequence[StepRecord], period: float) -> float:
    """Largest relative difference between the last period and the one before; inf without two.

    Each quantity is compared at the same phases and measured by its own largest value.
    """
    times = np.array([r.time for r in records])
    if not len(times) or times[-1] < times[0] + 2 * period * (1 - 1e-9):
        return np.inf
    phases = times[-1] - period * np.linspace(1.0, 0.0, PHASES)
    worst = 0.0
    for name, measure in COMPARED.items():
        if not all(name in r.values and measure in r.values for r in records):
            continue
        values = np.array([r.values[name] for r in records])
        size = max(abs(r.values[measure]) for r in records)
        change = np.interp(phases, times, values) - np.interp(phases - period, times, values)
        worst = max(worst, float(np.abs(change).max()) / size if size > 0 else 0.0)
    return worst
