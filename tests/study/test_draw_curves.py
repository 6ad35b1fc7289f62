"""Small multiples show the main results over the axis in handy units."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from porolub.study.figures.draw_curves import draw_curves
from porolub.study.figures.view import View
from porolub.study.work.table import Table
from tests.study.made_up_sweeps import (
    LOADS,
    axis,
    by_load,
    by_speed_and_load,
    case,
    categories,
    failed,
    made_up,
)


def panels(table: Table) -> tuple[Figure, dict[str, Axes]]:
    figure = draw_curves(View.of(table))
    assert figure is not None
    figure.draw_without_rendering()
    return figure, {ax.get_title(loc="left"): ax for ax in figure.axes if ax.lines}


def points(ax: Axes) -> list[np.ndarray]:
    return [np.asarray(line.get_xydata()) for line in ax.lines if line.get_marker() == "o"]


def test_results_over_the_load() -> None:
    table = by_load(broken=[1])
    figure, found = panels(table)
    assert list(found) == [
        "friction coefficients", "fluid share of the load", "approach $v_0$ [μm]",
        "least film thickness $h_{min}$ [μm]", "contact length [mm]", "highest pressure [kPa]",
        "flow through the surface [mg/(m s)]",
    ]  # fmt: skip
    good = table.columns["status"] == "converged"
    ax = found["least film thickness $h_{min}$ [μm]"]
    assert ax.get_xlabel() == "load [N/m]"
    assert ax.get_xscale() == "log"
    (curve,) = points(ax)
    np.testing.assert_allclose(curve[:, 0], np.array(LOADS)[good])
    np.testing.assert_allclose(curve[:, 1], 1e6 * table.columns["film_min"][good])
    flow_in, _ = points(found["flow through the surface [mg/(m s)]"])
    total = table.columns["inflow_left"] + table.columns["inflow_right"]
    np.testing.assert_allclose(flow_in[:, 1], 1e6 * total[good])
    assert "1 of 9 cases failed" in figure._supxlabel.get_text()


def test_a_sweep_by_approach_shows_the_load() -> None:
    cases = [case(load) for load in LOADS]
    values = tuple(summary["approach"] for summary in cases)
    _, found = panels(made_up([axis("approach", "load.approach", values, "m")], cases))
    assert "load L [N/m]" in found
    assert not [name for name in found if name.startswith("approach")]
    assert found["load L [N/m]"].get_yscale() == "log"
    assert found["load L [N/m]"].get_xlabel() == "approach [μm]"


def test_under_a_given_load_the_approach_is_shown() -> None:
    cases = [case(1500.0) | {"approach": approach} for approach in (3e-5, 4e-5, 5e-5)]
    values = axis("kappa", "pores.permeability", (1e-16, 1e-15, 1e-14), "m^2", "log")
    _, found = panels(made_up([values], cases))
    assert "approach $v_0$ [μm]" in found
    assert not [name for name in found if name.startswith("load")]
    assert found["approach $v_0$ [μm]"].get_xlabel() == "kappa [m²]"


def test_a_category_has_its_line() -> None:
    axes = [axis("load", "load.force", LOADS, "N/m", "log"),
            categories("base", "solid.base", ("sliding", "bonded"))]  # fmt: skip
    cases = [case(load * factor) for load in LOADS for factor in (1, 2)]
    figure, found = panels(made_up(axes, cases))
    assert len(points(found["fluid share of the load"])) == 2
    (legend,) = [ax.get_legend() for ax in figure.axes if not ax.axison and ax.get_legend()]
    assert [t.get_text() for t in legend.get_texts()] == ["base = sliding", "base = bonded"]


def test_categories_alone_stand_side_by_side() -> None:
    bases = categories("base", "solid.base", ("sliding", "bonded"))
    _, found = panels(made_up([bases], [case(10.0), case(1500.0)]))
    ax = found["fluid share of the load"]
    assert [t.get_text() for t in ax.get_xticklabels()] == ["sliding", "bonded"]
    assert all(line.get_linestyle() == "None" for line in ax.lines if line.get_marker() == "o")


@pytest.mark.parametrize("cases", [[failed()], [failed(), failed()], []])
def test_nothing_to_show_without_results(cases: list[dict[str, object]]) -> None:
    table = made_up([axis("load", "load.force", LOADS, "N/m", "log")], cases)
    assert draw_curves(View.of(table)) is None


def test_two_axes_of_numbers_are_a_map() -> None:
    assert draw_curves(View.of(by_speed_and_load())) is None
