"""Tables, sentences and figure of an accuracy study, from made-up results."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from rich.console import Console

from porolub.io.words import ONE
from porolub.study.accuracy.draw_precision import draw_precision
from porolub.study.accuracy.measured import Trial, measured
from porolub.study.accuracy.recommend import advise
from porolub.study.accuracy.strategies import Setting
from porolub.study.accuracy.study import Study
from porolub.study.accuracy.tables import (
    accuracy_table,
    advice_lines,
    error_text,
    percent,
    remarks,
)

LIMITS = {"friction_coefficient": 0.2, "load_fluid": 860.0}


def run(strategy: str, size: float, error: float, wall: float) -> Trial:
    setting = Setting(strategy, f"{300 / size:.0f} x 30", size, {},
                      (f"mesh.along={300 / size:.0f}", f"mesh.grading={strategy}"))  # fmt: skip
    summary = {name: limit * (1 + error) for name, limit in LIMITS.items()}
    estimate = {name: 2 * limit * abs(error) for name, limit in LIMITS.items()}
    return Trial(setting, "converged", wall=wall, unknowns=1e4 / size**2, steps=0.0, newton=9.0,
                 summary=summary | {"error_estimate": estimate})  # fmt: skip


def study(uniform: float = 0.08, graded: float = -0.02) -> Study:
    """Four levels of two strategies, of first and of second order; one run failed."""
    trials = [run("uniform", 2.0**-n, uniform * 0.5**n, 4.0**n) for n in range(4)]
    trials += [run("graded", 2.0**-n, graded * 0.25**n, 2 * 4.0**n) for n in range(4)]
    trials[1] = Trial(trials[1].setting, "failed", "no steady state")
    found = [m for name in LIMITS if (m := measured(name, trials)) is not None]
    return Study("made up", "jobs/a b.toml", ("mesh.along=7", "film.viscosity=1 cP"), ("mesh",), 2,
                 trials, found, advise(trials, found))  # fmt: skip


def printed(made_up: Study, number: int) -> list[list[str]]:
    """Cells of the table of a quantity, by row."""
    console = Console(width=120)
    with console.capture() as capture:
        console.print(accuracy_table(made_up, made_up.found[number]))
    return [line.split() for line in capture.get().splitlines() if line.strip()]


def test_each_setting_has_a_row() -> None:
    rows = printed(study(), 1)
    assert rows[0] == ["load_fluid", "[N/m]"]
    assert rows[1] == ["strategy", "mesh", "unknowns", "value", "error", "order", "estimate",
                       "ratio", "time"]  # fmt: skip
    assert rows[3] == ["uniform", "300", "x", "30", "10,000", "928.8", "8", "%", "16", "%", "2",
                       "1.00", "s"]  # fmt: skip
    assert rows[4] == ["600", "x", "30", "failed"]
    assert rows[7][:4] == ["graded", "300", "x", "30"]
    assert rows[9][-8:-4] == ["0.12", "%", "2.0", "0.25"]  # error, order, estimate


def test_an_error_below_what_is_known_is_said_to_be_such() -> None:
    made_up = study()
    limit = made_up.found[0]
    assert next(remarks(made_up, limit)) == (
        f"limit 0.2 +- {percent(limit.uncertain)}, from graded (order 2.0)"
    )
    swings = [run("graded", 2.0**-n, 0.001 * (-1) ** n, 1.0) for n in range(4)]
    found = measured("friction_coefficient", swings)
    assert found is not None
    assert error_text(found, 3, ONE) == error_text(found, 1, ONE) == "< 0.2 %"
    assert error_text(found, 0, ONE) == "0.2 %"
    assert "no order seen" in next(remarks(made_up, found))


def test_advice_is_a_command_without_a_key_twice() -> None:
    lines = list(advice_lines(study()))
    assert lines[0] == "Cheapest setting for friction_coefficient, load_fluid together:"
    assert lines[1].startswith("    10 %: uniform, 300 x 30: 1.00 s, error at most 8")
    assert lines[2].split() == ["porolub", "run", "'jobs/a", "b.toml'", "--set",
                                "'film.viscosity=1", "cP'", "--set", "mesh.along=300", "--set",
                                "mesh.grading=uniform"]  # fmt: skip
    assert lines[-1].endswith("2 cases ran side by side.")


def test_what_is_not_reached_is_said() -> None:
    lines = list(advice_lines(study(uniform=0.9, graded=-0.4)))
    (line,) = [text for text in lines if text.strip().startswith("0.1 %")]
    assert "not reached; the least that is sure is 0.69 %" in line
    assert [text for text in lines if text.strip().startswith("1 %")] != []


def test_strategies_that_disagree_are_told() -> None:
    made_up = study()
    trials = [*made_up.trials[:4]]
    trials += [run("graded", t.setting.size, (t.summary["load_fluid"] / 860 - 1) + 0.05, t.wall)
               for t in made_up.trials[4:]]  # fmt: skip
    trials[1] = run("uniform", 0.5, 0.04, 4.0)
    found = measured("load_fluid", trials)
    assert found is not None
    assert any("do not agree" in line for line in remarks(made_up, found))


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.123, "12 %"), (0.001, "0.1 %"), (3.1e-5, "0.0031 %"), (0.0, "0 %"), (1.1, "110 %")],
)
def test_errors_are_written_with_two_digits(value: float, text: str) -> None:
    assert percent(value) == text


def lines_of(figure: Figure, panel: int) -> list[np.ndarray]:
    return [np.asarray(line.get_xydata()) for line in figure.axes[panel].lines]


def test_the_figure_has_a_line_for_each_strategy() -> None:
    made_up = study()
    figure = draw_precision(made_up)
    figure.draw_without_rendering()
    assert len(figure.axes) == 4  # two quantities over time and unknowns
    assert [ax.get_xlabel() for ax in figure.axes] == ["wall time [s]"] * 2 + ["unknowns"] * 2
    assert all((ax.get_xscale(), ax.get_yscale()) == ("log", "log") for ax in figure.axes)
    uniform, graded = lines_of(figure, 0)
    assert len(uniform) == 3  # the failed run is left out
    np.testing.assert_allclose(graded[:, 0], [2, 8, 32, 128])
    found = made_up.found[0]
    np.testing.assert_allclose(uniform[:, 1], 100 * found.errors[[0, 2, 3]])
    assert graded[:, 1].min() >= 100 * found.uncertain  # less is not known
    assert [ax.get_title() for ax in figure.axes[:2]] == ["friction coefficient", "fluid load"]
    over_unknowns = lines_of(figure, 2)[1]
    np.testing.assert_allclose(over_unknowns[:, 0], 1e4 * 4.0 ** np.arange(4))
