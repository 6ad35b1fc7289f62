"""A user's mesh of a slab in 3D gives the answer of the built-in one: film, contact, rotation."""

import json
from pathlib import Path
from typing import Any

import pytest

from porolub.scene.read import scene_from_dict
from tests.mesh.scenes import barrel_file
from tests.run.output import Output, run
from tests.run.program import drawn_on_two
from tests.scene.scenes import ROLLING, changed

COUNTS = (50, 3, 1)
SYMMETRY = {"symmetry": ["front", "back"]}
SLAB = {"shape": "barrel", "outer_radius": "100 mm", "thickness": "1 mm", "half_angle": "5 deg",
        "width": "1 mm"}
LOADS = ("load_fluid", "load_solid", "approach", "contact_length", "friction_coefficient")
FLOWS = ("inflow_left", "inflow_right", "outflow_right")


def rolled(directory: Path, geometry: dict[str, Any], mesh: dict[str, int]) -> Output:
    tables = changed(ROLLING, scene={"dimension": 3}, load={"force": "1.5 N"})
    return run(directory, scene_from_dict({**tables, "geometry": geometry, "mesh": mesh}))


@pytest.fixture(scope="module")
def built_in(tmp_path_factory: pytest.TempPathFactory) -> Output:
    counts = dict(zip(("along", "across", "deep"), COUNTS, strict=True))
    return rolled(tmp_path_factory.mktemp("built in"), {**SLAB, **SYMMETRY}, counts)


def on_file(directory: Path, hexahedra: bool) -> Output:
    path = barrel_file(directory / "mesh.msh", hexahedra=hexahedra, counts=COUNTS, width=1e-3)
    geometry = {"shape": "file", "path": str(path), **SYMMETRY}
    return rolled(directory / "on file", geometry, {})


def test_the_same_hexahedra_give_the_same_answer(tmp_path: Path, built_in: Output) -> None:
    """All that differs is that edges inside are straight: by h^2/(8 R), 1e-4 of the thickness."""
    found = on_file(tmp_path, hexahedra=True)
    assert found.summary["dofs"] == built_in.summary["dofs"]
    for key in (*LOADS, *FLOWS, "contact_area", "contact_width"):
        assert found.summary[key] == pytest.approx(built_in.summary[key], rel=1e-3), key
    assert found.fields.cell_type == "hex"


def test_tetrahedra_of_that_size_agree_within_their_error(
    tmp_path: Path, built_in: Output
) -> None:
    found = on_file(tmp_path, hexahedra=False).summary
    assert found["load_total"] == pytest.approx(1.5, rel=1e-8)
    assert found["mass_balance_error"] < 1e-8
    for key in LOADS:
        assert found[key] == pytest.approx(built_in.summary[key], rel=0.03), key


@pytest.mark.mpi
def test_tetrahedra_give_the_same_numbers_on_any_number_of_ranks(run_mpi, tmp_path: Path) -> None:
    barrel_file(tmp_path / "mesh.msh", hexahedra=False, counts=(30, 2, 2), width=2e-3)
    tables = changed(ROLLING, scene={"dimension": 3}, load={"force": "3 N"}, mesh=None)
    tables["geometry"] = {"shape": "file", "path": "mesh.msh", **SYMMETRY}
    lines = []
    for section, keys in tables.items():
        lines += [f"[{section}]", *(f"{key} = {json.dumps(value)}" for key, value in keys.items())]
    scene = tmp_path / "scene.toml"
    scene.write_text("\n".join(lines))
    found = {}
    for ranks in (1, 2, 4):
        out = tmp_path / str(ranks)
        run_mpi(ranks, drawn_on_two(ranks), "run", scene, "--quiet", "--out", out)
        found[ranks] = json.loads((out / "summary.json").read_text())
    assert found[1]["contact_area"] > 0
    for key in (*LOADS, *FLOWS, "contact_area", "contact_pressure_max", "pressure_max"):
        for ranks in (2, 4):
            assert found[ranks][key] == pytest.approx(found[1][key], rel=1e-8), (key, ranks)
