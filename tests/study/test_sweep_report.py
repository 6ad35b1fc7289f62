"""``porolub check`` of a sweep: axes, cases, refusals and cost; ``porolub run`` declines it."""

from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console
from typer.testing import CliRunner

from porolub.cli import app
from porolub.study.plan.cases import cases_of
from porolub.study.plan.sweep_cost import STEPS, sweep_cost
from porolub.study.plan.sweep_report import report_sweep
from tests.scene.scenes import ROLLING, changed
from tests.study.sweeps import Tables, linear, log, sweep_of, write_sweep

FORCE = linear("load.force", "1 kN/m", "3 kN/m", 9)


def shown(directory: Path, *axes: Tables, base: Tables | None = None, **header: object) -> str:
    sweep = sweep_of(directory, *axes, base=base, **header)
    console = Console(width=80, file=StringIO())
    console.print(report_sweep(sweep, cases_of(sweep)))
    assert isinstance(console.file, StringIO)
    return console.file.getvalue()


def row(text: str, name: str) -> str:
    """Return the table row of that name as words."""
    lines = [line.replace("│", " ").split() for line in text.splitlines()]
    return next(" ".join(words) for words in lines if " ".join(words).startswith(name))


def test_it_shows_title_base_changes_and_axes(tmp_path: Path) -> None:
    viscosity = {"key": ["film.viscosity", "pores.viscosity"], "values": ["1 cP", "0.1 Pa*s"]}
    bases = {"key": "solid.base", "values": ["sliding", "bonded"]}
    text = shown(tmp_path, FORCE, viscosity, bases, title="Loads", set=["mesh.grading=contact"])
    assert text.startswith("Loads\n")
    assert "scene.toml" in text.replace("\n", "")  # a long path goes on in the next line
    assert "changed by: mesh.grading=contact" in text
    assert row(text, "force") == "force load.force 9, linear 1 kN/m, 1.25 kN/m,"
    assert "3 kN/m" in text
    assert row(text, "viscosity") == "viscosity film.viscosity 2, linear 1 mPa*s, 100 mPa*s"
    assert row(text, "pores.viscosity") == "pores.viscosity"
    assert row(text, "base solid") == "base solid.base 2, categories sliding, bonded"
    assert max(map(len, text.splitlines())) <= 80


def test_keys_with_values_of_their_own_are_shown_apart(tmp_path: Path) -> None:
    keys = ["solid.shear_modulus", "solid.bulk_modulus"]
    text = shown(tmp_path, {"key": keys, "values": [["1 MPa", "9 MPa"], ["2 MPa", "8 MPa"]]})
    assert row(text, "shear_modulus").endswith("2, linear 1 MPa, 2 MPa")
    assert row(text, "solid.bulk_modulus") == "solid.bulk_modulus 9 MPa, 8 MPa"


def test_cases_are_counted_by_where_they_start(tmp_path: Path) -> None:
    assert "9 cases: 2 from zero, 7 from neighbours' results." in shown(tmp_path, FORCE)
    cold = shown(tmp_path, FORCE, start="zero")
    assert "9 cases: 9 from zero, 0 from neighbours' results." in cold


def test_refused_cases_are_counted_and_the_first_are_named(tmp_path: Path) -> None:
    text = shown(tmp_path, linear("contact.friction", -1, 1, 11))
    assert "Refused, each a row of the table with its message: 5." in text
    assert "case 0, friction = -1: contact.friction = -1.0: the value must be at least 0." in text
    assert "contact.friction = -0.6" in text
    assert "contact.friction = -0.4" not in text
    assert "... and 2 more." in text


def test_where_all_are_refused_there_is_nothing_to_cost(tmp_path: Path) -> None:
    text = shown(tmp_path, {"key": "geometry.thickness", "values": ["-1 mm", "-2 mm"]})
    assert "table with its message: 2." in text
    assert "Expected cost" not in text


def test_the_cost_has_a_row_for_each_number_of_ranks_that_is_of_use(tmp_path: Path) -> None:
    few = shown(tmp_path, FORCE, ranks_per_case=2)
    assert row(few, "ranks per case") == "ranks per case 2"
    assert "all cases, 2 ranks" in few
    assert "32 ranks" not in few
    many = shown(tmp_path, linear("load.force", "1 kN/m", "3 kN/m", 20))
    assert "all cases, 1 rank " in many
    assert "all cases, 16 ranks" in many
    assert "128 ranks" not in many


def test_the_cost_ranges_over_the_meshes(tmp_path: Path) -> None:
    text = shown(tmp_path, linear("mesh.along", 100, 400, 4))
    low, high = row(text, "unknowns of a case").split()[-3::2]
    assert int(high.replace(",", "")) > 3.9 * int(low.replace(",", ""))


def test_steps_in_time_are_not_counted(tmp_path: Path) -> None:
    text = shown(tmp_path, FORCE, base=changed(ROLLING, time={"end": "1 s"}))
    assert "all cases" not in text
    assert "nobody can count their steps" in text


def test_the_total_is_the_sum_of_cases_one_after_another(tmp_path: Path) -> None:
    sweep = sweep_of(tmp_path, FORCE)
    cost = sweep_cost(cases_of(sweep), 1)
    assert cost is not None
    seconds = cost.step[0]
    steps = [2 * zero + 7 * warm for zero, warm in zip(*STEPS.values(), strict=True)]
    assert cost.wall[1] == pytest.approx([n * seconds for n in steps])


def test_side_by_side_cases_wait_for_those_they_start_from(tmp_path: Path) -> None:
    cost = sweep_cost(cases_of(sweep_of(tmp_path, linear("load.force", "1 N/m", "3 N/m", 17))), 1)
    assert cost is not None
    zero, warm = (steps[0] for steps in STEPS.values())
    assert cost.wall[16][0] == pytest.approx((zero + 4 * warm) * cost.step[0])  # four halvings


def test_check_and_run_tell_a_sweep_from_a_scene(tmp_path: Path) -> None:
    path = write_sweep(tmp_path, log("load.force", "1 N/m", "4 kN/m", 5), title="By load")
    checked = CliRunner().invoke(app, ["check", str(path), "--set", "mesh.along=20"])
    assert checked.exit_code == 0, checked.stderr
    assert checked.stdout.startswith("By load\n")
    assert "changed by: mesh.along=20" in checked.stdout
    scene = CliRunner().invoke(app, ["check", str(tmp_path / "scene.toml")])
    assert "Effects" in scene.stdout
    run = CliRunner().invoke(app, ["run", str(path)])
    assert run.exit_code == 2
    assert run.stderr == f"porolub: {path}: this is a sweep file; porolub sweep {path} runs it.\n"


def test_check_of_a_wrong_sweep_ends_with_a_sentence(tmp_path: Path) -> None:
    path = write_sweep(tmp_path, linear("load.froce", 1, 2, 3))
    result = CliRunner().invoke(app, ["check", str(path)])
    assert result.exit_code == 2
    assert "did you mean load.force?" in result.stderr
