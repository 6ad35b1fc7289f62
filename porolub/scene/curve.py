"""The curve through samples: straight lines, or a monotone cubic.

The monotone cubic (PCHIP; Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5, 1984) has a continuous
slope and its extremes are among the samples, so it never leaves their range. Outside the times of
its samples a curve is held constant, or it repeats.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

NO_JUMP = 1e-9  # of the steepest slope: less is rounding, not a kink


class Curve:
    """A curve through (k,) ``values`` at (k,) increasing ``times`` in s, k >= 2.

    With ``repeat`` the last sample is the first of the next period.
    """

    def __init__(
        self, times: Sequence[float], values: Sequence[float], smooth: bool, repeat: bool
    ) -> None:
        self.times, self.values = np.array(times), np.array(values)
        self.repeat = repeat
        self.first, self.last = times[0], times[-1]
        self._within = self._cubic() if smooth else self._lines()
        self._corners = self._smooth_corners() if smooth else self._line_corners()

    def at(self, t: float) -> float:
        """Return the value at time ``t`` in s."""
        first, last = self.first, self.last
        if self.repeat:
            return float(self._within(first + (t - first) % (last - first)))
        return float(self._within(min(max(t, first), last)))

    def kinks(self, start: float, end: float) -> list[float]:
        """Return the times between ``start`` and ``end`` where the slope jumps, ascending, s."""
        times = self._corners
        if self.repeat:
            period = self.last - self.first
            before = math.floor((start - self.last) / period)
            after = math.ceil((end - self.first) / period)
            times = [t + n * period for n in range(before, after + 1) for t in self._corners]
        return [t for t in times if start < t < end]

    def _lines(self) -> Callable[[float], float]:
        return lambda t: float(np.interp(t, self.times, self.values))

    def _cubic(self) -> Callable[[float], float]:
        """Repeated samples have neighbours on both sides."""
        from scipy.interpolate import PchipInterpolator  # imported late: it takes its time

        t, value = self.times, self.values
        if self.repeat:
            period = self.last - self.first
            t = np.concatenate((t[:-1] - period, t, t[1:] + period))
            value = np.concatenate((value[:-1], value, value[1:]))
        with np.errstate(over="ignore"):  # values that differ by next to nothing: slope 0
            cubic: Callable[[float], float] = PchipInterpolator(t, value)
        return cubic

    def _line_corners(self) -> list[float]:
        """Samples where the slope jumps; of a period, without its end."""
        slopes = np.diff(self.values) / np.diff(self.times)
        before = np.append(slopes[-1] if self.repeat else 0.0, slopes)
        after = np.append(slopes, 0.0)
        jumps = abs(after - before) > NO_JUMP * abs(slopes).max()
        corners = [float(t) for t in self.times[jumps]]
        return [t for t in corners if t != self.last] if self.repeat else corners

    def _smooth_corners(self) -> list[float]:
        """Only where it begins and ends to be held."""
        flat = bool((self.values == self.values[0]).all())
        return [] if self.repeat or flat else [self.first, self.last]
