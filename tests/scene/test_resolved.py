"""A resolved scene is complete, reads back to an equal scene, and has a stable digest."""

import tomllib
from pathlib import Path
from typing import Any

from hypothesis import given, settings

from porolub.scene import load_scene, scene_from_dict, write_resolved
from tests.scene.scenes import CUBE, ROLLING, changed, scene_tables


@settings(deadline=None)
@given(scene_tables())
def test_any_scene_survives_writing_and_reading(
    tmp_path_factory: Any, tables: dict[str, Any]
) -> None:
    scene = scene_from_dict(tables)
    path = tmp_path_factory.getbasetemp() / "scene.resolved.toml"
    write_resolved(scene, path)
    again = load_scene(path)
    assert again == scene
    assert again.digest() == scene.digest()
    assert again.resolved() == scene.resolved()


def test_it_holds_every_key_with_its_default() -> None:
    tables = scene_from_dict(ROLLING).resolved()
    assert tables["film"] == {
        "viscosity": "0.001 Pa*s",
        "shear_film_min": "1e-07 m",
        "squeeze": True,
    }
    assert tables["pores"]["fluid_density"] == "1000.0 kg/m^3"
    assert tables["pores"]["permeability"] == "1e-15 m^2"
    assert tables["contact"] == {
        "friction": 0.45,
        "friction_traction": False,
        "friction_speed": "0.001 m/s",
    }
    assert tables["conventions"] == {
        "surface_traction": "balanced",
        "frame": "spatial",
        "entering": "computed",
    }
    assert tables["load"] == {"force": "1500.0 N/m"}
    assert scene_from_dict(CUBE).resolved()["load"] == {"force": "3000.0 N"}


def test_a_mesh_file_is_written_with_its_full_path(tmp_path: Path) -> None:
    (tmp_path / "layer.msh").write_bytes(b"a mesh")
    tables = CUBE | {"geometry": {"shape": "file", "path": "layer.msh"}, "mesh": {"degree": 2}}
    scene = scene_from_dict(tables, base_dir=tmp_path)
    assert scene.resolved()["geometry"]["path"] == str(tmp_path / "layer.msh")
    write_resolved(scene, tmp_path / "resolved.toml")
    assert load_scene(tmp_path / "resolved.toml") == scene
    assert "along" not in tomllib.loads((tmp_path / "resolved.toml").read_text())["mesh"]


def test_the_digest_follows_what_changes_the_answer() -> None:
    digest = scene_from_dict(ROLLING).digest()
    assert scene_from_dict(changed(ROLLING, scene={"title": "other"})).digest() == digest
    assert scene_from_dict(changed(ROLLING, load={"force": "1500 N/m"})).digest() == digest
    assert scene_from_dict(changed(ROLLING, mesh={"degree": 2})).digest() == digest
    assert scene_from_dict(changed(ROLLING, load={"force": "1.6 kN/m"})).digest() != digest
    assert scene_from_dict(changed(ROLLING, film=None)).digest() != digest


def test_the_digest_does_not_follow_how_long_a_run_is_followed() -> None:
    def digest(**time: Any) -> str:
        load = {"mean": "2 kN/m", "amplitude": "1 kN/m", "frequency": "1 Hz"}
        tables = changed(ROLLING, load={"force": load}, time={"end": "5 s"} | time)
        return scene_from_dict(tables).digest()

    same = digest()
    assert digest(end="7 s") == same
    assert digest(until="periodic", repeat_tolerance=0.1, frames=3) == same
    assert digest(start="steady") == same
    assert digest(start="rest") != same
    assert digest(tolerance=1e-4) != same
    assert digest(order=1) != same


def test_the_digest_of_a_mesh_file_is_that_of_its_content(tmp_path: Path) -> None:
    def digest(name: str, content: bytes) -> str:
        (tmp_path / name).write_bytes(content)
        tables = CUBE | {"geometry": {"shape": "file", "path": name}, "mesh": {}}
        return scene_from_dict(tables, base_dir=tmp_path).digest()

    assert digest("a.msh", b"one") == digest("b.msh", b"one") != digest("a.msh", b"two")
