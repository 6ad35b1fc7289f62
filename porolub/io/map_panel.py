"""The part of a moving picture that a body has: pressures on its lubricated surface."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from porolub.io.figure import VERMILLION, label, tidy
from porolub.io.section import Chart
from porolub.solve.report import Array, SurfaceMap

_MM, _KPA = 1e3, 1e-3


class MapPanel:
    """Fluid (or, of a dry surface, contact) pressure in kPa, and the edge of the contact.

    Set up once for all moments, then it shows one after the other.
    """

    def __init__(self, figure: Figure, ax: Axes, chart: Chart, surfaces: list[SurfaceMap],
                 stretch: tuple[float, float], aside: float) -> None:  # fmt: skip
        """``surfaces``: all that will be shown; ``stretch``: s from and to, m; ``aside``: where
        the profiles are cut, m."""
        self._ax, self._chart = ax, chart
        self._wet = any(surface.p.any() for surface in surfaces)
        values = [_KPA * self._shown(surface) for surface in surfaces]
        self._norm = Normalize(min(v.min() for v in values), max(v.max() for v in values))
        _, _, bottom, top = chart.box(surfaces)
        tidy(ax)
        ax.spines["right"].set_visible(False)
        ax.set_xlim(_MM * stretch[0], _MM * stretch[1])
        ax.set_ylim(_MM * bottom, _MM * top)
        label(ax, y=f"{chart.name} [mm]")
        ax.tick_params(labelbottom=False)
        ax.axhline(_MM * aside, color="white", lw=0.8, ls=":")
        place = ax.inset_axes((1.015, 0.0, 0.018, 1.0))
        bar = figure.colorbar(ScalarMappable(self._norm, "viridis"), cax=place)
        bar.set_label(f"{'fluid' if self._wet else 'contact'} pressure [kPa]", fontsize=12)
        bar.ax.tick_params(labelsize=11)
        self._painted: list[Any] = []
        handle = Line2D([], [], color=VERMILLION, lw=1.6, label="edge of contact")
        ax.legend(handles=[handle], loc="upper right", fontsize=10, framealpha=0.9)

    def _shown(self, surface: SurfaceMap) -> Array:
        return surface.p if self._wet else surface.p_c

    def show(self, surface: SurfaceMap) -> None:
        """Show a moment."""
        for artist in self._painted:
            artist.remove()
        places = self._chart.in_mm
        values = _KPA * self._shown(surface)
        self._painted = [self._ax.tripcolor(places, values, shading="gouraud", norm=self._norm,
                                            cmap="viridis", rasterized=True, zorder=0)]  # fmt: skip
        closed = (surface.p_c > 0).astype(float)
        if closed.any() and not closed.all():
            self._painted.append(self._ax.tricontour(
                places, closed, levels=[0.5], colors=[VERMILLION], linewidths=1.6))  # fmt: skip
