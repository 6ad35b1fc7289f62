"""plot_sweep draws what a table has data for, and never fails on what sweeps come up with."""

import logging
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from matplotlib.image import imread
from typer.testing import CliRunner

from porolub.cli import app
from porolub.errors import SceneError
from porolub.study.figures.draw_map import MAPPED
from porolub.study.figures.sweep_plots import MOST_MAPS, figures, is_sweep_directory, plot_sweep
from porolub.study.figures.view import View
from porolub.study.work.table import Table, write_table
from tests.study.made_up_sweeps import (
    LOADS,
    MadeUp,
    Summary,
    axis,
    by_load,
    by_speed_and_load,
    case,
    categories,
    failed,
    made_up,
)

CURVE = ["stribeck.png", "figure7a.png", "figure7b.png", "curves.png"]
MAP = ["stribeck.png", *(f"map_{name}.png" for name in MAPPED)]


def names(table: Table) -> list[str]:
    """Names of the figures, which are laid out as for saving."""
    found = []
    for name, figure in figures(View.of(table)):
        figure.draw_without_rendering()
        found.append(name)
    return found


def write(directory: Path, converged: bool = True) -> None:
    rows = [{"case": n, "status": "converged" if converged else "failed", "message": "",
             "axes": {"load": load}, "regime": "mixed", "sommerfeld_number": 1e-4 / load,
             "summary": case(load) if converged else {}}
            for n, load in enumerate(LOADS)]  # fmt: skip
    loads = axis("load", "load.force", LOADS, "N/m", "log")
    write_table(directory, MadeUp("By load", (loads,)), rows)


def test_a_curve_and_a_map_have_their_figures() -> None:
    assert names(by_load()) == CURVE
    assert names(by_speed_and_load(broken=[3])) == MAP


def test_pictures_are_written_and_old_ones_go(tmp_path: Path) -> None:
    write(tmp_path)
    for old in ("map_film_min.png", "map_film_min_03.png", "stribeck_01.png", "figure7a.png"):
        (tmp_path / old).write_text("of an earlier sweep")
    (tmp_path / "mine.png").write_text("of the user")
    paths = plot_sweep(tmp_path)
    assert [path.name for path in paths] == CURVE
    assert {path.name for path in tmp_path.glob("*.png")} == {*CURVE, "mine.png"}
    for path in paths:
        assert imread(path).std() > 0.01


def test_all_failed_leaves_no_picture(tmp_path: Path) -> None:
    write(tmp_path, converged=False)
    assert plot_sweep(tmp_path) == []


def test_one_map_for_each_combination_of_further_axes(caplog: pytest.LogCaptureFixture) -> None:
    axes = [axis("speed", "motion.speed", (0.1, 1.0, 5.0), "rad/s", "log"),
            axis("load", "load.force", LOADS[::4], "N/m", "log"),
            axis("kappa", "pores.permeability", (1e-16, 1e-15), "m^2", "log"),
            categories("base", "solid.base", ("sliding", "bonded"))]  # fmt: skip
    speeds = [speed for speed in (0.1, 1.0, 5.0) for _ in range(12)]
    cases = [case(load, speed) for speed in (0.1, 1.0, 5.0) for load in LOADS[::4]
             for _ in range(4)]  # fmt: skip
    with caplog.at_level(logging.WARNING, "porolub"):
        found = list(figures(View.of(made_up(axes, cases, speeds))))
    maps = {name: figure for name, figure in found if name.startswith("map")}
    assert len(maps) == MOST_MAPS
    assert [name for name in maps if "friction" in name] == [
        f"map_friction_coefficient_0{n}.png" for n in range(1, 5)
    ]
    title = maps["map_friction_coefficient_02.png"].axes[0].get_title(loc="left")
    assert "kappa = 1e-16 m^2, base = bonded" in title
    assert len([name for name, _ in found if name.startswith("stribeck")]) == 4
    assert "8 of 20 maps are left out" in caplog.text


