"""The load on a hip over a gait cycle: two peaks and a trough while the foot stands, then swing.

    value(t) = scale * g(frequency t),   g of period 1

The shape is that of ISO 14242-1 (Implants for surgery: wear of total hip-joint prostheses, part 1,
loading and displacement parameters): 0.3 kN at heel strike, peaks of 3 kN at 12 % and 50 % of the
cycle, a trough of 1.5 kN at 32 %, 0.3 kN in swing. There swing begins at 62 %; here at 60 %, as the
reference paper's Case 5 says. Divided by the swing load, g runs through

    phase   0    0.12   0.32     0.5    0.6 ... 1
    g       1    peak   trough   peak   1

joined by a monotone cubic: it has a continuous slope, extremes only at these points, and is
constant in swing.
"""

from functools import lru_cache
from typing import Annotated, Any, Literal, Self

from pydantic import model_validator

from porolub.scene.base import broken
from porolub.scene.history import Extreme, History
from porolub.scene.units import LINE_LOAD, NUMBER, Frequency, LoadForce, Quantity

FIRST_PEAK, TROUGH, SECOND_PEAK, TOE_OFF = 0.12, 0.32, 0.5, 0.6
TROUGH_SHARE = 4 / 9  # (1.5 - 0.3) / (3 - 0.3): of the peaks' rise above the load in swing

PositiveForce = Annotated[float, LoadForce(LINE_LOAD, above=0)]


class Gait(History):
    """A load (N/m or N) over gait cycles of ``frequency`` (Hz), heel strike at t = 0.

    ``scale`` is the load in swing; ``peak`` and ``trough`` are multiples of it. By default the
    peaks are 10 times the swing load and the trough has the standard's proportion: 5 times.
    """

    profile: Literal["gait"]
    scale: PositiveForce
    frequency: Frequency
    peak: Annotated[float, Quantity(NUMBER, above=1)] = 10.0
    trough: Annotated[float, Quantity(NUMBER, above=0)] | None = None

    @model_validator(mode="after")
    def _trough_lies_below_the_peaks(self) -> Self:
        if self.trough is None:
            # the model is frozen; here it is still being built
            self.__dict__["trough"] = 1.0 + TROUGH_SHARE * (self.peak - 1.0)
        elif self.trough >= self.peak:
            raise broken(
                f"load.force.trough = {self.trough:g} must be less than "
                f"load.force.peak = {self.peak:g}."
            )
        return self

    def at(self, t: float) -> float:
        """Return the load at time ``t`` in s."""
        assert self.trough is not None  # _trough_lies_below_the_peaks
        phase = (self.frequency * t) % 1.0
        if phase >= TOE_OFF:
            return self.scale
        return self.scale * float(_stance(self.peak, self.trough)(phase))

    def kinks(self, start: float, end: float) -> list[float]:
        """Return no times: the slope is continuous."""
        return []

    @property
    def period(self) -> float:
        """One over the frequency, s."""
        return 1.0 / self.frequency

    @property
    def lowest(self) -> Extreme:
        """The load in swing, or that of the trough if it is lower."""
        assert self.trough is not None  # _trough_lies_below_the_peaks
        if self.trough < 1.0:
            return Extreme(self.scale * self.trough, TROUGH / self.frequency)
        return Extreme(self.scale, 0.0)

    @property
    def highest(self) -> Extreme:
        """The load of the peaks."""
        return Extreme(self.scale * self.peak, FIRST_PEAK / self.frequency)


@lru_cache(maxsize=16)
def _stance(peak: float, trough: float) -> Any:
    """Return g over the stance phase, swing on both sides: the slope is 0 where they meet."""
    from scipy.interpolate import PchipInterpolator  # imported late: it takes its time

    phase = (TOE_OFF - 1.0, 0.0, FIRST_PEAK, TROUGH, SECOND_PEAK, TOE_OFF, 1.0)
    return PchipInterpolator(phase, (1.0, 1.0, peak, trough, peak, 1.0, 1.0))
