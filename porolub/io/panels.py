"""The parts of a moving picture: field in the layer, profiles along the surface, course of time.

Each is set up once for a whole period (fixed axes and colours) and then shows frame after frame.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator, StrMethodFormatter
from matplotlib.tri import Triangulation

from porolub.io.draw_fields import TRIANGLES, outline
from porolub.io.draw_surface import THINNEST
from porolub.io.figure import BLUE, CONTACT_ZONE, GREEN, GREY, VERMILLION, explain, label, tidy
from porolub.io.time_axis import Course, set_time_axis, shade_reversal
from porolub.io.words import load_unit
from porolub.solve.report import Array, FieldData, FrameData, SurfaceData

_COLOURS = "viridis"
_BANDS = 20
_THINNEST_SHOWN = 0.01  # um; there is none thinner but for an instant
_MM, _KPA, _UM = 1e3, 1e-3, 1e6


def field_of(fields: FieldData) -> tuple[str, Array]:
    """Return what is shown in the layer: the pressure, of a dry layer the von Mises stress."""
    if fields.pressure is not None:
        return "fluid pressure", fields.pressure
    return "von Mises stress", fields.von_mises


@dataclass
class Limits:
    """What all frames of a moving picture reach (SI); grows frame by frame."""

    values: tuple[float, float] = (np.inf, -np.inf)
    happens: tuple[float, float] = (np.inf, -np.inf)
    pressure: tuple[float, float] = (0.0, -np.inf)
    film: tuple[float, float] = (np.inf, -np.inf)
    wet: bool = False
    ends: tuple[float, float] = (np.inf, -np.inf)
    """Of the surface, x in m."""
    moves: Array | None = None
    """(nodes, 4) least and greatest x and y of each node."""

    def add(self, frame: FrameData) -> None:
        """Take in a frame."""
        _, values = field_of(frame.fields)
        self.values = _wider(self.values, values)
        place = frame.fields.nodes + frame.fields.displacement
        low, high = (place, place) if self.moves is None else np.split(self.moves, 2, axis=1)
        self.moves = np.hstack([np.minimum(low, place), np.maximum(high, place)])
        if isinstance(frame.surface, SurfaceData):
            self.add_surface(frame.surface)

    def add_surface(self, surface: SurfaceData) -> None:
        """Take in profiles alone."""
        both = np.maximum(np.abs(surface.p), surface.p_c)
        self.happens = _wider(self.happens, surface.x[both > 0.02 * both.max(initial=0.0)])
        self.pressure = _wider(_wider(self.pressure, surface.p), surface.p_c)
        self.film = _wider(self.film, surface.h[surface.h > THINNEST])
        self.wet |= bool(surface.p.any() or surface.Q.any())
        self.ends = _wider(self.ends, surface.x)

    def box(self) -> tuple[float, float, float, float]:
        """Return where things happen: x from and to, y from and to, in m."""
        assert self.moves is not None
        left, bottom, right, top = self.moves.T
        start, end = self.stretch()
        inside = (right >= start) & (left <= end)
        return start, end, bottom[inside].min(), top[inside].max()

    def stretch(self) -> tuple[float, float]:
        """Return where things happen: x from and to, in m."""
        start, end = self.ends
        if self.moves is not None:
            start, end = self.moves[:, 0].min(), self.moves[:, 2].max()
        if self.happens[0] < self.happens[1]:
            margin = 0.2 * (self.happens[1] - self.happens[0])
            start = max(start, self.happens[0] - margin)
            end = min(end, self.happens[1] + margin)
        return start, end


def _wider(limits: tuple[float, float], values: Array) -> tuple[float, float]:
    return (min(limits[0], values.min(initial=np.inf)), max(limits[1], values.max(initial=-np.inf)))


def _bands(low: float, high: float) -> Array:
    """Boundaries of some 20 bands of colour; zero, the value far away, is inside of one."""
    step = np.diff(MaxNLocator(_BANDS).tick_values(low, max(high, low + 1e-6)))[0]
    return step * (np.arange(np.round(low / step), np.round(high / step) + 2) - 0.5)


class FieldPanel:
    """A field (kPa) on the deformed layer near the contact, above the rigid plane."""

    def __init__(self, figure: Figure, ax: Axes, frame: FrameData, limits: Limits,
                 plane: tuple[float, float] | None, mover: str) -> None:  # fmt: skip
        """``plane``: its lowest and highest position in m; None where there is none.

        ``mover``: what moves, body or plane.
        """
        self._ax = ax
        name, _ = field_of(frame.fields)
        x0, x1, y0, y1 = limits.box()
        y0, y1 = min(y0, *(plane or (y0,))), max(y1, *(plane or (y1,)))
        thin = y1 - y0 < 5e-3
        self._y, unit = (_UM, "μm") if thin else (_MM, "mm")
        low, high = _KPA * limits.values[0], _KPA * limits.values[1]
        self._levels = _bands(low, high)
        cells = frame.fields.cells
        near = limits.moves[cells] if limits.moves is not None else np.zeros((len(cells), 1, 4))
        shown = (near[..., 2].max(axis=1) >= x0) & (near[..., 0].min(axis=1) <= x1)
        cut = np.array(TRIANGLES[frame.fields.cell_type, frame.fields.degree])
        self._cells = cells[shown][:, cut].reshape(-1, 3)
        self._edges = outline(cells[:, cut].reshape(-1, 3))
        self._contours: Any = None
        self._outline = LineCollection([], colors=GREY, linewidths=0.8)
        ax.add_collection(self._outline)
        self._ground = None
        margin = 0.06 * (y1 - y0)
        tidy(ax)
        ax.set_xlim(_MM * x0, _MM * x1)
        ax.set_ylim(self._y * (y0 - margin), self._y * (y1 + margin))
        label(ax, y=f"y [{unit}]")
        ax.spines["right"].set_visible(False)
        if plane is not None:
            self._ground = ax.axhline(0, color="black", lw=1.2)
        halo = [withStroke(linewidth=4, foreground="white")]
        self._arrow = ax.annotate(
            "", (0.5, 0.92), (0.5, 0.92), xycoords="axes fraction", path_effects=halo,
            arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 2, "mutation_scale": 16},
        )  # fmt: skip
        self._mover = ax.text(
            0.5, 0.88, f"{mover} moves", transform=ax.transAxes, ha="center", va="top",
            fontsize=11, path_effects=halo,
        )  # fmt: skip
        ax.tick_params(labelbottom=False)
        place = ax.inset_axes((1.015, 0.0, 0.018, 1.0))
        colours = ScalarMappable(BoundaryNorm(self._levels, 256), _COLOURS)
        bar = figure.colorbar(colours, cax=place, spacing="proportional")
        bar.set_label(f"{name} [kPa]", fontsize=12)
        bar.set_ticks(MaxNLocator(6).tick_values(low, high))
        bar.ax.set_ylim(self._levels[0], self._levels[-1])
        bar.ax.minorticks_off()
        bar.ax.tick_params(labelsize=11)

    def show(self, frame: FrameData, plane: float | None, motion: float) -> None:
        """Show a frame; ``plane``: position of the rigid plane in m.

        ``motion``: speed of what moves, as a part of its largest; positive to the right.
        """
        self._arrow.set_position((0.5 - 0.08 * motion, 0.92))
        self._arrow.xy = (0.5 + 0.08 * motion, 0.92)
        for artist in (self._arrow, self._mover):
            artist.set_visible(abs(motion) > 0.05)
        if self._contours is not None:
            self._contours.remove()
        place = (frame.fields.nodes + frame.fields.displacement) * (_MM, self._y)
        _, values = field_of(frame.fields)
        self._contours = self._ax.tricontourf(
            Triangulation(place[:, 0], place[:, 1], self._cells), _KPA * values, self._levels,
            cmap=_COLOURS,
        )  # fmt: skip
        self._outline.set_segments(list(place[self._edges]))
        if self._ground is not None and plane is not None:
            self._ground.set_ydata([self._y * plane, self._y * plane])


class SurfacePanel:
    """Fluid and contact pressure (kPa, left) and film thickness (um, right) along the surface."""

    def __init__(self, ax: Axes, limits: Limits) -> None:
        tidy(ax)
        start, end = limits.stretch()
        ax.set_xlim(_MM * start, _MM * end)
        label(ax, "x [mm]", "pressure [kPa]")
        low, high = (_KPA * value for value in limits.pressure)
        margin = 0.06 * (high - low)
        ax.set_ylim(low - margin, high + margin)
        ax.axhline(0, color=GREY, lw=0.8, zorder=0)
        (self._fluid,) = ax.plot([], [], color=BLUE, lw=2, label="fluid pressure p")
        (self._contact,) = ax.plot(
            [], [], color=VERMILLION, lw=2, ls="--", label="contact pressure $p_c$"
        )
        handles = [self._fluid, self._contact] if limits.wet else [self._contact]
        self._fluid.set_visible(limits.wet)
        self._ax = ax
        self._zone: Any = None
        self._film: Any = None
        if limits.film[0] < limits.film[1]:
            right = ax.twinx()
            tidy(right)
            name = "film thickness h" if limits.wet else "gap h"
            (self._film,) = right.semilogy([], [], color=GREEN, lw=2, ls="-.", label=name)
            label(right, y="h [μm]", colour=GREEN)
            thinnest = max(0.7 * _UM * limits.film[0], _THINNEST_SHOWN)
            right.set_ylim(thinnest, max(1.5 * _UM * limits.film[1], 10 * thinnest))
            right.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
            handles.append(self._film)
        explain(ax, handles)

    def show(self, surface: SurfaceData) -> None:
        """Show a frame's profiles, and shade where the surfaces touch."""
        x = _MM * surface.x
        self._fluid.set_data(x, _KPA * surface.p)
        self._contact.set_data(x, _KPA * surface.p_c)
        if self._film is not None:
            self._film.set_data(x, np.where(surface.h > THINNEST, _UM * surface.h, np.nan))
        if self._zone is not None:
            self._zone.remove()
            self._zone = None
        touching = x[surface.p_c > 0]
        if len(touching):
            self._zone = self._ax.axvspan(
                touching.min(), touching.max(), color=CONTACT_ZONE, lw=0, zorder=-1
            )


