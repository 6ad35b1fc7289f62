"""Pictures of the profiles along the lubricated surface (Figure 6 of the paper)."""

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import StrMethodFormatter

from porolub.io.figure import (
    BLUE,
    CONTACT_ZONE,
    GREEN,
    GREY,
    VERMILLION,
    explain,
    label,
    new_figure,
    tidy,
)
from porolub.solve.report import Array, SurfaceData

THINNEST = 1e-9
"""Thinner films (m) are not drawn: in contact the gap is zero but for rounding."""

_ALONG = "position along the surface, from its middle [mm]"


def draw_pressures(surface: SurfaceData, title: str, along: str = _ALONG) -> Figure:
    """Draw fluid and contact pressure (kPa, left) and the film thickness (um, right, log).

    along: what the position is called.
    """
    figure, (ax,) = new_figure(f"Lubricated surface ({title})", legend=True)
    s = 1e3 * surface.s
    handles = _contact_zone(ax, surface)
    if surface.p.any():
        handles += ax.plot(s, 1e-3 * surface.p, color=BLUE, lw=2, label="fluid pressure p")
    if surface.p_c.any():
        handles += ax.plot(
            s, 1e-3 * surface.p_c, color=VERMILLION, lw=2, ls="--", label="contact pressure $p_c$"
        )
    label(ax, along, "pressure [kPa]")
    ax.axhline(0, color=GREY, lw=0.8, zorder=0)
    ax.margins(x=0.01)
    film = np.where(surface.h > THINNEST, surface.h, np.nan)
    if not np.isnan(film).all():
        right = ax.twinx()
        tidy(right)
        name = "film thickness h" if surface.Q.any() else "gap h"
        handles += right.semilogy(s, 1e6 * film, color=GREEN, lw=2, ls="-.", label=name)
        label(right, y=f"{name} [μm]", colour=GREEN)
        right.set_ylim(bottom=10 ** math.floor(math.log10(1e6 * np.nanmin(film))))
        right.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    explain(ax, handles)
    return figure


def draw_flows(surface: SurfaceData, title: str) -> Figure:
    """Draw the film flux (mm^2/s) and, below, the flow out of the layer (um/s)."""
    figure, (flux, flow) = new_figure(f"Flow at the surface ({title})", rows=2, legend=True)
    s = 1e3 * surface.s
    curves = ((flux, 1e6 * surface.Q, BLUE), (flow, 1e6 * surface.V, VERMILLION))
    for ax, values, colour in curves:
        zone = _contact_zone(ax, surface)
        ax.axhline(0, color=GREY, lw=0.8, zorder=0)
        ax.plot(s, values, color=colour, lw=2)
        ax.margins(x=0.01)
        ax.spines["right"].set_visible(False)
        _show_both_signs(ax, values)
    label(flux, y="film flux Q [mm²/s]")
    label(flow, _ALONG, "flow out of the layer V [μm/s]")
    if zone:
        explain(flux, zone)
    figure.align_ylabels([flux, flow])
    return figure


def _show_both_signs(ax: Axes, values: Array) -> None:
    """Use a scale, linear about zero and logarithmic beyond, where one sign would be invisible."""
    small, large = sorted((max(values.max(), 0.0), max(-values.min(), 0.0)))
    if 1e-4 * large < small < 0.05 * large:
        ax.set_yscale("symlog", linthresh=10 ** math.ceil(math.log10(small)))
        ax.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))


def _contact_zone(ax: Axes, surface: SurfaceData) -> list[Any]:
    """Shade where the surfaces touch; return the handle for the legend, if they do."""
    touching = surface.s[surface.p_c > 0]
    if not len(touching):
        return []
    ax.axvspan(1e3 * touching.min(), 1e3 * touching.max(), color=CONTACT_ZONE, lw=0, zorder=-1)
    return [Patch(color=CONTACT_ZONE, label="contact")]
