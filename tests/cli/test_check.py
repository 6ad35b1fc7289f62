"""``porolub check``: what a scene asks for and costs, without computing and without PETSc."""

import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from porolub.cli import app
from porolub.study.plan.sweep_file import is_sweep

JOBS = Path(__file__).parents[2] / "jobs"
CASE1 = str(JOBS / "case1.toml")


def output(*arguments: str) -> str:
    result = CliRunner().invoke(app, ["check", *arguments])
    assert result.exit_code == 0, result.stderr
    return result.stdout


def row(text: str, name: str) -> str:
    """Return the table row of that name as words."""
    lines = [line.replace("│", " ").split() for line in text.splitlines()]
    return next(" ".join(words) for words in lines if words[:1] == [name])


def test_it_shows_title_effects_unknowns_and_conventions() -> None:
    text = output(CASE1)
    assert text.startswith("Case 1: steady rotation under constant load")
    for name in ("solid", "pores", "carry", "film", "contact", "rotation", "load"):
        assert row(text, name).startswith(f"{name} yes")
    assert row(text, "friction_traction").startswith("friction_traction no")
    assert row(text, "displacement").endswith("73,322")
    assert row(text, "pore_pressure").endswith("9,331")
    assert row(text, "contact_pressure").endswith("601")
    assert row(text, "approach").endswith("1")
    assert row(text, "volume_change").endswith("9,331")
    assert row(text, "total").endswith("92,586")
    assert row(text, "surface_traction").startswith("surface_traction balanced")
    assert row(text, "entering").startswith("entering computed")
    assert "1.5 kN/m" in text
    assert "Peclet number over the thickness 73.6" in text


def test_a_dry_scene_shows_only_what_it_has() -> None:
    text = output(str(JOBS / "dry_contact.toml"))
    assert row(text, "pores") == "pores no nothing"
    assert row(text, "film") == "film no nothing"
    assert "pore_pressure" not in text
    assert "Conventions" not in text
    assert row(text, "total").endswith("10,536")


def test_overrides_are_shown() -> None:
    changes = ("mesh.along=10", "film=none", "load.force=3kN/m")
    text = output(CASE1, *(word for change in changes for word in ("--set", change)))
    assert row(text, "film") == "film no nothing"
    assert "3 kN/m" in text
    assert row(text, "contact_pressure").endswith("21")


def test_coarse_elements_are_pointed_out_unless_the_mesh_is_graded() -> None:
    hint = 'set mesh.grading = "contact"'
    assert hint in " ".join(output(CASE1).split())
    assert hint not in " ".join(output(str(JOBS / "case1_graded.toml")).split())


SHIPPED = sorted(JOBS.glob("*.toml"))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_shipped_file_passes(path: Path) -> None:
    assert ("all cases" if is_sweep(path) else "total") in output(str(path))


def test_it_loads_no_solver() -> None:
    code = (
        "import sys; from porolub.cli import app; "
        f"app(['check', {CASE1!r}], standalone_mode=False); "
        "loaded = {'petsc4py', 'mpi4py', 'gmsh', 'meshio', 'matplotlib'} & set(sys.modules); "
        "assert not loaded, loaded"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, timeout=60)
