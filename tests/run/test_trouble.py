"""Transient runs that cannot go on: one sentence, the right exit code, what there is is kept."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from porolub.errors import SceneError, SolveError
from porolub.io.checkpoint import read_checkpoint
from porolub.io.fields import read_fields
from porolub.io.history import read_history
from porolub.run_transient import restart, run_transient
from porolub.scene import Scene, load_scene
from porolub.solve.options import set_options
from tests.run.output import JOBS
from tests.run.program import RUN, porolub
from tests.run.transient import CASE2, options, run, small

CRUSHED = """
geometry = {shape = "block", width = "4 mm", thickness = "1 mm"}
mesh = {along = 4, across = 4}
solid = {law = "neo-hookean", shear_modulus = "0.5 MPa", bulk_modulus = "2 MPa"}
time = {end = "1 s"}
[pores]
biot = 0.9
permeability = "1 um^3/mm"
viscosity = "1 mPa*s"
carry = false
[boundary.top]
pressure = "0 Pa"
displacement.y.times = ["0 s", "0.1 s", "100.0000001 ms"]
displacement.y.values = ["0 mm", "-0.1 mm", "-1.2 mm"]
"""
"""After 0.1 s the top is driven through the bottom, so fast that any step turns it inside out."""
PLACE = r"near x = -?[\d.]+ mm, y = -?[\d.]+ mm"
SENTENCE = (r"At t = 0\.1 s even a step of 1e-10 s fails: the volume ratio J fell to -.*, "
            rf"{PLACE}; try .* What was computed is in here\.$")


@pytest.fixture
def crushed(tmp_path: Path) -> Scene:
    (tmp_path / "scene.toml").write_text(CRUSHED)
    return load_scene(tmp_path / "scene.toml")


def test_a_crushed_layer_fails_with_time_place_and_advice(
    crushed: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SolveError, match=SENTENCE) as caught:
        run_transient(crushed, Path("here"), quiet=True)
    files = {path.name for path in Path("here").iterdir()}
    assert {"summary.json", "history.csv", "checkpoint.h5", "fields.h5", "fields.xdmf",
            "series.xdmf", "log.txt", "pressure.png", "scene.resolved.toml"} <= files
    summary = json.loads(Path("here/summary.json").read_text())
    assert summary["status"] == "failed"
    assert summary["message"] in str(caught.value)
    times = read_history(Path("here/history.csv"))["time"]
    assert times[-1] == summary["time"] == pytest.approx(0.1, rel=1e-6)
    state = read_checkpoint(Path("here/checkpoint.h5"))[0].states[0]
    assert state.time == pytest.approx(times[-1], rel=1e-12)
    found = read_fields(Path("here")).displacement
    nodes, values = state.fields["u"]
    np.testing.assert_allclose(found[nodes], values, atol=1e-18)
    # another try from there ends the same way
    with pytest.raises(SolveError, match=SENTENCE):
        restart(Path("here"), quiet=True)


def test_steps_that_shrink_to_nothing_are_a_failure(tmp_path: Path) -> None:
    """Slower, each step succeeds, but only ever shorter ones do."""
    (tmp_path / "scene.toml").write_text(CRUSHED.replace("100.0000001 ms", "100.00001 ms"))
    said = rf"At t = 0\.1 s the steps have shrunk to .*e-14 s: .*J is 0\.\d+, {PLACE}\); try "
    with pytest.raises(SolveError, match=said):
        run_transient(load_scene(tmp_path / "scene.toml"), tmp_path / "here", quiet=True)
    assert len(read_history(tmp_path / "here" / "history.csv")["time"]) < 1000


@pytest.mark.mpi
@pytest.mark.slow
def test_ranks_fail_together(run_mpi, crushed: Scene, tmp_path: Path) -> None:
    said = run_mpi(2, RUN, "run", "scene.toml", "--out", "here", "--quiet", code=3)
    (line,) = [line for line in said.splitlines() if line.startswith("porolub: ")]
    assert re.search(SENTENCE, line)
    assert (tmp_path / "here" / "checkpoint.h5").exists()


def test_a_solver_that_cannot_converge_is_a_failed_solve(crushed: Scene, tmp_path: Path) -> None:
    hopeless = "-ksp_type gmres -pc_type none -ksp_max_it 1"
    result = porolub("run", "scene.toml", "--out", "here", "--quiet", "--petsc", hopeless,
                     cwd=tmp_path)
    assert (result.returncode, result.stdout) == (3, "")
    (line,) = result.stderr.splitlines()
    assert line.startswith("porolub: The load could not be put on the layer at rest: the linear ")
    assert json.loads((tmp_path / "here" / "summary.json").read_text())["status"] == "failed"


FULL_DISK = """
import resource, sys
from mpi4py import MPI
from porolub.cli import main

