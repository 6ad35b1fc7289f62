"""The output directory: complete, of one run, or refused in one sentence."""

import tomllib
from dataclasses import replace
from pathlib import Path

import h5py
import pytest

import porolub.io.directory as directory_module
from porolub.errors import SceneError, SolveError
from porolub.io.checkpoint import read_checkpoint, write_checkpoint
from porolub.io.directory import (
    ANIMATION,
    CHECKPOINT,
    HISTORY,
    HISTORY_PLOTS,
    PLOTS,
    begin_run,
    prepare_directory,
    write_results,
)
from porolub.io.fields import read_fields
from porolub.io.frames import FrameWriter, read_frames
from porolub.io.history import HistoryWriter, read_history
from porolub.io.summary import read_summary
from porolub.scene import Scene, load_scene
from porolub.solve.report import FrameData, Report, StepRecord
from tests.io.resume import made_up

DATA = {
    "summary.json",
    "history.csv",
    "fields.h5",
    "fields.xdmf",
    "surface.csv",
    "scene.resolved.toml",
    "petsc.options",
}


INPUT = {"scene.resolved.toml", "petsc.options"}
GROWING = {HISTORY, CHECKPOINT, "frames", "series.xdmf"}


def names(directory: Path) -> set[str]:
    return {path.name for path in directory.iterdir()}


def transient_run(directory: Path, report: Report, scene: Scene) -> None:
    """All a run of many steps writes, pictures included."""
    toml = begin_run(directory, scene, "-ksp_type preonly")
    history, frames = HistoryWriter(directory / HISTORY), FrameWriter(directory)
    for k in range(3):
        history.write(StepRecord(k / 3, {"load_total": 1500.0}))
        frames.write(FrameData(k, k / 3, report.fields, report.surface))
        resume = replace(made_up(nodes=9, states=2), frame=k + 1)
        write_checkpoint(directory / CHECKPOINT, resume, toml, scene.digest())
    write_results(directory, report, scene, history_written=True)
    for name in (*HISTORY_PLOTS, ANIMATION):
        (directory / name).write_text("a picture")


def test_every_file_is_written(tmp_path: Path, report: Report, scene: Scene) -> None:
    out = tmp_path / "results" / "case1"
    write_results(out, report, scene, "-ksp_type preonly\n-pc_type lu\n")
    assert names(out) == DATA | set(PLOTS)
    assert load_scene(out / "scene.resolved.toml") == scene
    assert (out / "petsc.options").read_text() == "-ksp_type preonly\n-pc_type lu\n"
    assert read_summary(out / "summary.json")["load_total"] == 1500.0
    assert (out / "history.csv").read_text() == "time,load_total\n0.0,1500.0\n"


def test_nothing_of_an_earlier_run_stays(tmp_path: Path, report: Report, scene: Scene) -> None:
    write_results(tmp_path, report, scene)
    write_results(tmp_path, replace(report, surface=None), scene, plots=False)
    assert names(tmp_path) == DATA - {"surface.csv"}


