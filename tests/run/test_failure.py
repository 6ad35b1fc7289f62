"""A scene without a steady state: exit code 3, a sentence, and what was computed is kept."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from porolub.errors import SolveError
from porolub.io.fields import read_fields
from porolub.run import run_scene
from porolub.scene import load_scene
from tests.run.output import JOBS, shipped
from tests.run.program import porolub, small

CRUSHED = ["--set", "load.force=10 MN/m"]  # thousands of moduli over the whole surface


def test_it_exits_with_3_and_one_sentence_that_says_what_and_where(tmp_path: Path) -> None:
    result = porolub("run", JOBS / "dry_contact.toml", *small(), *CRUSHED, "--quiet", "--out",
                     "here", cwd=tmp_path)
    assert (result.returncode, result.stdout) == (3, "")
    (line,) = result.stderr.splitlines()
    assert line.startswith("porolub: The steady solve failed: ")
    assert re.search(r"no convergence in \d+ Newton iterations|volume ratio J fell to", line)
    assert re.search(r"near x = -?[\d.]+ mm, y = -?[\d.]+ mm", line)
    assert line.endswith("What was computed is in here.")


def test_all_files_are_kept_and_say_that_it_failed(tmp_path: Path) -> None:
    with pytest.raises(SolveError) as caught:
        run_scene(shipped("dry_contact", 24, 3, "load.force=10 MN/m"), tmp_path, quiet=True)
    files = {path.name for path in tmp_path.iterdir()}
    assert {"summary.json", "fields.h5", "fields.xdmf", "surface.csv", "history.csv",
            "checkpoint.h5", "log.txt", "scene.resolved.toml"} <= files
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["status"] == "failed"
    assert summary["message"] in str(caught.value)
    assert summary["newton_iterations"] > 0
    assert np.isfinite(read_fields(tmp_path).displacement).all()
    assert "updates: u " in (tmp_path / "log.txt").read_text()


def test_a_failure_does_not_spoil_the_next_run(tmp_path: Path) -> None:
    with pytest.raises(SolveError):
        run_scene(shipped("dry_contact", 24, 3, "load.force=10 MN/m"), tmp_path, quiet=True)
    assert run_scene(shipped("dry_contact", 24, 3), tmp_path, quiet=True) == 0
    assert json.loads((tmp_path / "summary.json").read_text())["status"] == "converged"


def test_a_scene_the_mesh_refuses_is_bad_input(tmp_path: Path) -> None:
    """Conditions that contradict each other at a corner are found when the model is built."""
    scene = tmp_path / "scene.toml"
    scene.write_text("""
        geometry = {shape = "block", width = "4 mm", thickness = "1 mm"}
        mesh = {along = 4, across = 2}
        solid = {law = "linear", shear_modulus = "1 MPa", bulk_modulus = "2 MPa"}
        [boundary]
        left = {displacement = {y = "0 mm"}}
        top = {displacement = {y = "0.1 mm"}}
    """)
    load_scene(scene)
    result = porolub("run", scene, "--out", "here", cwd=tmp_path)
    assert result.returncode == 2
    assert result.stderr.startswith("porolub: Boundary conditions contradict each other at ")


@pytest.mark.mpi
def test_ranks_fail_together_and_one_of_them_says_so(run_mpi, tmp_path: Path) -> None:
    arguments = ["run", JOBS / "dry_contact.toml", *small(), *CRUSHED, "--quiet", "--out", "here"]
    output = run_mpi(2, "from porolub.cli import main; main()", *arguments, code=3)
    assert output.count("The steady solve failed") == 1
    assert json.loads((tmp_path / "here" / "summary.json").read_text())["ranks"] == 2
