"""Every file and every number that the contract promises, for a small Case 1."""

import json
import math

import h5py
import meshio
import numpy as np
import pytest

from porolub.io.checkpoint import read_checkpoint, read_digest
from porolub.io.summary import KEYS
from porolub.scene import estimate_unknowns, load_scene
from tests.run.output import Output

FILES = {
    "summary.json", "history.csv", "fields.xdmf", "fields.h5", "surface.csv",
    "scene.resolved.toml", "petsc.options", "log.txt", "checkpoint.h5",
}
PLOTS = {"von_mises.png", "pressure.png", "surface.png", "flow.png"}
TEXTS = {"status", "message"}
TABLES = {"effects", "dofs", "wall_time", "versions", "error_estimate", "warnings"}


def test_every_file_is_there_and_none_is_empty(case1: Output) -> None:
    found = {path.name: path.stat().st_size for path in case1.directory.iterdir()}
    assert set(found) == FILES | PLOTS
    assert all(size > 0 for size in found.values())


def test_the_summary_has_every_key_and_every_number_is_one(case1: Output) -> None:
    assert list(case1.summary)[: len(KEYS)] == list(KEYS)
    for key in set(KEYS) - TEXTS - TABLES:
        value = case1.summary[key]
        assert isinstance(value, int | float), key
        assert math.isfinite(value), key
    assert (case1.summary["status"], case1.summary["ranks"]) == ("converged", 1)
    assert case1.summary["effects"] == [
        "solid", "pores", "carry", "film", "contact", "rotation", "load"]
    assert case1.summary["versions"]["petsc"].startswith("3.")


def test_estimated_errors_are_those_of_numbers(case1: Output) -> None:
    errors = case1.summary["error_estimate"]
    assert {"friction_coefficient", "load_solid", "load_fluid", "approach"} <= set(errors)
    for name, error in errors.items():
        assert 0.0 <= error < math.inf, name
        assert isinstance(case1.summary[name], float), name
    assert errors["load_total"] < 1e-6 * case1.summary["load_total"]  # prescribed


def test_the_unknowns_are_those_that_check_announces(case1: Output) -> None:
    assert case1.summary["dofs"] == estimate_unknowns(case1.scene)


def test_time_is_accounted_for(case1: Output) -> None:
    spent = case1.summary["wall_time"]
    assert set(spent) == {"setup", "assembly", "linear_solve", "output", "total"}
    assert all(seconds > 0.0 for seconds in spent.values())
    parts = [seconds for purpose, seconds in spent.items() if purpose != "total"]
    assert sum(parts) <= spent["total"]
    assert case1.summary["peak_memory"] > 1e7
    assert case1.summary["linear_iterations"] >= case1.summary["newton_iterations"] > 0


def test_the_resolved_scene_is_the_scene(case1: Output) -> None:
    again = load_scene(case1.directory / "scene.resolved.toml")
    assert again.digest() == case1.scene.digest()


def test_the_history_ends_with_the_summary(case1: Output) -> None:
    (row,) = case1.history
    assert row.pop("time") == 0.0
    assert len(row) > 15
    assert row == {key: case1.summary[key] for key in row}


def test_fields_are_read_by_others(case1: Output) -> None:
    mesh = meshio.read(case1.directory / "fields.xdmf")
    assert set(mesh.point_data) == {"u", "p", "J", "von_mises", "flux"}
    assert [(block.type, len(block.data)) for block in mesh.cells] == [("quad9", 360)]
    np.testing.assert_array_equal(mesh.point_data["p"], case1.fields.pressure)
    with h5py.File(case1.directory / "fields.h5") as file:
        units = {name: file[name].attrs["unit"] for name in ("nodes", "u", "p", "flux")}
    assert units == {"nodes": "m", "u": "m", "p": "Pa", "flux": "m/s"}


def test_the_checkpoint_holds_the_same_state(case1: Output) -> None:
    resume, tables = read_checkpoint(case1.directory / "checkpoint.h5")
    (state,) = resume.states
    assert tables == case1.scene.resolved()
    assert read_digest(case1.directory / "checkpoint.h5") == case1.scene.digest()
    np.testing.assert_array_equal(state.mesh_nodes, case1.fields.nodes)
    nodes, values = state.fields["u"]
    np.testing.assert_allclose(values, case1.fields.displacement[nodes], atol=1e-18)
    nodes, values = state.fields["p"]
    np.testing.assert_allclose(values[:, 0], case1.fields.pressure[nodes], rtol=1e-12, atol=1e-6)
    assert state.fields["v0"][1].item() == pytest.approx(case1.summary["approach"], rel=1e-14)


def test_the_log_tells_of_every_newton_iteration(case1: Output) -> None:
    lines = (case1.directory / "log.txt").read_text().splitlines()
    assert sum("updates: u " in line for line in lines) == case1.summary["newton_iterations"]


def test_the_options_of_the_solver_are_written_as_petsc_reads_them(case1: Output) -> None:
    lines = (case1.directory / "petsc.options").read_text().splitlines()
    assert "-pc_factor_mat_solver_type mumps" in lines
    assert all(line.startswith("-") for line in lines if not line.startswith("#"))


def test_the_summary_is_strict_json(case1: Output) -> None:
    def refuse(name: str) -> None:
        raise AssertionError(name)

    json.loads((case1.directory / "summary.json").read_text(), parse_constant=refuse)
