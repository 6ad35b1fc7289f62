"""A surface in two coordinates: where it is drawn, cut along a line, and where things happen."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from matplotlib.tri import LinearTriInterpolator, Triangulation

from porolub.io.draw_fields import TRIANGLES
from porolub.scene import Scene
from porolub.solve.report import Array, SurfaceData, SurfaceMap

_HAPPENS = 0.02  # of the largest pressure: below it nothing happens
_MARGIN = 0.3  # of what is shown, around where things happen
_LINE = 401  # points of a cut where there is no row of nodes
_MOST = 400_000  # triangles; more take matplotlib minutes
_NODES = 5  # a row has at least


@dataclass(frozen=True)
class Chart:
    """A surface spread out: s to the right, ``aside`` (z; y where z does not vary) upward, in m."""

    surface: SurfaceMap
    s: Array
    aside: Array
    name: str
    triangles: Triangulation

    @classmethod
    def of(cls, surface: SurfaceMap) -> "Chart":
        """The chart of a surface."""
        degree = surface.degree
        if len(surface.cells) * len(TRIANGLES[surface.cell_type, degree]) > _MOST:
            degree = 1  # vertices are fine enough
        name = "z" if np.ptp(surface.z) >= 1e-6 * np.ptp(surface.y) else "y"
        aside = getattr(surface, name)
        cut = np.array(TRIANGLES[surface.cell_type, degree])
        cells = surface.cells[:, cut].reshape(-1, 3)
        return cls(surface, surface.s, aside, name, Triangulation(surface.s, aside, cells))

    def box(self, surfaces: list[SurfaceMap] | None = None) -> tuple[float, float, float, float]:
        """Where things happen in any of the surfaces (on this mesh): s and aside, from and to."""
        happens = np.zeros(len(self.s), bool)
        for surface in surfaces or [self.surface]:
            both = np.maximum(np.abs(surface.p), surface.p_c)
            happens |= both > _HAPPENS * both.max(initial=0.0)
        limits = []
        for place in (self.s, self.aside):
            low, high = place.min(), place.max()
            if happens.any():
                first, last = place[happens].min(), place[happens].max()
                margin = _MARGIN * (last - first)
                low, high = max(low, first - margin), min(high, last + margin)
            limits += [float(low), float(high)]
        return limits[0], limits[1], limits[2], limits[3]

    def cut(self, values: dict[str, Array], *, s: float | None = None,
            aside: float | None = None) -> tuple[Array, dict[str, Array]]:  # fmt: skip
        """Values along the line of one aside (or one s): positions (k,) on it, and each (k,).

        At the nodes, where there is a row of them on the line.
        """
        along, fixed, at = self.s, self.aside, aside or 0.0
        if s is not None:
            along, fixed, at = self.aside, self.s, s
        on_it = np.abs(fixed - at) < 1e-9 * np.ptp(fixed)
        line = np.unique(along[on_it])
        if len(line) < _NODES or np.ptp(line) < 0.9 * np.ptp(along):
            line = np.linspace(along.min(), along.max(), _LINE)
        same = np.full(len(line), at)
        where = (line, same) if s is None else (same, line)
        found = {n: LinearTriInterpolator(self.triangles, v)(*where) for n, v in values.items()}
        inside = ~np.ma.getmaskarray(next(iter(found.values())))
        return line[inside], {n: np.asarray(v[inside]) for n, v in found.items()}

    def profile(self, *, s: float | None = None, aside: float | None = None) -> SurfaceData:
        """As SurfaceData along such a line, ``s`` being the position on it."""
        m = self.surface
        flux = m.Q_s if s is None else m.Q_z
        values = {"x": m.x, "p": m.p, "p_c": m.p_c, "h": m.h, "Q": flux, "V": m.V}
        line, found = self.cut(values, s=s, aside=aside)
        found["h"] = np.where(found["p_c"] > 0, 0.0, found["h"])
        return SurfaceData(s=line, **found)

    @cached_property
    def in_mm(self) -> Triangulation:
        """The triangles with places in mm."""
        return Triangulation(1e3 * self.s, 1e3 * self.aside, self.triangles.triangles)

    def showing(self, surface: SurfaceMap) -> "Chart":
        """The same chart with what acts at another moment."""
        return replace(self, surface=surface)


def middle(chart: Chart, scene: Scene | None) -> tuple[float, str]:
    """Where to cut a surface lengthwise, and in words: a symmetry plane at its end, its middle."""
    low, high = chart.aside.min(), chart.aside.max()
    planes = getattr(scene.geometry, "symmetry", None) if scene is not None else None
    rounding = 1e-9 * (high - low)
    ends = [end for end in (low, high) if abs(end) <= rounding]
    if planes and ends and not {"front", "back"} <= set(planes):
        return ends[0], "symmetry plane"
    centre = (low + high) / 2
    return (0.0 if abs(centre) <= rounding else centre), "middle"
