"""Figures 8 to 11 of the paper: loads, flows, friction and lengths over a period or a run."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import StrMethodFormatter

from porolub.io.figure import BLUE, GREEN, GREY, VERMILLION, explain, label, new_figure, tidy
from porolub.io.time_axis import Course, draw_drive, has_drive, set_time_axis, shade_reversal
from porolub.io.words import Unit, load_unit, mass_flow_unit
from porolub.solve.report import Array

_FLOWS = {
    "inflow_left": ("in, left $M_{in,l}$", BLUE, "-"),
    "inflow_right": ("in, right $M_{in,r}$", VERMILLION, "-"),
    "outflow_left": ("out, left $M_{out,l}$", BLUE, "--"),
    "outflow_right": ("out, right $M_{out,r}$", VERMILLION, "--"),
}
_FAINTEST = 1e-6  # of the largest flow, on a logarithmic axis
_SPIKE = 20.0  # times its median: a load ratio that is larger now and then leaves the linear axis


def draw_history(course: Course, title: str) -> dict[str, Figure]:
    """Return the figures the course has data for, by file name."""
    if len(course.x) < 2:
        return {}
    figures = {}
    if course.has("load_solid", "load_fluid"):
        figures["loads.png"] = _loads(course, title)
    if course.has(*_FLOWS):
        figures["flows.png"] = _flows(course, title)
    if course.has("friction_coefficient", "load_ratio"):
        figures["friction.png"] = _friction(course, title)
    if course.has("contact_length", "penetration_length"):
        figures["lengths.png"] = _lengths(course, title)
    return figures


def _start(course: Course, title: str, load: bool) -> tuple[Figure, Axes, list[Any]]:
    """Figure, axes to draw on and legend so far; a strip below shows what drives the run."""
    strip = has_drive(course, load)
    heights = (5.0, 1.0) if strip else (1.0,)
    figure, axes = new_figure(title, rows=len(heights), legend=True, heights=heights)
    handles = shade_reversal(axes[0], course)
    if strip:
        shade_reversal(axes[1], course)
        draw_drive(axes[1], course, load)
        figure.align_ylabels(axes)
    set_time_axis(axes[-1], course)
    axes[0].spines["right"].set_visible(False)
    return figure, axes[0], handles


def _curve(ax: Axes, course: Course, values: Array, name: str, colour: str, style: str,
           width: float = 2.0) -> Any:  # fmt: skip
    (line,) = ax.plot(course.x, values, color=colour, lw=width, ls=style, label=name)
    return line


def _loads(course: Course, title: str) -> Figure:
    figure, ax, handles = _start(course, f"Load shares ({title})", load=False)
    unit = load_unit(course.dimension)
    for key, name, colour, style in (
        ("load_total", "total L", "black", ":"),
        ("load_fluid", "fluid $L_f$", BLUE, "-"),
        ("load_solid", "solid $L_s$", VERMILLION, "--"),
    ):
        handles.append(_curve(ax, course, course.column(key) / unit.size, name, colour, style))
    _zero(ax)
    label(ax, y=f"load [{unit.name}]")
    explain(ax, handles)
    return figure


def _flows(course: Course, title: str) -> Figure:
    figure, ax, handles = _start(course, f"Flow through the surface ({title})", load=True)
    unit = mass_flow_unit(course.dimension)
    largest = 0.0
    mirrored = _mirrored(course)
    for key, (name, colour, style) in _FLOWS.items():
        values = course.column(key) / unit.size
        width = 2.0 if not mirrored else 3.6 if key.endswith("left") else 1.4
        handles.append(_curve(ax, course, values, name, colour, style, width))
        largest = max(largest, np.nanmax(values, initial=0.0))
    if course.logarithmic:  # what begins with a burst fades over as many decades as time has
        ax.set_yscale("log")
        ax.set_ylim(_FAINTEST * largest, 2 * largest)
    else:
        _zero(ax)
    label(ax, y=f"mass flow [{unit.name}]")
    explain(ax, handles)
    return figure


def _mirrored(course: Course) -> bool:
    """Whether left and right do the same, so that one curve would hide the other."""
    for way in ("inflow", "outflow"):
        left, right = (np.nan_to_num(course.column(f"{way}_{side}")) for side in ("left", "right"))
        if np.abs(left - right).max() > 0.01 * np.abs(left).max():
            return False
    return True


def _friction(course: Course, title: str) -> Figure:
    figure, ax, handles = _start(course, f"Friction and load ratio ({title})", load=True)
    if course.has("friction_coefficient"):
        values = course.column("friction_coefficient")
        handles.append(_curve(ax, course, values, "friction coefficient μ", VERMILLION, "-"))
        label(ax, y="friction coefficient μ", colour=VERMILLION)
    ratio = course.column("load_ratio")
    if course.has("load_ratio"):
        right = ax.twinx()
        tidy(right)
        name = "load ratio $L_f/L_s$"
        handles.append(_curve(right, course, ratio, name, BLUE, "--"))
        label(right, y=name, colour=BLUE)
        size = np.abs(ratio)
        if np.nanmax(size) > _SPIKE * max(np.nanmedian(size), 1.0):
            right.set_yscale("asinh", linear_width=0.3)
            right.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    explain(ax, handles)
    return figure


def _lengths(course: Course, title: str) -> Figure:
    figure, ax, handles = _start(course, f"Contact and penetration length ({title})", load=True)
    unit = Unit("mm", 1e-3)
    for key, name, colour, style in (
        ("contact_length", "contact length b", VERMILLION, "-"),
        ("contact_width", "contact width, along z", BLUE, "-."),
        ("penetration_length", "penetration length $b_0$", GREEN, "--"),
    ):
        if course.has(key):
            handles.append(_curve(ax, course, course.column(key) / unit.size, name, colour, style))
    label(ax, y=f"length [{unit.name}]")
    explain(ax, handles)
    return figure


def _zero(ax: Axes) -> None:
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    ax.axhline(0, color=GREY, lw=0.8, zorder=0)
