"""Pictures of a body's lubricated surface: maps of pressures, film thickness and flow, and cuts."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LogNorm, Normalize, SymLogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import StrMethodFormatter
from matplotlib.tri import LinearTriInterpolator
from numpy.typing import NDArray

from porolub.io.draw_surface import draw_pressures
from porolub.io.figure import CONTACT_ZONE, VERMILLION, heading, label, tidy
from porolub.io.section import Chart, middle
from porolub.scene import Scene
from porolub.solve.report import Array, SurfaceMap

THINNEST = 1e-8
"""Thinner films (m) have the colour of this one."""
_ARROWS = 18  # along the longer side
_FLAT = 0.5  # height over width
_UNEQUAL = 4.0  # sides that differ by more are not drawn to scale
_MM, _KPA, _UM, _MM2 = 1e3, 1e-3, 1e6, 1e6


def draw_maps(surface: SurfaceMap, title: str, scene: Scene | None) -> dict[str, Figure]:
    """Return the figures of a surface by file name."""
    chart = Chart.of(surface)
    figures = {"surface.png": _pressures_and_film(chart, title)}
    if surface.Q.any() or surface.V.any():
        figures["flow.png"] = _flow(chart, title)
    place, words = middle(chart, scene)
    along = draw_pressures(chart.profile(aside=place), f"{title}, {chart.name} = "
                           f"{_MM * place:.3g} mm, the {words}")  # fmt: skip
    figures["profile_s.png"] = along
    if np.ptp(chart.aside) > 0 and (surface.p.any() or surface.p_c.any()):
        s = float(chart.s[np.argmax(surface.p + surface.p_c)])
        figures["profile_z.png"] = draw_pressures(
            chart.profile(s=s), f"{title}, s = {_MM * s:.3g} mm",
            f"position across, {chart.name} [mm]")  # fmt: skip
    return figures


def _pressures_and_film(chart: Chart, title: str) -> Figure:
    surface = chart.surface
    panels: list[tuple[str, Array, Normalize]] = []
    for name, values in (("fluid pressure p [kPa]", surface.p),
                         ("contact pressure $p_c$ [kPa]", surface.p_c)):  # fmt: skip
        if values.any():
            panels.append((name, _KPA * values, Normalize()))
    film = _UM * np.maximum(surface.h, THINNEST)
    inside = _inside(chart)
    name = "film thickness h [μm]" if surface.Q.any() else "gap h [μm]"
    panels.append((name, film, LogNorm(film[inside].min(), film[inside].max())))
    figure, axes = _figure(chart, f"Lubricated surface ({title})", len(panels))
    for ax, (name, values, norm) in zip(axes, panels, strict=True):
        if not isinstance(norm, LogNorm):
            norm = Normalize(values[inside].min(), values[inside].max())
        _paint(figure, ax, chart, values, name, norm, "cividis" if "h [" in name else "viridis")
        _outline(ax, chart, filled="h [" in name)
    _explain(axes[0], chart)
    return figure


def _flow(chart: Chart, title: str) -> Figure:
    surface = chart.surface
    figure, axes = _figure(chart, f"Flow at the surface, arrows along the film flux ({title})", 2)
    inside = _inside(chart)
    size = _MM2 * np.hypot(surface.Q_s, surface.Q_z)
    largest = max(size[inside].max(), 1e-30)
    _paint(figure, axes[0], chart, np.maximum(size, 1e-4 * largest),
           "film flux |Q| [mm²/s]", LogNorm(1e-4 * largest, largest), "Blues")
    _arrows(axes[0], chart)
    flow = _UM * surface.V
    most = max(np.abs(flow[inside]).max(), 1e-30)
    both_signs = SymLogNorm(10.0 ** (math.ceil(math.log10(most)) - 3), vmin=-most, vmax=most)
    _paint(figure, axes[1], chart, flow, "flow out of the layer V [μm/s]", both_signs, "RdBu_r")
    for ax in axes:
        _outline(ax, chart)
    _explain(axes[0], chart)
    return figure


def _figure(chart: Chart, title: str, count: int) -> tuple[Figure, list[Axes]]:
    """Panels of the same part of the surface: side by side, or below each other where it is flat.

    To scale, unless that would make lines of them.
    """
    left, right, bottom, top = chart.box()
    ratio = (top - bottom) / (right - left)
    beside = ratio > _FLAT
    to_scale = 1 / _UNEQUAL < ratio < _UNEQUAL
    height = 7.0
    if beside and to_scale:
        height = float(np.clip((12 / count - 0.45) * ratio + 1.55, 3.5, 9.0))
    figure = Figure(figsize=(12, height), dpi=100, layout="constrained")
    FigureCanvasAgg(figure)
    shape = (1, count) if beside else (count, 1)
    axes = list(figure.subplots(*shape, sharex=True, sharey=True, squeeze=False).ravel())
    heading(figure, title)
    for k, ax in enumerate(axes):
        tidy(ax)
        ax.spines["right"].set_visible(False)
        if to_scale:
            ax.set_aspect("equal")
        ax.set_xlim(_MM * left, _MM * right)
        ax.set_ylim(_MM * bottom, _MM * top)
        label(ax, "s [mm]" if beside or k == count - 1 else "",
              f"{chart.name} [mm]" if not beside or k == 0 else "")  # fmt: skip
    return figure, axes


def _inside(chart: Chart) -> NDArray[np.bool_]:
    """(n,) which nodes are shown."""
    left, right, bottom, top = chart.box()
    inside: NDArray[np.bool_] = ((chart.s >= left) & (chart.s <= right)
                     & (chart.aside >= bottom) & (chart.aside <= top))  # fmt: skip
    return inside


def _paint(figure: Figure, ax: Axes, chart: Chart, values: Array, name: str, norm: Normalize,
           colours: str) -> None:  # fmt: skip
    painted = ax.tripcolor(
        chart.in_mm, values, shading="gouraud", norm=norm, cmap=colours, rasterized=True
    )
    spec = ax.get_subplotspec()
    beside = spec is not None and spec.get_gridspec().ncols > 1
    bar = figure.colorbar(painted, ax=ax, location="bottom" if beside else "right", pad=0.02,
                          aspect=25 if beside else 10)  # fmt: skip
    bar.set_label(name, fontsize=12)
    bar.ax.tick_params(labelsize=11)
    if isinstance(norm, SymLogNorm):
        high = math.floor(math.log10(np.abs(values).max(initial=1e-30)))
        decades = [10.0**k for k in range(high - 2, high + 1)]
        bar.set_ticks([*(-d for d in reversed(decades)), 0.0, *decades])
    if isinstance(norm, LogNorm | SymLogNorm):
        bar.ax.minorticks_off()
        (bar.ax.xaxis if beside else bar.ax.yaxis).set_major_formatter(StrMethodFormatter("{x:g}"))


def _outline(ax: Axes, chart: Chart, filled: bool = False) -> None:
    """Draw where contact ends; filled: hide what is inside, where there is no film."""
    closed = (chart.surface.p_c > 0).astype(float)
    if not closed.any() or closed.all():
        return
    if filled:
        ax.tricontourf(chart.in_mm, closed, levels=[0.5, 1.5], colors=[CONTACT_ZONE])
    ax.tricontour(chart.in_mm, closed, levels=[0.5], colors=[VERMILLION], linewidths=1.6)


def _explain(ax: Axes, chart: Chart) -> None:
    closed = chart.surface.p_c > 0
    if closed.any() and not closed.all():
        handle = Line2D([], [], color=VERMILLION, lw=1.6, label="edge of contact")
        ax.legend(handles=[handle], loc="upper right", fontsize=10, framealpha=0.9, borderpad=0.3)


def _arrows(ax: Axes, chart: Chart) -> None:
    """Arrows of the direction of the flux on a regular grid, as long as the root of its size."""
    left, right, bottom, top = chart.box()
    ratio = (top - bottom) / (right - left)
    rows = _ARROWS * (ratio if ax.get_aspect() != "auto" else 0.3)  # as high as the panel is
    s, aside = np.meshgrid(_spread(left, right, _ARROWS), _spread(bottom, top, max(round(rows), 3)))
    Q_s, Q_z = (np.ma.filled(LinearTriInterpolator(chart.triangles, q)(s, aside), 0.0)
                for q in (chart.surface.Q_s, chart.surface.Q_z))  # fmt: skip
    size = np.hypot(Q_s, Q_z)
    largest = max(size.max(), 1e-300)
    scale = np.sqrt(size / largest) / np.maximum(size, 1e-300)
    scale = np.where(size > 1e-4 * largest, scale, np.nan)
    ax.quiver(_MM * s, _MM * aside, scale * Q_s, scale * Q_z, angles="xy", scale_units="width",
              scale=_ARROWS / 1.1, width=0.004, color="black")  # fmt: skip


def _spread(low: float, high: float, count: int) -> Array:
    """The middles of so many parts."""
    middles: Array = low + (high - low) * (np.arange(count) + 0.5) / count
    return middles
