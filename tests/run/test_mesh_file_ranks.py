"""A mesh file is read on rank 0 alone, so that no other rank ever holds all of it."""

import json
from pathlib import Path

import pytest

from tests.conftest import RunMPI
from tests.mesh.scenes import barrel_file
from tests.scene.scenes import ROLLING, changed

SCRIPT = Path(__file__).parent / "reads_ranks.py"
TIMES = {"steady": {}, "in time": {"end": "1 ms", "tolerance": 0.1}}


@pytest.mark.mpi
@pytest.mark.parametrize("when", TIMES)
def test_no_other_rank_reads_the_mesh_file(run_mpi: RunMPI, tmp_path: Path, when: str) -> None:
    barrel_file(tmp_path / "mesh.msh", hexahedra=True, counts=(12, 2, 1), width=1e-3)
    tables = changed(ROLLING, scene={"dimension": 3}, load={"force": "0.3 N"}, mesh=None)
    symmetry = ["front", "back"]
    tables["geometry"] = {"shape": "file", "path": "mesh.msh", "symmetry": symmetry}
    if TIMES[when]:
        tables["time"] = TIMES[when]
    lines = []
    for section, keys in tables.items():
        lines += [f"[{section}]", *(f"{key} = {json.dumps(value)}" for key, value in keys.items())]
    scene = tmp_path / "scene.toml"
    scene.write_text("\n".join(lines))
    printed = run_mpi(2, SCRIPT, "run", scene, "--quiet", "--out", tmp_path / "out",
                      "--petsc", "-mat_mumps_icntl_14 90")
    first, second = map(int, printed.splitlines()[-1].split())
    assert first > 0
    assert second == 0
