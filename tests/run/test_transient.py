"""A scene with [time] from the command line: the files, what they say of each other, the ranks."""

import json
import math
import re
from pathlib import Path

import meshio
import numpy as np
import pytest

from porolub.io.checkpoint import read_checkpoint
from porolub.io.directory import HISTORY_PLOTS, PLOTS
from porolub.io.frames import read_frames
from porolub.io.summary import KEYS
from porolub.scene import load_scene, scene_from_dict
from tests.run.output import Output
from tests.run.program import RUN, porolub
from tests.run.test_contract import FILES, TABLES, TEXTS
from tests.run.transient import (
    BALANCED,
    BALANCES,
    CASE2,
    COUNTED,
    no_remains,
    options,
    run,
    same_history,
    small,
)

FROM_REST = """
[geometry]
shape = "sector"
outer_radius = "100 mm"
thickness = "1 mm"
half_angle = "5 deg"
[mesh]
along = 20
across = 2
[solid]
law = "neo-hookean"
shear_modulus = "0.5 MPa"
bulk_modulus = "5 MPa"
[pores]
biot = 0.9
permeability = "1 um^3/mm"
viscosity = "1 mPa*s"
[film]
viscosity = "1 mPa*s"
[contact]
friction = 0.45
[load]
force = "0.5 kN/m"
[time]
end = "1 s"
"""
"""A plane put on a layer at rest: no motion, so the run starts undeformed."""


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> tuple[Output, str]:
    """A run of the program whose output goes into a pipe, and what it printed."""
    directory = tmp_path_factory.mktemp("transient")
    result = porolub("run", CASE2, *options(), "--out", "here", cwd=directory)
    assert (result.returncode, result.stderr) == (0, "")
    return Output(directory / "here", small()), result.stdout


@pytest.fixture(scope="module")
def done(finished: tuple[Output, str]) -> Output:
    return finished[0]


def test_every_file_is_there_and_none_is_empty(done: Output) -> None:
    found = {path.name: path for path in done.directory.iterdir()}
    assert set(found) == FILES | {*PLOTS, *HISTORY_PLOTS, "frames", "series.xdmf"}
    assert all(path.stat().st_size > 0 for path in done.directory.rglob("*"))
    no_remains(done.directory)
    assert load_scene(found["scene.resolved.toml"]).digest() == done.scene.digest()


def test_the_summary_has_every_key_and_every_number_is_one(done: Output) -> None:
    assert list(done.summary)[: len(KEYS)] == list(KEYS)
    for key in set(KEYS) - TEXTS - TABLES:
        assert isinstance(done.summary[key], int | float), key
        assert math.isfinite(done.summary[key]), key
    assert (done.summary["status"], done.summary["message"]) == ("converged", "reached the end")
    assert done.summary["effects"] == [
        "solid", "pores", "carry", "film", "squeeze", "contact", "rotation", "load", "time"]
    assert done.summary["time"] == 0.06
    assert all(done.summary[key] < BALANCED for key in BALANCES)
    assert done.summary["linear_iterations"] >= done.summary["newton_iterations"]


def test_a_row_for_the_start_and_one_for_each_accepted_step(done: Output) -> None:
    rows = done.history
    assert len(rows) == 1 + done.summary["time_steps"] > 10
    times = [row["time"] for row in rows]
    assert (times[0], times[-1]) == (0.0, 0.06)
    np.testing.assert_allclose(np.diff(times), [row["time_step"] for row in rows[1:]], rtol=1e-9)
    for key in ("newton_iterations", "rejected_steps"):
        assert sum(row[key] for row in rows) == done.summary[key]
    assert max(row["load_balance_error"] for row in rows) == done.summary["load_balance_error"]
    applied = [1500.0 + 750.0 * math.sin(2 * math.pi * t) for t in times]
    np.testing.assert_allclose([row["load_total"] for row in rows], applied, rtol=1e-8)


def test_the_last_row_is_the_summary(done: Output) -> None:
    last = done.history[-1]
    shared = last.keys() & done.summary.keys() - BALANCES - COUNTED
    assert len(shared) > 18
    assert {key: last[key] for key in shared} == {key: done.summary[key] for key in shared}
    assert done.surface.p_c.max() == pytest.approx(last["contact_pressure_max"], rel=1e-12)


