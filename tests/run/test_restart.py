"""Going on from a checkpoint, in one process: the same steps as if the run had not been stopped."""

import shutil
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from petsc4py import PETSc

from porolub.errors import Interrupted
from porolub.io.history import read_history
from porolub.io.log import close_logging
from porolub.io.summary import read_summary
from porolub.run_transient import restart
from porolub.solve.newton import Newton
from tests.run.output import Output
from tests.run.test_ranks import errors_like
from tests.run.transient import (
    ITERATION,
    KINKS,
    ROW,
    no_remains,
    run,
    same_frames,
    same_history,
    signalled,
    small,
    stopped,
)

WALL_CLOCK = {"wall_time", "peak_memory"}


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Drawing takes longer than these runs."""
    monkeypatch.setattr("porolub.io.plots.plot_directory", lambda directory: [])


@pytest.fixture(scope="module")
def kinked(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Output:
    """A run over two kinks of the load that nobody stops, for each order of the BDF."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("porolub.io.plots.plot_directory", lambda directory: [])
        scene = small(f"time.order={request.param}", KINKS)
        return run(tmp_path_factory.mktemp("kinked"), scene)


@pytest.fixture(scope="module")
def smooth(tmp_path_factory: pytest.TempPathFactory) -> Output:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("porolub.io.plots.plot_directory", lambda directory: [])
        return run(tmp_path_factory.mktemp("smooth"), small())


def rows_of(output: Output, place: str) -> int:
    """After how many rows of its history a run is at a place."""
    times = read_history(output.directory / "history.csv")["time"]
    at_kink = int(np.flatnonzero(times == 0.02)[0]) + 1
    return {"at the start": 1, "after the first step": 2, "after the second": 3,
            "at a kink": at_kink, "after a kink": at_kink + 1, "later": at_kink + 3}[place]


PLACES = ["at the start", "after the first step", "after the second", "at a kink", "after a kink",
          "later"]
QUICK = {1: ["at a kink"], 2: PLACES, 3: ["after the first step", "at a kink", "later"]}


@pytest.mark.parametrize(
    ("kinked", "place"),
    [pytest.param(order, place, marks=[] if place in QUICK[order] else pytest.mark.slow)
     for order in (1, 2, 3) for place in PLACES],
    indirect=["kinked"], ids=str)
def test_the_steps_do_not_depend_on_a_stop(kinked: Output, tmp_path: Path, place: str) -> None:
    rows = rows_of(kinked, place)
    stopped(tmp_path, kinked.scene, ROW, rows)
    assert len(Output(tmp_path, kinked.scene).history) == rows
    assert restart(tmp_path, quiet=True) == 0
    same_history(kinked.directory, tmp_path)
    same_frames(kinked.directory, tmp_path)
    no_remains(tmp_path)


@pytest.mark.parametrize("share", [0.05, 0.3, 0.6, 0.95])
def test_a_step_that_was_under_way_is_done_again(
    smooth: Output, tmp_path: Path, share: float
) -> None:
    """The files of the stopped run are those of its last accepted step."""
    start, all_of_them = smooth.history[0]["newton_iterations"], smooth.summary["newton_iterations"]
    with patch.object(Newton, "jacobian", autospec=True, side_effect=Newton.jacobian) as counted:
        stopped(tmp_path / "start", smooth.scene, ROW, 1)  # coarser meshes have iterations, too
    iteration = round(counted.call_count + share * (all_of_them - start))
    stopped(tmp_path, smooth.scene, ITERATION, iteration, number=signal.SIGINT)
    last, summary = Output(tmp_path, smooth.scene).history[-1], read_summary(
        tmp_path / "summary.json")
    assert summary["status"] == "interrupted"
    assert summary["time"] == last["time"]
    for key in ("load_solid", "pressure_max", "inflow_left", "outflow_right", "jacobian_min"):
        assert summary[key] == last[key], key
    restart(tmp_path, quiet=True)
    same_history(smooth.directory, tmp_path)


def test_a_run_may_be_stopped_again_and_again(smooth: Output, tmp_path: Path) -> None:
    stopped(tmp_path, smooth.scene, ROW, 4)
    for _ in range(3):
        with signalled(ROW, 3, signal.SIGTERM), pytest.raises(Interrupted):
            restart(tmp_path, quiet=True)
    restart(tmp_path, quiet=True)
    same_history(smooth.directory, tmp_path)
    same_frames(smooth.directory, tmp_path)
    sums, expected = read_summary(tmp_path / "summary.json"), smooth.summary
    for key in expected.keys() - WALL_CLOCK - {"mass_balance_error"}:
        value = expected[key]
        if isinstance(value, float):
            value = pytest.approx(value, rel=1e-7, abs=1e-12)
        elif key == "error_estimate":
            value = errors_like(expected, {})
        assert sums[key] == value, key
    assert sums["mass_balance_error"] == pytest.approx(expected["mass_balance_error"], abs=1e-9)


