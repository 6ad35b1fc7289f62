"""Figures 7a and 7b show a single curve's numbers; zeros and infinities are left out."""

import numpy as np
from matplotlib.figure import Figure

from porolub.study.figures.draw_figure7 import draw_figure7
from porolub.study.figures.view import View
from porolub.study.work.table import Table
from tests.study.made_up_sweeps import LOADS, axis, by_load, by_speed_and_load, case, made_up


def figures(table: Table) -> dict[str, Figure]:
    found = draw_figure7(View.of(table))
    for figure in found.values():
        figure.draw_without_rendering()
    return found


def curves(figure: Figure) -> dict[str, np.ndarray]:
    return {str(line.get_label()): np.asarray(line.get_xydata())
            for ax in figure.axes for line in ax.lines}  # fmt: skip


def known(column: np.ndarray) -> np.ndarray:
    """A column in the order of Sommerfeld number, the load's backward; without zeros."""
    column = column[::-1]
    return column[np.isfinite(column) & (column > 0)]


def heights(curve: np.ndarray) -> np.ndarray:
    return curve[np.isfinite(curve[:, 1]), 1]


def test_friction_and_load_ratio() -> None:
    table = by_load()
    figure = figures(table)["figure7a.png"]
    found = curves(figure)
    for name, key in (("friction coefficient μ", "friction_coefficient"),
                      ("friction coefficient of the film $μ_f$", "friction_fluid"),
                      ("load ratio $Γ = L_f/L_s$", "load_ratio")):  # fmt: skip
        np.testing.assert_allclose(heights(found[name]), known(table.columns[key]))
    assert figure.axes[1].get_ylabel() == "load ratio $Γ = L_f/L_s$"
    assert "Without contact there is no load ratio." in figure._supxlabel.get_text()


def test_lengths_in_micrometres_without_zeros() -> None:
    table = by_load(broken=[4])
    figure = figures(table)["figure7b.png"]
    found = curves(figure)
    for name, key in (("contact length b", "contact_length"),
                      ("penetration length $b_0$", "penetration_length"),
                      ("least film thickness $h_{min}$", "film_min"),
                      ("$|v_0|$, pressed in", "approach")):  # fmt: skip
        np.testing.assert_allclose(heights(found[name]), 1e6 * known(table.columns[key]))
    off = -1e6 * np.minimum(np.nan_to_num(table.columns["approach"]), 0.0)
    np.testing.assert_allclose(heights(found["$|v_0|$, standing off"]), known(off))
    assert figure.axes[0].get_ylabel() == "lengths [μm]"
    note = figure._supxlabel.get_text()
    assert "Zeros are not shown" in note
    assert "Left out of 9 cases: 1 failed." in note


def test_without_contact_there_is_no_axis_for_the_load_ratio() -> None:
    light = np.geomspace(1.0, 30.0, 5)
    table = made_up([axis("load", "load.force", tuple(light), "N/m", "log")],
                    [case(float(load)) for load in light])  # fmt: skip
    found = figures(table)
    assert len(found["figure7a.png"].axes) == 1
    assert "contact length b" not in curves(found["figure7b.png"])


def test_rounding_is_no_load_on_the_solid() -> None:
    cases = [case(load) for load in LOADS]
    for summary in cases:
        if summary["load_ratio"] is None:
            summary["load_ratio"] = 1e33
    table = made_up([axis("load", "load.force", LOADS, "N/m", "log")], cases)
    ratio = curves(figures(table)["figure7a.png"])["load ratio $Γ = L_f/L_s$"]
    assert heights(ratio).max() < 100


def test_rounding_is_no_film() -> None:
    cases = [case(load) for load in LOADS]
    for summary in cases:
        if summary["film_min"] == 0.0:
            summary["film_min"] = 1e-19
    table = made_up([axis("load", "load.force", LOADS, "N/m", "log")], cases)
    film = curves(figures(table)["figure7b.png"])["least film thickness $h_{min}$"]
    assert heights(film).min() > 1e-3


def test_a_family_has_no_figure_7() -> None:
    assert figures(by_speed_and_load()) == {}
