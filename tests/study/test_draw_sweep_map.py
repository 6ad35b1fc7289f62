"""Maps show the table's values over two axes, where regimes meet, and failures as holes."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure

from porolub.study.figures.draw_map import draw_map
from porolub.study.figures.draw_quantities import (
    CONTACT_LENGTH,
    FILM_MIN,
    FLUID_SHARE,
    FRICTION,
    PRESSURE_MAX,
    Quantity,
)
from porolub.study.figures.map_grid import Grid, roomiest
from porolub.study.figures.view import View
from porolub.study.work.regimes import REGIMES
from porolub.study.work.table import Table
from tests.study.made_up_sweeps import (
    LOADS,
    SPEEDS,
    axis,
    by_speed_and_load,
    case,
    failed,
    made_up,
)


def drawn(table: Table, quantity: Quantity = FRICTION) -> tuple[Figure, Axes]:
    figure = draw_map(View.of(table), (0, 1), quantity)
    assert figure is not None
    figure.draw_without_rendering()
    return figure, figure.axes[0]


def marks(ax: Axes, marker: str) -> set[tuple[float, float]]:
    return {(float(x), float(y)) for line in ax.lines if line.get_marker() == marker
            for x, y in line.get_xydata()}  # fmt: skip


def colour_at(ax: Axes, x: float, y: float) -> tuple[float, ...] | None:
    """Colour of the topmost filled contour at a point, None where there is none."""
    sets = [c for c in ax.collections if isinstance(c, QuadContourSet) and c.filled]
    for contours in sorted(sets, key=lambda c: -c.get_zorder()):
        for path, colour in zip(contours.get_paths(), contours.get_facecolor(), strict=True):
            if len(path.vertices) and path.contains_point((x, y)):
                return tuple(colour)
    return None


def test_axes_are_those_of_the_sweep_and_each_case_has_a_point() -> None:
    figure, ax = drawn(by_speed_and_load())
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("speed [rad/s]", "load [N/m]")
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert marks(ax, "o") == {(speed, load) for speed in SPEEDS for load in LOADS}
    assert figure.axes[1].get_ylabel() == "friction coefficient μ"


def test_between_the_cases_values_are_linear_on_paper() -> None:
    view = View.of(by_speed_and_load())
    grid = Grid.of(view, 0, 1)
    values = 3.0 + np.log10(view.along(0)) - 2.0 * np.log10(view.along(1))
    x, y, found = grid.finer(values)
    np.testing.assert_allclose(found, 3.0 + np.log10(x)[None, :] - 2.0 * np.log10(y)[:, None])
    assert set(SPEEDS) <= set(np.round(x, 12))


def test_values_in_falling_order_are_turned() -> None:
    axes = [axis("speed", "motion.speed", SPEEDS[::-1], "rad/s", "log"),
            axis("load", "load.force", LOADS, "N/m", "log")]  # fmt: skip
    cases = [case(load, speed) for speed in SPEEDS[::-1] for load in LOADS]
    view = View.of(made_up(axes, cases))
    on_grid = Grid.of(view, 0, 1).on_grid(view.values(PRESSURE_MAX))
    expected = [[case(load, speed)["pressure_max"] for speed in SPEEDS] for load in LOADS]
    np.testing.assert_allclose(on_grid, expected)


def test_a_failed_case_is_a_cross_in_a_hole() -> None:
    broken = 1 * len(LOADS) + 4
    _, ax = drawn(by_speed_and_load(broken=[broken]))
    assert marks(ax, "x") == {(SPEEDS[1], LOADS[4])}
    assert colour_at(ax, SPEEDS[1], LOADS[4]) is None
    beside = float(np.sqrt(SPEEDS[2] * SPEEDS[3])), float(np.sqrt(LOADS[4] * LOADS[5]))
    assert colour_at(ax, *beside) is not None
    assert "failed (1)" in [t.get_text() for t in ax.get_legend().get_texts()]


def test_regimes_are_named_in_their_place() -> None:
    view = View.of(by_speed_and_load())
    figure, ax = drawn(by_speed_and_load())
    named = {t.get_text(): t.get_position() for t in ax.texts if t.get_text() in REGIMES}
    assert len(named) >= 3
    for name, (x, y) in named.items():
        distance = np.hypot(np.log(view.along(0) / x) / np.log(60), np.log(view.along(1) / y) / 8)
        assert view.regime[np.argmin(distance)] == name
    assert "mixed: contact" in figure._supxlabel.get_text()


def test_contact_has_no_film_and_its_edge_is_half_way() -> None:
    _, ax = drawn(by_speed_and_load(), FILM_MIN)
    grey = colour_at(ax, 0.2, 1000.0)
    assert grey == pytest.approx((0.902, 0.902, 0.902, 1.0), abs=1e-3)
    column = [case(load, SPEEDS[2])["film_min"] for load in LOADS]
    first = column.index(0.0)
    edge = np.sqrt(LOADS[first - 1] * LOADS[first])
    assert colour_at(ax, SPEEDS[2], 1.02 * edge) == grey
    assert colour_at(ax, SPEEDS[2], edge / 1.02) != grey
    assert "contact: no film" in [t.get_text() for t in ax.get_legend().get_texts()]


def test_levels_cover_all_values() -> None:
    for quantity in (FRICTION, FLUID_SHARE, FILM_MIN, CONTACT_LENGTH, PRESSURE_MAX):
        view = View.of(by_speed_and_load())
        figure, _ = drawn(by_speed_and_load(), quantity)
        ticks = [float(t.get_text()) for t in figure.axes[1].get_yticklabels()]
        values = view.values(quantity) / view.unit(quantity).size
        assert max(ticks) >= np.nanmax(values)
        assert min(ticks) <= np.nanmin(values[values > 0])
        assert (np.diff(ticks) > 0).all()


@pytest.mark.parametrize("converged", [0, 1, 2, 3])
def test_three_cases_span_no_area(converged: int) -> None:
    axes = [axis("speed", "motion.speed", (0.1, 1.0), "rad/s", "log"),
            axis("load", "load.force", (10.0, 100.0), "N/m", "log")]  # fmt: skip
    cases = [case(10.0 * 3**n) for n in range(converged)] + [failed()] * (4 - converged)
    assert draw_map(View.of(made_up(axes, cases)), (0, 1), FRICTION) is None


def test_what_is_the_same_everywhere_is_no_map() -> None:
    axes = [axis("speed", "motion.speed", (0.1, 1.0), "rad/s", "log"),
            axis("load", "load.force", (10.0, 100.0), "N/m", "log")]  # fmt: skip
    view = View.of(made_up(axes, [case(10.0)] * 4))
    assert draw_map(view, (0, 1), FRICTION) is None


def test_room_for_a_name() -> None:
    mask = np.zeros((400, 400), bool)
    assert roomiest(mask) is None
    mask[100:300, 50:350] = True
    assert roomiest(mask) == (pytest.approx(200, abs=110), pytest.approx(200, abs=160))
    mask[:] = False
    mask[200:202] = True  # as thin as a line
    assert roomiest(mask) is None
