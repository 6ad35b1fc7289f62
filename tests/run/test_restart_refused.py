"""`porolub restart` on what it cannot go on with: exit code 2 and the reason."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from porolub.cli import app
from porolub.scene import load_scene
from tests.physics.mesh_files import layer_file
from tests.run.output import shipped
from tests.run.transient import ROW, run, small, stopped


@pytest.fixture(scope="module")
def half_way(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("half way")
    stopped(directory, small(), ROW, 4)
    return directory


def refusal(directory: Path, *overrides: str) -> str:
    """What `porolub restart` says, having left all files as they were."""
    files = {path: path.read_bytes() for path in directory.rglob("*") if path.is_file()}
    words = [word for override in overrides for word in ("--set", override)]
    result = CliRunner().invoke(app, ["restart", str(directory), *words])
    assert (result.exit_code, result.stdout) == (2, "")
    assert {p: p.read_bytes() for p in directory.rglob("*") if p.is_file()} == files
    (line,) = result.stderr.splitlines()
    return line


@pytest.mark.parametrize(
    ("overrides", "keys"),
    [
        (["load.force=2 kN/m"], "load.force"),
        (["load.force.amplitude=0.1 kN/m"], "load.force.amplitude"),
        (["mesh.along=24"], "mesh.along"),
        (["time.order=3"], "time.order"),
        (["film=none"], "film"),
        (["solid.shear_modulus=1 MPa", "time.end=1 s", "time.tolerance=1e-4", "mesh.across=3"],
         "mesh.across, solid.shear_modulus"),
    ],
)
def test_another_scene_is_refused_by_its_keys(
    half_way: Path, overrides: list[str], keys: str
) -> None:
    said = refusal(half_way, *overrides)
    assert said.startswith(f"porolub: {half_way / 'checkpoint.h5'} belongs to a scene that differs")
    assert f" differs in {keys}; only how far" in said


def test_a_scene_file_that_was_edited_is_refused(half_way: Path, tmp_path: Path) -> None:
    shutil.copytree(half_way, tmp_path, dirs_exist_ok=True)
    scene = tmp_path / "scene.resolved.toml"
    scene.write_text(scene.read_text().replace('biot = 0.9', 'biot = 0.8'))
    assert "differs in pores.biot;" in refusal(tmp_path)


def test_a_wrong_override_is_refused_as_in_a_run(half_way: Path) -> None:
    assert "did you mean time.end?" in refusal(half_way, "time.emd=1 s")


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (lambda file: file.unlink(), "there is no checkpoint here."),
        (lambda file: file.write_bytes(file.read_bytes()[:-100]), "this checkpoint is damaged."),
        (lambda file: file.write_bytes(file.read_bytes()[:4000] + b"?" + file.read_bytes()[4001:]),
         "this checkpoint is damaged."),
        (lambda file: file.write_bytes(b""), "this is no checkpoint that this porolub could read."),
        (lambda file: file.with_name("scene.resolved.toml").unlink(),
         "there is no such scene file."),
    ],
    ids=["missing", "cut short", "a wrong byte", "empty", "without its scene"],
)
def test_a_damaged_directory_is_refused(half_way: Path, tmp_path: Path, damage, said) -> None:
    shutil.copytree(half_way, tmp_path, dirs_exist_ok=True)
    damage(tmp_path / "checkpoint.h5")
    assert refusal(tmp_path).endswith(said)


def test_a_directory_that_is_none_is_refused(tmp_path: Path) -> None:
    assert refusal(tmp_path / "nowhere").endswith("there is no checkpoint here.")


def test_a_steady_run_is_refused(tmp_path: Path) -> None:
    run(tmp_path, shipped("case1", 20, 2))
    said = f"porolub: {tmp_path}: this is a steady run, there is nothing to go on with."
    assert refusal(tmp_path) == said
    assert refusal(tmp_path, "time.end=1 s") == said


def test_another_mesh_in_the_same_file_is_refused(tmp_path: Path) -> None:
    x, y = np.linspace(-2e-3, 2e-3, 5), np.linspace(0.0, 1e-3, 3)
    flat = layer_file(tmp_path / "layer.msh", x, y, np.zeros_like)
    (tmp_path / "scene.toml").write_text("""
        geometry = {shape = "file", path = "layer.msh"}
        pores = {biot = 0.9, permeability = "1 um^3/mm", viscosity = "1 mPa*s", carry = false}
        solid = {law = "linear", shear_modulus = "1 MPa", bulk_modulus = "2 MPa"}
        time = {end = "1 s"}
        [boundary]
        bone = {displacement = {y = "0 mm"}}
        inlet = {displacement = {x = "0 mm"}}
        lubricated = {traction = "1 kPa", pressure = "0 Pa"}
    """)
    scene = load_scene(tmp_path / "scene.toml")
    stopped(tmp_path / "here", scene, ROW, 4)
    layer_file(flat, x, y + 1e-6 * y / y[-1], np.zeros_like)
    said = refusal(tmp_path / "here")
    assert "belongs to a scene that differs in the content of geometry.path;" in said
