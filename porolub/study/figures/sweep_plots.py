"""The figures of a sweep, drawn from its table alone."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from pathlib import Path

from matplotlib.figure import Figure

from porolub.errors import SceneError
from porolub.io.atomic import reported
from porolub.io.figure import save
from porolub.study.figures.draw_curves import draw_curves
from porolub.study.figures.draw_figure7 import draw_figure7
from porolub.study.figures.draw_map import MAPPED, draw_map
from porolub.study.figures.draw_stribeck import draw_stribeck
from porolub.study.figures.view import View
from porolub.study.work.journal import JOURNAL
from porolub.study.work.table import HDF5, read_table

MOST_MAPS = 12
_NAMES = ("stribeck", "figure7a", "figure7b", "curves", *(f"map_{name}" for name in MAPPED))
_log = logging.getLogger("porolub.study.plots")


def is_sweep_directory(directory: Path) -> bool:
    """Return whether a directory is the output of a sweep."""
    return (directory / JOURNAL).exists() or (directory / HDF5).exists()


def plot_sweep(directory: Path) -> list[Path]:
    """Draw what the table has data for and return the pictures' paths.

    stribeck.png: friction over the Sommerfeld number; of several axes a family of curves.
    figure7a.png, figure7b.png: as in the paper, of a single curve. curves.png: the main results
    over the one axis of numbers. map_<quantity>.png: over the first two axes of numbers. With
    further axes there is one map and one Stribeck figure for each combination of them,
    stribeck_01.png and so on, and of maps at most MOST_MAPS; log and the figures' titles say
    which. Pictures there is no data for are taken away.

    Raises SceneError where there is no table or it is damaged, and SolveError where a picture
    cannot be written.
    """
    if not (directory / HDF5).exists() and (directory / JOURNAL).exists():
        raise SceneError(
            f"{directory}: the sweep has not written its {HDF5} yet; run the same sweep again: "
            "it goes on where it was stopped."
        )
    view = View.of(read_table(directory))
    with reported(directory, "the figures"):
        paths = [save(figure, directory / name) for name, figure in figures(view)]
        for name in _NAMES:
            for path in (directory / f"{name}.png", *directory.glob(f"{name}_[0-9]*.png")):
                if path not in paths:
                    path.unlink(missing_ok=True)
    return paths


def figures(view: View) -> Iterator[tuple[str, Figure]]:
    """Yield the names and figures of a view, one at a time: there may be many."""
    numeric = view.numeric
    parts = view.slices(numeric[:2]) if len(numeric) > 1 else [view]
    for name, part in _numbered("stribeck", parts[:MOST_MAPS]):
        figure = draw_stribeck(part)
        if figure is not None:
            yield name, figure
    yield from draw_figure7(view).items()
    curves = draw_curves(view)
    if curves is not None:
        yield "curves.png", curves
    if len(numeric) > 1:
        yield from _maps(view, parts, (numeric[0], numeric[1]))


def _maps(view: View, parts: list[View], axes: tuple[int, int]) -> Iterator[tuple[str, Figure]]:
    """As many maps as are allowed, the most important quantity of all parts first."""
    wanted = [(name, part, quantity) for key, quantity in MAPPED.items()
              for name, part in _numbered(f"map_{key}", parts)]  # fmt: skip
    drawn, left_out = 0, 0
    for name, part, quantity in wanted:
        if drawn == MOST_MAPS:
            left_out += 1
            continue
        figure = draw_map(part, axes, quantity)
        if figure is not None:
            drawn += 1
            yield name, figure
    if left_out:
        _log.warning("%d of %d maps are left out: at most %d are drawn. table.csv has them all.",
                     left_out, len(wanted), MOST_MAPS)  # fmt: skip


def _numbered(name: str, parts: list[View]) -> Iterator[tuple[str, View]]:
    """Name the figures of several parts by number; their titles say what they are of."""
    digits = max(2, len(str(len(parts))))
    for n, part in enumerate(parts, start=1):
        yield (f"{name}.png" if len(parts) == 1 else f"{name}_{n:0{digits}d}.png"), part