def test_names_of_the_user_are_no_formulas() -> None:
    axes = [axis("axis_of $\\alpha", "load.force", (1.0, 10.0, 100.0), "N/m", "log"),
            categories("paid in $", "solid.base", ("$", "$\\frac", "100 %"))]  # fmt: skip
    cases = [case(load) for load in (1.0, 10.0, 100.0) for _ in range(3)]
    assert names(made_up(axes, cases, title="$\\title$")) == ["stribeck.png", "curves.png"]
    one = categories("paid in $", "solid.base", ("$", "$\\frac", "100 %"))
    assert names(made_up([one], cases[::3])) == ["stribeck.png", "curves.png"]


def test_no_sweep_no_pictures(tmp_path: Path) -> None:
    assert not is_sweep_directory(tmp_path)
    with pytest.raises(SceneError, match="this is no output of a sweep"):
        plot_sweep(tmp_path)
    (tmp_path / "journal.jsonl").touch()
    assert is_sweep_directory(tmp_path)
    with pytest.raises(SceneError, match="run the same sweep again"):
        plot_sweep(tmp_path)


def test_the_command_knows_a_sweep(tmp_path: Path) -> None:
    write(tmp_path)
    found = CliRunner().invoke(app, ["plot", str(tmp_path)])
    assert found.exit_code == 0
    assert [Path(line).name for line in found.output.split()] == CURVE


@pytest.mark.parametrize("option", [["--period", "2"], ["--animate"]])
def test_a_sweep_has_no_periods(tmp_path: Path, option: list[str]) -> None:
    write(tmp_path)
    found = CliRunner().invoke(app, ["plot", str(tmp_path), *option])
    assert found.exit_code == 2
    assert f"{option[0]}: this is for runs" in found.output


NUMBERS = st.sampled_from([0.0, -1.0, 1e-30, 1e30, 5e-324, np.nan, np.inf, None]) | st.floats(
    -1e6, 1e6, allow_subnormal=False
)
KEYS = ("load_total", "load_fluid", "load_ratio", "friction_coefficient", "friction_fluid",
        "approach", "film_min", "contact_length", "penetration_length", "inflow_left",
        "pressure_max", "contact_pressure_max")  # fmt: skip
ODD = st.one_of(
    st.just(failed()),
    st.dictionaries(st.sampled_from(KEYS), NUMBERS).map(lambda odd: case(50.0) | odd),
    st.floats(0.5, 5000.0).map(case),
)
AXES: list[list[Any]] = [
    [axis("load", "load.force", LOADS, "N/m", "log")],
    [axis("approach", "load.approach", (-1e-5, 0.0, 1e-5, 5e-5), "m")],
    [axis("speed", "motion.speed", (1.0, 2.0, 3.0), "rad/s"),
     axis("load", "load.force", (1.0, 10.0, 100.0), "N/m", "log")],
    [categories("base", "solid.base", ("sliding", "bonded")),
     axis("angle", "geometry.half_angle", (0.01, 0.05, 0.1), "rad")],
    [categories("law", "solid.law", ("linear", "neo-hookean"))],
]  # fmt: skip
WORST: list[Summary] = [case(50.0) | dict.fromkeys(KEYS, value)
                        for value in (None, 0.0, -1.0, np.inf, 1e-30)]  # fmt: skip


@settings(max_examples=15)
@example(AXES[0], [case(50.0)])
@example(AXES[0], [case(50.0)] * 9)
@example(AXES[0], [case(50.0) | {"friction_coefficient": -0.1}] * 9)
@example(AXES[2], [case(50.0)] * 9)
@example(AXES[2], [*WORST, *WORST])
@example(AXES[2], [])
@example(AXES[2], [case(50.0) | {"film_min": film} for film in (-1.0, 0.0, 0.0, 0.0, 0.0)])
@given(st.sampled_from(AXES), st.lists(ODD, max_size=9))
def test_figures_never_fail(axes: list[Any], cases: list[Summary]) -> None:
    assert set(names(made_up(axes, cases))) <= {*CURVE, *MAP}
