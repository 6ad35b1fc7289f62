"""Time below a picture: a period or the whole run, with the motion and load that drive it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from porolub.io.figure import GREY, label, tidy
from porolub.io.period import History, Span, choose, cut
from porolub.io.words import Unit, load_unit
from porolub.scene import Scene
from porolub.solve.report import Array

REVERSED = "#F3ECDD"
"""Background where the speed is negative."""

_DECADES = 3  # of time from which on a run in which nothing varies is drawn over log time
_UNITS = (Unit("s", 1.0), Unit("ms", 1e-3), Unit("μs", 1e-6))


@dataclass(frozen=True)
class Course:
    """What happened over a span, to be drawn over time.

    ``rotates``: the speed is in rad/s; ``driven``: something the scene asks for varies.
    """

    data: History
    span: Span
    dimension: int = 2
    rotates: bool = True
    driven: bool = False

    @classmethod
    def of(cls, history: History, scene: Scene | None, number: int | None = None) -> "Course":
        """Cut out what is to be drawn; ``number`` of the period as in period.choose."""
        span = choose(history, None if scene is None else scene.period, number)
        data = cut(history, span)
        if scene is None:  # it may be lost; the history is not
            return cls(data, span)
        rotates = scene.motion is None or scene.motion.kind == "rotation"
        return cls(data, span, scene.dimension, rotates, scene.varies)

    @property
    def unit(self) -> Unit:
        """Unit of time that suits the span."""
        width = self.span.end - self.span.start
        return next((unit for unit in _UNITS if width >= 0.3 * unit.size), _UNITS[-1])

    @property
    def x(self) -> Array:
        """Time in the period, or of the run, in ``unit``."""
        zero = 0.0 if self.span.period is None else self.span.start
        return (self.data["time"] - zero) / self.unit.size

    @property
    def logarithmic(self) -> bool:
        """Whether it is told over the logarithm of time: a layer that settles from rest."""
        later = self.data["time"][self.data["time"] > 0]
        driven = self.driven or self.varies("speed") or self.varies("load_applied")
        return not driven and len(later) > 2 and bool(later[-1] > 10**_DECADES * later[0])

    def varies(self, name: str) -> bool:
        """Whether a column changes over the span by more than rounding."""
        values = self.data.get(name, np.array([np.nan]))
        known = values[np.isfinite(values)]
        return bool(len(known)) and bool(np.ptp(known) > 1e-6 * np.abs(known).max())

    def has(self, *names: str) -> bool:
        """Whether one of the columns has anything but zeros."""
        return any(np.nan_to_num(self.data[name]).any() for name in names if name in self.data)

    def column(self, name: str) -> Array:
        """Return a column; NaN where the run does not have it."""
        return self.data.get(name, np.full_like(self.data["time"], np.nan))


def set_time_axis(ax: Axes, course: Course) -> None:
    """Name and scale the x axis of the lowest axes."""
    period = course.span.period
    begins = "" if period is None else f" in period {period} (from t = {course.span.start:g} s)"
    label(ax, f"time{begins} [{course.unit.name}]")
    x = course.x
    if course.logarithmic:
        ax.set_xscale("log")
        ax.set_xlim(x[x > 0].min(), x[-1])
    elif x[-1] > x[0]:
        ax.set_xlim(x[0], x[-1])


def shade_reversal(ax: Axes, course: Course) -> list[Any]:
    """Shade where the speed is negative; return the handle for the legend, if it ever is."""
    speed, x = np.nan_to_num(course.column("speed")), course.x
    if not (speed < 0).any():
        return []
    for start, end in _negative(x, speed):
        ax.axvspan(start, end, color=REVERSED, lw=0, zorder=-1)
    return [Patch(color=REVERSED, label="clockwise" if course.rotates else "speed negative")]


def _negative(x: Array, y: Array) -> list[tuple[float, float]]:
    """Stretches of x where y, on straight lines, is below zero."""
    change = np.flatnonzero((y[1:] < 0) != (y[:-1] < 0))
    rise = y[change + 1] - y[change]
    zeros = x[change] - y[change] * (x[change + 1] - x[change]) / rise
    ends = np.concatenate([[x[0]], zeros, [x[-1]]])
    ends = ends[0 if y[0] < 0 else 1 :]
    return [(float(a), float(b)) for a, b in zip(ends[::2], ends[1::2], strict=False)]


def has_drive(course: Course, load: bool) -> bool:
    """Whether a strip has something to show: a speed or (``load``) an applied load that varies."""
    return course.varies("speed") or (load and course.varies("load_applied"))


def draw_drive(ax: Axes, course: Course, load: bool) -> None:
    """Draw the speed and, on the right, the applied load (if asked for) where they vary."""
    shown = []
    if course.varies("speed"):
        ax.plot(course.x, course.column("speed"), color="black", lw=1.5)
        ax.axhline(0, color=GREY, lw=0.8, zorder=0)
        label(ax, y="Ω [rad/s]" if course.rotates else "U [m/s]")
        shown.append(ax)
    if load and course.varies("load_applied"):
        unit = load_unit(course.dimension)
        values = course.column("load_applied") / unit.size
        right = ax.twinx() if shown else ax
        tidy(right)
        right.plot(course.x, values, color=GREY, lw=1.5, ls="--")
        right.set_ylim(min(0.0, 1.1 * np.nanmin(values)), max(0.0, 1.1 * np.nanmax(values)))
        label(right, y=f"L [{unit.name}]", colour=GREY)
        shown.append(right)
    for one in shown:
        one.tick_params(labelsize=11)
        one.locator_params(axis="y", nbins=3)
    if len(shown) < 2:
        ax.spines["right"].set_visible(False)
