"""What the history of a transient run comes to: mean, least and largest values of a period."""

from collections.abc import Sequence

import numpy as np

from porolub.io.period import choose, cut, mean
from porolub.io.summary import KEYS
from porolub.solve.report import StepRecord

STATISTICS = ("mean", "min", "max")
_CHECKS = ("mass_balance_error", "load_balance_error")


def over_time(
    records: Sequence[StepRecord], period: float | None
) -> dict[str, dict[str, float | None]]:
    """Return by quantity its STATISTICS over the last full period, SI; over the whole run where
    nothing has the ``period`` (s).

    Quantities are those of the summary that the steps have. Between steps they are on straight
    lines, as where ``porolub run`` prints them.
    """
    if not records:
        return {}
    found = {key: None for record in records for key in record.values}
    names = [key for key in KEYS if key in found and key not in _CHECKS]
    history = {
        name: np.array([record.values.get(name, np.nan) for record in records], float)
        for name in names
    } | {"time": np.array([record.time for record in records])}
    data = cut(history, choose(history, period))
    statistics: dict[str, dict[str, float | None]] = {}
    for name in names:
        known = data[name][np.isfinite(data[name])]
        if len(known):
            numbers = (mean(data["time"], data[name]), known.min(), known.max())
            statistics[name] = dict(zip(STATISTICS, map(float, numbers), strict=True))
    return statistics
