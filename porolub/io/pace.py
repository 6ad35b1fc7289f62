"""How long a transient run will still take, from the wall time its steps have taken so far."""

import math
from bisect import bisect_right

ENOUGH = 5
"""Steps before an estimate is given, and the fewest it rests on."""


class Pace:
    """Estimates the wall time left in a run from ``start`` to ``end`` (simulated time, s).

    Steps are tiny at a start from rest and grow with the time gone by, until the histories or the
    tolerance bound them; a mean over all of them says little. What counts is the wall time of the
    last doubling of the time gone by (t/2 to t) and its ratio r to that of the doubling before:
    2 for even steps, 1 for steps that grow like t. Either the steps stay as they are, or the
    doublings to come go on in that ratio; the estimate is the geometric mean of the two, which
    are the same once the steps are even.
    """

    def __init__(self, start: float, end: float, wall: float) -> None:
        self.start, self.end = start, end
        self._done, self._wall = [0.0], [wall]

    def step(self, time: float, wall: float) -> None:
        """A step to ``time`` (s) was accepted when the wall clock showed ``wall`` (s)."""
        self._done.append(time - self.start)
        self._wall.append(wall)

    def left(self) -> float | None:
        """Return the wall time left, s; None while there are too few steps to tell."""
        done, steps = self._done[-1], len(self._done) - 1
        if steps < ENOUGH or done <= 0:
            return None
        doublings = math.log2(max((self.end - self.start) / done, 1.0))
        before, last = self._spent(done / 4, done / 2), self._spent(done / 2, done)
        r = min(max(last / before, 1.0), 2.0) if before > 0 else 2.0
        growing = doublings if r == 1 else math.expm1(doublings * math.log(r)) / (r - 1) * r
        even = 2 * (2**doublings - 1)
        return last * math.sqrt(even * growing)

    def _spent(self, a: float, b: float) -> float:
        """Wall time between two times gone by, s; on a straight line within a step."""
        return self._clock(b) - self._clock(a)

    def _clock(self, done: float) -> float:
        i = min(max(bisect_right(self._done, done), 1), len(self._done) - 1)
        width = self._done[i] - self._done[i - 1]
        part = (done - self._done[i - 1]) / width if width > 0 else 1.0
        return self._wall[i - 1] + part * (self._wall[i] - self._wall[i - 1])
