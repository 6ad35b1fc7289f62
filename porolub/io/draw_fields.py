"""Pictures of fields in the deformed layer (Figures 4 and 5 of the paper), two dimensions."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation
from numpy.typing import NDArray

from porolub.io.figure import GREY, label, new_figure
from porolub.solve.report import Array, FieldData

TRIANGLES = {
    ("triangle", 1): [(0, 1, 2)],
    ("triangle", 2): [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    ("quad", 1): [(0, 1, 2), (0, 2, 3)],
    ("quad", 2): [
        *((0, 4, 8), (0, 8, 7), (4, 1, 5), (4, 5, 8)),
        *((7, 8, 6), (7, 6, 3), (8, 5, 2), (8, 2, 6)),
    ],
}
"""Corners of the triangles each cell is cut into; nodes in VTK's order."""


def can_draw(fields: FieldData) -> bool:
    """Whether the layer is two-dimensional; bodies are looked at with ParaView."""
    return (fields.cell_type, fields.degree) in TRIANGLES


def draw_field(
    fields: FieldData, values: Array, name: str, title: str, plane: float | None
) -> Figure:
    """Draw nodal values (Pa) in kPa or MPa over the deformed layer, x in mm, y in um or mm.

    plane: height of the rigid plane in m, drawn where it is known. The axes are unequal, or else
    the layer, some 20 times as long as it is thick, would be a line.
    """
    position = fields.nodes + fields.displacement
    thin = np.ptp(position[:, 1]) < 5e-3
    y_factor, y_unit = (1e6, "μm") if thin else (1e3, "mm")
    x, y = 1e3 * position[:, 0], y_factor * position[:, 1]
    cells = fields.cells[:, np.array(TRIANGLES[fields.cell_type, fields.degree])].reshape(-1, 3)
    factor, unit = (1e-6, "MPa") if np.abs(values).max() >= 1e6 else (1e-3, "kPa")

    figure, (ax,) = new_figure(f"{name[0].upper()}{name[1:]} in the deformed layer ({title})")
    colours = ax.tripcolor(Triangulation(x, y, cells), factor * values, shading="gouraud")
    colours.set_rasterized(True)
    edges = np.stack([x, y], axis=1)[outline(cells)]
    ax.add_collection(LineCollection(edges, colors=GREY, linewidths=0.8))
    if plane is not None:
        ax.axhline(y_factor * plane, color="black", linewidth=1.2)
        ax.annotate(
            "rigid plane", (0.01, y_factor * plane), xycoords=("axes fraction", "data"),
            xytext=(0, 4), textcoords="offset points", fontsize=12,
        )  # fmt: skip
    label(ax, "x [mm]", f"y [{y_unit}]")
    ax.margins(x=0.01, y=0.06)
    ax.spines["right"].set_visible(False)
    bar = figure.colorbar(colours, ax=ax, pad=0.015, aspect=30)
    bar.set_label(f"{name} [{unit}]", fontsize=13, labelpad=10)
    bar.ax.tick_params(labelsize=12)
    bar.locator = MaxNLocator(8)
    bar.update_ticks()
    return figure


def outline(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the edges (n, 2) that belong to one triangle only."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    outer: NDArray[np.int64] = unique[count == 1]
    return outer