def test_the_log_goes_on(smooth: Output, tmp_path: Path) -> None:
    stopped(tmp_path, smooth.scene, ROW, 6)
    close_logging()
    before = (tmp_path / "log.txt").read_text()
    restart(tmp_path, quiet=True)
    after = (tmp_path / "log.txt").read_text()
    assert after.startswith(before)
    added = after.removeprefix(before)
    begin = smooth.history[5]["time"]
    assert f"time steps from {begin:.9g} to 0.06 s" in added
    steps = [line for line in added.splitlines() if "progress: " in line and "#" not in line]
    assert len(steps) == smooth.summary["time_steps"] - 5


def test_what_came_after_the_checkpoint_is_taken_away(smooth: Output, tmp_path: Path) -> None:
    """As a kill leaves it: rows and pictures the checkpoint does not know, a line half written."""
    stopped(tmp_path, smooth.scene, ROW, 8)
    lines = (smooth.directory / "history.csv").read_text().splitlines(keepends=True)
    (tmp_path / "history.csv").write_text("".join(lines[:11]) + lines[11][:40])
    for name in ("frame_0003.h5", "frame_0004.h5"):
        shutil.copy(smooth.directory / "frames" / name, tmp_path / "frames" / name)
    (tmp_path / ".checkpoint.h5.tmp").write_bytes(b"half")
    (tmp_path / "frames" / ".frame_0005.h5.tmp").write_bytes(b"half")
    restart(tmp_path, quiet=True)
    same_history(smooth.directory, tmp_path)
    same_frames(smooth.directory, tmp_path)
    no_remains(tmp_path)


def test_a_history_that_is_gone_is_begun_anew(smooth: Output, tmp_path: Path) -> None:
    stopped(tmp_path, smooth.scene, ROW, 8)
    (tmp_path / "history.csv").unlink()
    restart(tmp_path, quiet=True)
    times = read_history(tmp_path / "history.csv")["time"]
    expected = read_history(smooth.directory / "history.csv")["time"][8:]
    np.testing.assert_allclose(times, expected, rtol=1e-7)


def test_a_finished_run_says_so_and_goes_further_if_asked(
    smooth: Output, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(smooth.directory, tmp_path, dirs_exist_ok=True)
    files = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}
    assert restart(tmp_path) == 0
    assert capsys.readouterr().out == (
        f"{tmp_path}: the run has reached its end at t = 0.06 s; --set time.end=... takes it "
        "further.\n")
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")} == files
    assert restart(tmp_path, ["time.end=80 ms", "time.tolerance=2e-3"], quiet=True) == 0
    found = Output(tmp_path, smooth.scene)
    assert found.history[: len(smooth.history)] == smooth.history
    assert found.history[-1]["time"] == found.summary["time"] == 0.08
    assert restart(tmp_path, quiet=True) == 0  # its own end is the new one


def test_pictures_go_on_when_their_spacing_changes(tmp_path: Path) -> None:
    """Without a period the spacing is a share of the end, which restart may change."""
    run(tmp_path, small("load.force=1.5 kN/m", "time.frames=4"))
    before = len(list((tmp_path / "frames").glob("frame_*.h5")))
    restart(tmp_path, ["time.end=120 ms"], quiet=True)
    after = len(list((tmp_path / "frames").glob("frame_*.h5")))
    assert after >= before + 2


def test_what_was_computed_but_not_written_is_written(smooth: Output, tmp_path: Path) -> None:
    """Stopped after the last step: there is nothing to compute, but results are missing."""
    stopped(tmp_path, smooth.scene, ROW, len(smooth.history))
    assert read_summary(tmp_path / "summary.json")["status"] == "interrupted"
    restart(tmp_path, quiet=True)
    assert read_summary(tmp_path / "summary.json")["status"] == "converged"
    same_history(smooth.directory, tmp_path)


def test_a_run_that_became_periodic_says_so_and_goes_further_if_asked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    periodic = ["time.until=periodic", "time.repeat_tolerance=0.2", "load.force.frequency=40 Hz",
                "time.end=1 s", "time.frames=0"]
    found = run(tmp_path, small(*periodic))
    assert found.summary["message"].startswith("the last period repeats the one before; stopped")
    reached = found.summary["time"]
    assert reached < 0.2
    assert restart(tmp_path) == 0
    assert "repeats the one before" in capsys.readouterr().out
    end = ["time.until=end", f"time.end={reached + 0.01} s"]
    assert restart(tmp_path, end, quiet=True) == 0
    assert Output(tmp_path, found.scene).history[-1]["time"] == pytest.approx(reached + 0.01)


def forget_options() -> None:
    """As in a new process; PETSc's own call for it leaves them."""
    options: Any = PETSc.Options()
    for name in options.getAll():
        options.delValue(name)


@pytest.fixture
def _options_of_its_own() -> Iterator[None]:
    forget_options()
    yield
    forget_options()


@pytest.mark.usefixtures("_options_of_its_own")
def test_the_petsc_options_go_on(tmp_path: Path) -> None:
    scene, options = small(), "-ts_adapt_safety 0.3"
    expected = run(tmp_path / "expected", scene, options)
    stopped(tmp_path / "stopped", scene, ROW, 6, options)
    forget_options()
    restart(tmp_path / "stopped", quiet=True)
    same_history(expected.directory, tmp_path / "stopped")
    written = (tmp_path / "stopped" / "petsc.options").read_text().splitlines()
    assert "-ts_adapt_safety 0.3" in written