def test_the_pictures_are_a_series_that_others_read(done: Output) -> None:
    frames = read_frames(done.directory)
    times = [row["time"] for row in done.history]
    due = [0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06]
    expected = [min(t for t in times if t >= moment * (1 - 1e-9)) for moment in due]
    assert list(frames.times) == sorted(set(expected))
    with meshio.xdmf.TimeSeriesReader(done.directory / "series.xdmf") as reader:
        reader.read_points_cells()
        assert reader.num_steps == len(frames)
        time, points, _ = reader.read_data(len(frames) - 1)
    assert time == 0.06
    np.testing.assert_allclose(points["p"], done.fields.pressure, rtol=1e-6, atol=1e-3)
    mesh = meshio.read(done.directory / "fields.xdmf")
    np.testing.assert_array_equal(mesh.point_data["p"], done.fields.pressure)


def test_the_checkpoint_is_of_the_last_step(done: Output) -> None:
    resume, tables = read_checkpoint(done.directory / "checkpoint.h5")
    assert tables == done.scene.resolved()
    assert resume.states[0].time == pytest.approx(0.06, rel=1e-14)
    nodes, values = resume.states[0].fields["u"]
    np.testing.assert_allclose(values, done.fields.displacement[nodes], atol=1e-18)
    assert resume.totals["time_steps"] == done.summary["time_steps"]


def test_into_a_pipe_goes_one_plain_line_a_step(finished: tuple[Output, str]) -> None:
    done, printed = finished
    shown = re.findall(r"^(\d+) +([\d.e-]+) +[\d.e-]+ +2 +\d+ +\d+ .*$", printed, re.MULTILINE)
    steps = [(str(k), f"{row['time']:.9g}") for k, row in enumerate(done.history)]
    assert shown == steps[1:]
    assert "\x1b" not in printed
    assert "friction coefficient" in printed
    log = (done.directory / "log.txt").read_text()
    assert all(f" {number:<6}  {time:>12}  " in log for number, time in shown)


def test_a_run_from_rest_without_a_word(tmp_path: Path) -> None:
    """Fluid carries the load at first, then the plane comes through it and the solid takes over."""
    (tmp_path / "scene.toml").write_text(FROM_REST)
    result = porolub("run", "scene.toml", "--out", "here", "--quiet", cwd=tmp_path)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    found = Output(tmp_path / "here", load_scene(tmp_path / "scene.toml"))
    rows = found.history
    assert 0.0 < rows[0]["time"] < 1e-5
    assert rows[-1]["time"] == 1.0
    assert rows[0]["load_fluid"] == pytest.approx(500.0, rel=1e-8)
    assert rows[0]["contact_length"] == 0.0
    assert rows[-1]["load_solid"] > 100.0
    assert rows[-1]["contact_length"] > 4e-3
    assert (np.diff([row["approach"] for row in rows]) > 0.0).all()
    assert found.summary["mass_balance_error"] < BALANCED
    assert found.summary["load_balance_error"] < BALANCED


def test_rounding_does_not_move_the_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps are counted in the layer's own time: 111 of them added up to 1 - 1e-16 s."""
    monkeypatch.setattr("porolub.io.plots.plot_directory", lambda directory: [])
    traction = {"mean": "1 kPa", "amplitude": "0.5 kPa", "frequency": "2 Hz", "shape": "sine"}
    scene = scene_from_dict({
        "geometry": {"shape": "block", "width": "4 mm", "thickness": "1 mm"},
        "mesh": {"along": 2, "across": 2}, "time": {"end": "1 s"},
        "solid": {"law": "linear", "shear_modulus": "0.5 MPa", "bulk_modulus": "2 MPa"},
        "pores": {"biot": 0.9, "permeability": "1 um^3/mm", "viscosity": "1 mPa*s",
                  "carry": False},
        "boundary": {"top": {"traction": traction, "pressure": "0 Pa"}}})
    found = run(tmp_path, scene)
    assert found.history[-1]["time"] == found.summary["time"] == 1.0


@pytest.mark.mpi
@pytest.mark.parametrize("ranks", [2, pytest.param(4, marks=pytest.mark.slow)])
def test_ranks_take_the_same_steps(run_mpi, done: Output, tmp_path: Path, ranks: int) -> None:
    printed = run_mpi(ranks, RUN, "run", CASE2, *options(), "--out", "here")
    same_history(done.directory, tmp_path / "here")
    summary = json.loads((tmp_path / "here" / "summary.json").read_text())
    assert summary["ranks"] == ranks
    for key in ("time_steps", "rejected_steps", "newton_iterations"):
        assert summary[key] == done.summary[key]
    assert "\x1b" not in printed  # mpirun gives its ranks a terminal that is none
    assert len(re.findall(r"^\d+ +[\d.e-]+ +[\d.e-]+ +2 ", printed, re.MULTILINE)) == summary[
        "time_steps"]
