"""Which setting is the cheapest that is accurate enough."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from porolub.study.accuracy.measured import Floats, Measured, Trial

TARGETS = (0.1, 0.01, 0.001)


@dataclass(frozen=True)
class Advice:
    """The cheapest ``trial`` (its number) within ``target`` (relative) for all quantities, and its
    largest ``error``; ``trial`` is None where there is none, and ``error`` then the least there
    is, None if nothing converged."""

    target: float
    trial: int | None
    error: float | None


def advise(
    trials: Sequence[Trial], found: Sequence[Measured], targets: Sequence[float] = TARGETS
) -> list[Advice]:
    """Return the advice for each target.

    A setting's error is that of its worst quantity, and what the limit is uncertain by, or the
    strategies disagree about it, comes on top. All finer
    levels of its strategy that converged must be within the target, too: a value that is right
    only as it passes by is no reason to choose a mesh. Quantities whose limit is 0 have no
    relative error and do not count.
    """
    worst = _worst(trials, found)
    lasting = _lasting(trials, worst)
    least = float(np.nanmin(worst)) if np.isfinite(worst).any() else None
    advice = []
    for target in targets:
        good = [n for n in range(len(trials)) if lasting[n] <= target]
        best = min(good, key=lambda n: trials[n].wall, default=None)
        advice.append(Advice(target, best, least if best is None else float(worst[best])))
    return advice


def _worst(trials: Sequence[Trial], found: Sequence[Measured]) -> Floats:
    """(trials,) largest error over the quantities; NaN where one is not known."""
    relative = [m.errors + max(m.uncertain, m.apart) for m in found if m.relative]
    if not relative:
        return np.full(len(trials), np.nan)
    worst: Floats = np.max(relative, axis=0)
    return worst


def _lasting(trials: Sequence[Trial], worst: Floats) -> Floats:
    """(trials,) largest error of a setting and all finer ones of its strategy."""
    lasting = np.full(len(trials), np.inf)
    for n, own in enumerate(trials):
        finer = [worst[k] for k, other in enumerate(trials)
                 if other.setting.strategy == own.setting.strategy
                 and other.setting.size <= own.setting.size and np.isfinite(worst[k])]  # fmt: skip
        if np.isfinite(worst[n]):
            lasting[n] = max(finer)
    return lasting