class CoursePanel:
    """Load shares (left) and friction (right) over the period, and a marker where a frame is."""

    def __init__(self, ax: Axes, course: Course) -> None:
        tidy(ax)
        self._course = course
        handles = shade_reversal(ax, course)
        unit = load_unit(course.dimension)
        fluid, solid = (course.column(f"load_{name}") / unit.size for name in ("fluid", "solid"))
        curves = [
            (ax, fluid, BLUE, "-", "fluid $L_f$"),
            (ax, solid, VERMILLION, "--", "solid $L_s$"),
        ]
        if course.has("friction_coefficient"):
            right = ax.twinx()
            tidy(right)
            label(right, y="μ")
            friction = course.column("friction_coefficient")
            curves.append((right, friction, "black", ":", "friction coefficient μ"))
        self._dots: list[tuple[Array, Any]] = []
        for axes, values, colour, style, name in curves:
            handles += axes.plot(course.x, values, color=colour, lw=2, ls=style, label=name)
            (dot,) = axes.plot([], [], "o", color=colour, ms=7)
            self._dots.append((values, dot))
        self._now = ax.axvline(course.x[0], color=GREY, lw=1.2)
        ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
        label(ax, y=f"load [{unit.name}]")
        set_time_axis(ax, course)
        explain(ax, handles)

    def show(self, time: float) -> None:
        """Move the marker to a time in s."""
        zero = 0.0 if self._course.span.period is None else self._course.span.start
        x = (time - zero) / self._course.unit.size
        self._now.set_xdata([x, x])
        for values, dot in self._dots:
            dot.set_data([x], [np.interp(time, self._course.data["time"], values)])
