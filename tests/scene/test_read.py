"""Reading a file, and changes from the command line."""

from pathlib import Path

import pytest
import tomli_w

from porolub.errors import SceneError
from porolub.scene import load_scene, scene_from_dict
from porolub.scene.overrides import apply_overrides
from tests.scene.scenes import ROLLING, changed


@pytest.fixture
def rolling(tmp_path: Path) -> Path:
    path = tmp_path / "rolling.toml"
    path.write_text(tomli_w.dumps(ROLLING))
    return path


def test_a_file_and_its_tables_give_the_same_scene(rolling: Path) -> None:
    assert load_scene(rolling) == load_scene(str(rolling)) == scene_from_dict(ROLLING)


@pytest.mark.parametrize(
    ("override", "section", "key", "value"),
    [
        ("load.force=3kN/m", "load", "force", "3 kN/m"),
        ('load.force="3 kN/m"', "load", "force", "3 kN/m"),
        ("load.force = 3 kN/m", "load", "force", "3 kN/m"),
        ("mesh.along=600", "mesh", "along", 600),
        ("mesh.grading=none", "mesh", "grading", "none"),
        ("solid.base=bonded", "solid", "base", "bonded"),
        ("contact.friction=0.1", "contact", "friction", 0.1),
        ("pores.carry=false", "pores", "carry", False),
        ("conventions.frame=material", "conventions", "frame", "material"),
        ("scene.title=a = b", "scene", "title", "a = b"),
    ],
)
def test_overrides_change_one_key(
    rolling: Path, override: str, section: str, key: str, value: object
) -> None:
    wanted = scene_from_dict(changed(ROLLING, **{section: {key: value}}))
    assert load_scene(rolling, [override]) == wanted


@pytest.mark.parametrize("override", ["film=none", "film=false", "film="])
def test_overrides_take_a_section_away(rolling: Path, override: str) -> None:
    assert load_scene(rolling, [override]).film is None


def test_overrides_take_keys_away_and_replace_sections(rolling: Path) -> None:
    force_away = load_scene(rolling, ["load.force=", "load.approach=50 um"])
    replaced = load_scene(rolling, ['load={approach="50 um"}'])
    assert force_away == replaced
    assert replaced.load is not None
    assert replaced.load.approach == 5e-5


def test_overrides_reach_into_tables_and_make_them(rolling: Path) -> None:
    scene = load_scene(
        rolling,
        [
            'motion.speed={mean="1 rad/s", amplitude="1 rad/s", frequency="1 Hz"}',
            "motion.speed.mean=2 rad/s",
            "boundary.inlet.pressure=1 kPa",
        ],
    )
    assert scene.motion is not None
    assert scene.motion.at(0.0) == 2.0
    assert scene.boundary["inlet"].pressure == 1000.0
    assert load_scene(rolling, ["boundary.inlet=none"]).boundary == {}


def test_later_overrides_win(rolling: Path) -> None:
    assert load_scene(rolling, ["mesh.along=2", "mesh.along=3"]).mesh.along == 3


@pytest.mark.parametrize(
    ("override", "parts"),
    [
        ("mesh.along", ['"mesh.along"', "section.key=value"]),
        ("=3", ['"=3"', "section.key=value"]),
        ("mesh..along=3", ["section.key=value"]),
        ("mesh.along.x=3", ["mesh.along is no table"]),
        ("mesh.alnog=3", ["mesh.alnog = 3", "did you mean mesh.along?"]),
        ("load.force=3 m", ['load.force = "3 m"', "a length", "a load per length"]),
    ],
)
def test_wrong_overrides_are_refused(rolling: Path, override: str, parts: list[str]) -> None:
    with pytest.raises(SceneError) as caught:
        load_scene(rolling, [override])
    assert all(part in str(caught.value) for part in parts), caught.value


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    path = tmp_path / "nope.toml"
    with pytest.raises(SceneError, match=r"nope\.toml: there is no such scene file"):
        load_scene(path)


def test_a_directory_is_no_scene(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="cannot be read"):
        load_scene(tmp_path)


def test_a_syntax_error_is_reported_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "broken.toml"
    path.write_text('[scene]\ntitle = "x"\n[mesh]\nalong = 3 mm\n')
    with pytest.raises(SceneError, match=r"broken\.toml: this is not valid TOML.*line 4"):
        load_scene(path)


def test_a_binary_file_is_no_scene(tmp_path: Path) -> None:
    path = tmp_path / "binary.toml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SceneError, match="UTF-8"):
        load_scene(path)


def test_overrides_leave_the_tables_they_start_from_alone() -> None:
    tables = changed(ROLLING)
    changed_tables = apply_overrides(tables, ["mesh.along=3", "film=none"])
    assert tables == ROLLING
    assert changed_tables == changed(ROLLING, mesh={"along": 3}, film=None)
