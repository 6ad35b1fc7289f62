"""One look for all figures: 1200 x 700 pixels, colours told apart by everybody."""

from collections.abc import Sequence
from pathlib import Path
from textwrap import shorten
from typing import Any

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from porolub.io.atomic import replacing

# Okabe & Ito, Color Universal Design (2008)
BLUE, VERMILLION, GREEN, GREY = "#0072B2", "#D55E00", "#007A5A", "#606060"
CONTACT_ZONE = "#E6E6E6"
_FONT = 13


def new_figure(
    title: str, rows: int = 1, legend: bool = False, heights: Sequence[float] | None = None
) -> tuple[Figure, list[Axes]]:
    """Return a figure with ``rows`` axes below each other that share x, without pyplot.

    legend: leave room for one between the title and the axes; heights: of the rows, relative.
    """
    figure = Figure(figsize=(12, 7), dpi=100, layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(rows, 1, sharex=True, squeeze=False, height_ratios=heights)
    axes = list(grid[:, 0])
    axes[0].set_title(
        shorten(title, 100, placeholder=" ..."),
        loc="left",
        fontsize=_FONT + 1,
        pad=30 if legend else 8,
        parse_math=False,  # a title is the user's text
    )
    for ax in axes:
        tidy(ax)
    return figure, axes


def heading(figure: Figure, title: str) -> None:
    """Put a title above a figure of several panels."""
    figure.suptitle(
        shorten(title, 100, placeholder=" ..."),
        x=0.01,
        ha="left",
        fontsize=_FONT + 1,
        parse_math=False,
    )


def tidy(ax: Axes) -> None:
    """Give the axes readable figures and no frame where nothing is read off."""
    ax.tick_params(labelsize=_FONT - 1)
    ax.spines["top"].set_visible(False)


def label(ax: Axes, x: str = "", y: str = "", colour: str = "black") -> None:
    """Name the axes; y and its figures take the colour of the curve they belong to."""
    if x:
        ax.set_xlabel(x, fontsize=_FONT)
    if y:
        ax.set_ylabel(y, fontsize=_FONT, color=colour)
        ax.tick_params(axis="y", labelcolor=colour)


def explain(ax: Axes, handles: list[Any]) -> None:
    """Put the legend between the title and the axes, where it hides nothing."""
    ax.legend(
        handles=handles,
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=max(len(handles), 1),
        fontsize=_FONT - 1,
        frameon=False,
        borderaxespad=0.2,
        borderpad=0.1,
    )


def save(figure: Figure, path: Path) -> Path:
    """Write the figure as a PNG picture."""
    with replacing(path) as (temporary,):
        figure.savefig(temporary, format="png")
    return path