limit = int(sys.argv.pop(1))
if MPI.COMM_WORLD.rank == 0:  # after MPI, whose files are larger
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
main()
"""


@pytest.mark.parametrize(
    ("frames", "limit", "what"),
    [
        (100, 30_000, r"here/frames/frame_0000\.h5: this file"),
        (0, 20_000, r"here/checkpoint\.h5: this file"),
        (0, 60_000, "here: the figures"),
    ],
)
def test_a_full_disk_is_one_sentence(tmp_path: Path, frames: int, limit: int, what: str) -> None:
    words = [limit, "run", CASE2, *options(f"time.frames={frames}"), "--out", "here", "--quiet"]
    result = subprocess.run(
        [sys.executable, "-c", FULL_DISK, *map(str, words)], cwd=tmp_path, timeout=60, check=False,
        env={**os.environ, "PYTHONPATH": str(JOBS.parent)}, capture_output=True, text=True)
    assert (result.returncode, result.stdout) == (3, "")
    said = rf"porolub: {what} cannot be written \(File too large\)\.\n"
    assert re.fullmatch(said, result.stderr)


def test_a_log_that_finds_no_space_is_not_talked_about(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "log.txt").symlink_to("/dev/full")
    run(tmp_path, small("time.end=1 ms"))
    assert capfd.readouterr() == ("", "")


@pytest.mark.mpi
def test_a_full_disk_stops_all_ranks_at_once(run_mpi, tmp_path: Path) -> None:
    words = [20_000, "run", CASE2, *options("time.frames=0"), "--out", "here", "--quiet"]
    said = run_mpi(2, FULL_DISK, *words, code=3)
    assert said.count("porolub: here/checkpoint.h5: this file cannot be written (File too") == 1
    assert "MPI_ABORT" not in said  # what ends ranks that wait in vain


def test_a_misspelt_option_of_the_steps_is_refused(tmp_path: Path) -> None:
    result = porolub("run", CASE2, *options(), "--out", "here", "--quiet",
                     "--petsc=-ts_adapt_tpye basic", cwd=tmp_path)
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr == ("porolub: --petsc -ts_adapt_tpye: no solver of this scene reads that "
                             "option; did you mean -ts_adapt_type?\n")


def test_an_option_of_the_steps_is_heeded(tmp_path: Path) -> None:
    result = porolub("run", CASE2, *options("time.end=10 ms"), "--out", "here", "--quiet",
                     "--petsc=-ts_adapt_dt_max 4e-4 -ts_adapt_monitor", cwd=tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    assert "TSAdapt basic" in result.stdout
    assert "-ts_adapt_dt_max 4e-4" in (tmp_path / "here" / "petsc.options").read_text()
    steps = read_history(tmp_path / "here" / "history.csv")["time_step"]
    assert steps.max() < 4e-4  # in the layer's own time, whose unit is less than a second


@pytest.mark.parametrize(
    ("option", "key"),
    [("-ts_bdf_order 3", "time.order"), ("-ts_type beuler", "time.order"),
     ("-ts_dt 1e-3", "time.first_step"), ("-ts_max_time 1", "time.end"),
     ("-ts_max_steps 3", "time.end"), ("-ts_atol 1e-6", "time.tolerance")])
def test_what_the_scene_says_is_no_option(option: str, key: str) -> None:
    with pytest.raises(SceneError) as caught:
        set_options(f"-ts_monitor {option}")
    assert str(caught.value) == (
        f"--petsc {option.split()[0]}: this is for the scene to say, by {key}.")
