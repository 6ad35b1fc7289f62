"""Stribeck curves show the table's friction, regimes and minimum, and say what they leave out."""

from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from porolub.study.figures.draw_regimes import COLOURS
from porolub.study.figures.draw_stribeck import draw_stribeck, stribeck_lines
from porolub.study.figures.view import View
from porolub.study.work.regimes import CRITERIA, REGIMES
from porolub.study.work.table import Table
from tests.study.made_up_sweeps import (
    LOADS,
    SPEEDS,
    axis,
    by_load,
    by_speed_and_load,
    case,
    categories,
    failed,
    made_up,
)


def drawn(table: Table) -> tuple[Figure, Axes]:
    figure = draw_stribeck(View.of(table))
    assert figure is not None
    figure.draw_without_rendering()
    return figure, figure.axes[0]


def joined(ax: Axes) -> list[np.ndarray]:
    """The lines that join points, (n, 2) each."""
    return [np.asarray(line.get_xydata()) for line in ax.lines if line.get_linestyle() == "-"]


def words(figure: Figure) -> str:
    legend = figure.axes[0].get_legend()
    texts = [t.get_text() for t in (*figure.axes[0].texts, *(legend.get_texts() if legend else ()))]
    note = figure._supxlabel
    return "\n".join([*texts, note.get_text() if note is not None else ""])


def bands(ax: Axes) -> dict[str, tuple[float, float]]:
    """From where to where on the width of the axes a regime goes."""
    names = {to_rgba(colour)[:3]: regime for regime, colour in COLOURS.items()}
    return {names[p.get_facecolor()[:3]]: (p.get_x(), p.get_x() + p.get_width())
            for p in ax.patches if isinstance(p, Rectangle)}  # fmt: skip


def test_one_curve_in_the_order_of_the_sommerfeld_number() -> None:
    table = by_load()
    _, ax = drawn(table)
    (curve,) = joined(ax)
    number = table.columns["sommerfeld_number"]
    order = np.argsort(number)
    np.testing.assert_allclose(curve[:, 0], number[order])
    np.testing.assert_allclose(curve[:, 1], table.columns["friction_coefficient"][order])
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")


def test_bands_change_half_way_between_cases() -> None:
    table = by_load()
    _, ax = drawn(table)
    found = bands(ax)
    assert list(found) == list(reversed(REGIMES))
    ends = [found[r] for r in reversed(REGIMES)]
    assert ends[0][0] == 0
    assert ends[-1][1] == 1
    number, regimes = table.columns["sommerfeld_number"], table.columns["regime"]
    for (_, right), (left, _), one, other in zip(
        ends, ends[1:], reversed(REGIMES), list(reversed(REGIMES))[1:], strict=False
    ):
        assert left == pytest.approx(right)
        middle = np.sqrt(number[regimes == one].max() * number[regimes == other].min())
        at = ax.transAxes.inverted().transform(ax.transData.transform((middle, 1.0)))[0]
        assert right == pytest.approx(at, abs=1e-9)


def test_legend_says_what_regimes_ask_for() -> None:
    figure, _ = drawn(by_load())
    for regime in REGIMES:
        assert f"{regime}: {CRITERIA[regime]}" in words(figure)


def test_the_minimum_is_marked_with_its_value() -> None:
    table = by_load()
    figure, ax = drawn(table)
    friction = table.columns["friction_coefficient"]
    least = int(np.argmin(friction))
    assert f"minimum μ = {friction[least]:#.4g} at $" in words(figure)
    (ring,) = (line for line in ax.lines if line.get_markersize() == 15)
    np.testing.assert_allclose(
        ring.get_xydata()[0], [table.columns["sommerfeld_number"][least], friction[least]]
    )


def test_failed_cases_are_left_out_and_counted() -> None:
    figure, ax = drawn(by_load(broken=[2, 5]))
    assert len(joined(ax)[0]) == len(LOADS) - 2
    assert "Left out of 9 cases: 2 failed." in words(figure)


def test_cases_without_friction_are_counted() -> None:
    cases = [case(load) for load in LOADS]
    cases[3]["friction_coefficient"] = -0.1
    cases[4]["friction_coefficient"] = None
    loads = axis("load", "load.force", LOADS, "N/m", "log")
    figure, ax = drawn(made_up([loads], [*cases[:8], failed()]))
    assert len(joined(ax)[0]) == 6
    assert "Left out of 9 cases: 1 failed, 2 without load, film or friction." in words(figure)


def test_of_two_axes_there_is_a_family_coloured_by_the_slower() -> None:
    figure, ax = drawn(by_speed_and_load())
    curves = joined(ax)
    assert len(curves) == len(SPEEDS)
    assert all((np.diff(curve[:, 0]) > 0).all() for curve in curves)
    assert figure.axes[1].get_ylabel() == "speed [rad/s]"
    colours = {line.get_color() for line in ax.lines if line.get_linestyle() == "-"}
    assert len(colours) == len(SPEEDS)
    assert "(speed = 1.5 rad/s)" in words(figure)
    assert not bands(ax)


def test_lines_run_along_the_axis_that_changes_the_sommerfeld_number() -> None:
    """Permeability does not: the curves run along the load, though it is the slower axis."""
    axes = [axis("load", "load.force", LOADS, "N/m", "log"),
            axis("permeability", "pores.permeability", (1e-16, 1e-15), "m^2", "log")]  # fmt: skip
    table = made_up(axes, [case(load) for load in LOADS for _ in range(2)])
    lines = stribeck_lines(View.of(table))
    assert [len(line.rows) for line in lines] == [len(LOADS)] * 2
    assert [line.name for line in lines] == ["permeability = 1e-16 m^2", "permeability = 1e-15 m^2"]


def test_a_category_has_a_line_and_a_name_in_the_legend() -> None:
    axes = [axis("load", "load.force", LOADS, "N/m", "log"),
            categories("base", "solid.base", ("sliding", "bonded"))]  # fmt: skip
    table = made_up(axes, [case(load) for load in LOADS for _ in range(2)])
    figure, ax = drawn(table)
    assert len(joined(ax)) == 2
    assert "base = sliding" in words(figure)
    assert "base = bonded" in words(figure)


@pytest.mark.parametrize(
    "cases",
    [
        [case(10.0)],
        [case(10.0), case(10.0)],
        [failed(), failed(), failed()],
        [case(10.0), failed()],
        [case(10.0), case(20.0) | {"friction_coefficient": 0.0}],
    ],
)
def test_one_point_is_no_curve(cases: list[dict[str, Any]]) -> None:
    moduli = axis("modulus", "solid.shear_modulus", (1e5, 2e5, 3e5), "Pa")
    assert draw_stribeck(View.of(made_up([moduli], cases))) is None
