"""What variable-step BDF looks back on: times and contents of accepted states.

The rate of a content C at a new time t_0 is sum_i w_i C(t_i), with w the derivative of the
Lagrange polynomials through the last k + 1 times (order k), so contents are conserved exactly.
It follows PETSc's TSBDF step by step: a (re)start takes half a step of order 1 and uses that
state as its second point.  Brenan, Campbell, Petzold (1995), chapter 5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Entry:
    """An accepted state: time; x: owned values; content by term (size_local,); gained: what has
    entered since the start, summed as the scheme sums; order it was computed with."""

    time: float
    x: Array
    content: dict[str, Array]
    gained: float
    order: int


def derivative_weights(times: Array) -> Array:
    """d/dt at times[0] of the Lagrange polynomials through ``times`` (n,)."""
    n = len(times)
    out = np.zeros(n)
    for k in range(n):
        for j in range(n):
            if j != k:
                others = [m for m in range(n) if m not in (j, k)]
                slope = np.prod((times[0] - times[others]) / (times[k] - times[others]))
                out[k] += slope / (times[k] - times[j])
    return out


class Lookback:
    """Entries newest first, as far back as ``order`` needs."""

    def __init__(self, order: int) -> None:
        self.highest = order
        self.entries: list[Entry] = []
        self.steps = 0  # accepted since the last (re)start
        self._half: Entry | None = None

    def restart(self, entry: Entry) -> None:
        """Begin anew from a state, forgetting those before."""
        self.entries, self.steps, self._half = [entry], 0, None

    def is_half(self, t: float, step: float) -> bool:
        """Whether t is the half step a (re)start takes before its first step."""
        return self.steps == 0 and t < self.entries[0].time + 0.75 * step

    def order(self, half: bool) -> int:
        """Order of the step under way."""
        return 1 if half else min(self.steps + 2, self.highest)

    def nodes(self, half: bool) -> list[Entry]:
        """Entries the step under way looks back on."""
        known = list(self.entries)
        if self.steps == 0 and not half and self._half is not None:
            known.append(self._half)
        return known[: self.order(half)]

    def weights(self, t: float, half: bool) -> Array:
        """w (k + 1,) of the new time t and of ``nodes``."""
        return derivative_weights(np.array([t, *(e.time for e in self.nodes(half))]))

    def halfway(self, entry: Entry) -> None:
        """Keep the state of the half step."""
        self._half = entry

    def accept(self, entry: Entry) -> None:
        """A step is done."""
        self.entries.insert(0, entry)
        if self.steps == 0 and self._half is not None:
            self.entries.append(self._half)
        self.steps += 1
        del self.entries[self.highest + 2:]