def test_other_files_are_left_alone(tmp_path: Path, report: Report, scene: Scene) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    write_results(tmp_path, report, scene, plots=False)
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_an_interrupted_run_leaves_no_summary(
    tmp_path: Path, report: Report, scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_results(tmp_path, report, scene, plots=False)

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(directory_module, "write_history", stop)
    with pytest.raises(KeyboardInterrupt):
        write_results(tmp_path, report, scene, plots=False)
    assert names(tmp_path) == DATA - {"summary.json"}


def test_a_file_in_the_way_is_refused(tmp_path: Path, report: Report, scene: Scene) -> None:
    (tmp_path / "out").write_text("mine")
    with pytest.raises(SceneError, match="out: this is a file; a directory is needed"):
        write_results(tmp_path / "out", report, scene)
    with pytest.raises(SceneError, match=r"below: the directory .* cannot be made \(Not a dir"):
        prepare_directory(tmp_path / "out" / "below")
    assert (tmp_path / "out").read_text() == "mine"


def test_a_directory_without_permission_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(directory_module.os, "access", lambda *_: False)  # root may do anything
    with pytest.raises(SceneError, match="you may not write into this directory"):
        prepare_directory(tmp_path)


def test_a_file_that_cannot_be_written_is_one_sentence(
    tmp_path: Path, report: Report, scene: Scene
) -> None:
    (tmp_path / "fields.h5").mkdir()
    with pytest.raises(SolveError, match=r"the results cannot be written \(Is a directory\)"):
        write_results(tmp_path, report, scene)
    with pytest.raises(SceneError, match=r"a run cannot write its files here \(Is a directory\)"):
        begin_run(tmp_path, scene)


def test_a_steady_run_leaves_its_state_to_go_on_from(
    tmp_path: Path, report: Report, scene: Scene
) -> None:
    state = made_up(nodes=9, states=1).states[0]
    write_results(tmp_path, replace(report, state=state), scene, plots=False)
    assert names(tmp_path) == DATA | {CHECKPOINT}
    resume, tables = read_checkpoint(tmp_path / CHECKPOINT)
    assert (len(resume.states), resume.orders, resume.step) == (1, (0,), 0.0)
    assert tables == scene.resolved()


def test_a_run_that_begins_has_all_that_restart_needs_of_the_scene(
    tmp_path: Path, scene: Scene
) -> None:
    toml = begin_run(tmp_path / "out", scene, "-ksp_type preonly\n")
    assert names(tmp_path / "out") == INPUT
    assert load_scene(tmp_path / "out" / "scene.resolved.toml") == scene
    assert (tmp_path / "out" / "petsc.options").read_text() == "-ksp_type preonly\n"
    assert tomllib.loads(toml) == scene.resolved()


def test_the_end_of_a_run_leaves_what_it_wrote_on_the_way(
    tmp_path: Path, report: Report, scene: Scene
) -> None:
    state = replace(made_up(nodes=9, states=1).states[0], time=2 / 3)
    transient_run(tmp_path, replace(report, state=state, history=[]), scene)
    pictures = {*PLOTS, *HISTORY_PLOTS, ANIMATION}
    assert names(tmp_path) == DATA | GROWING | pictures
    assert len(read_history(tmp_path / HISTORY)["time"]) == 3
    assert read_checkpoint(tmp_path / CHECKPOINT)[0].frame == 3
    assert len(read_frames(tmp_path)) == 3
    with h5py.File(tmp_path / "fields.h5") as file:
        assert file.attrs["time"] == 2 / 3


def test_a_new_run_begins_in_an_empty_directory(
    tmp_path: Path, report: Report, scene: Scene
) -> None:
    transient_run(tmp_path, report, scene)
    (tmp_path / ".checkpoint.h5.tmp").write_text("of a killed write")
    (tmp_path / ".series.xdmf.tmp").write_text("of a killed write")
    begin_run(tmp_path, scene)
    assert names(tmp_path) == INPUT


def test_a_run_that_goes_on_keeps_its_data(tmp_path: Path, report: Report, scene: Scene) -> None:
    transient_run(tmp_path, report, scene)
    begin_run(tmp_path, scene, resume=True)
    assert names(tmp_path) == (DATA | GROWING) - {"summary.json"}
    assert len(read_frames(tmp_path)) == 3
    assert len(read_history(tmp_path / HISTORY)["time"]) == 3
    assert read_checkpoint(tmp_path / CHECKPOINT)[0].frame == 3
    read_fields(tmp_path)


def test_a_steady_run_takes_what_a_transient_one_left(
    tmp_path: Path, report: Report, scene: Scene
) -> None:
    transient_run(tmp_path, report, scene)
    write_results(tmp_path, report, scene)
    assert names(tmp_path) == DATA | set(PLOTS)
