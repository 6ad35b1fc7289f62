"""The output directory: complete, of one run, or refused in one sentence."""

from dataclasses import replace
from pathlib import Path

import pytest

import porolub.io.directory as directory_module
from porolub.errors import SceneError
from porolub.io.directory import PLOTS, prepare_directory, write_results
from porolub.io.summary import read_summary
from porolub.scene import Scene, load_scene
from porolub.solve.report import Report

DATA = {
    "summary.json",
    "history.csv",
    "fields.h5",
    "fields.xdmf",
    "surface.csv",
    "scene.resolved.toml",
    "petsc.options",
}


def names(directory: Path) -> set[str]:
    return {path.name for path in directory.iterdir()}


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
    with pytest.raises(SceneError, match=r"the results cannot be written \(Is a directory\)"):
        write_results(tmp_path, report, scene)
