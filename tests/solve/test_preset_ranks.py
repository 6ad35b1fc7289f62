"""The iterative presets on 1, 2 and 4 ranks: the numbers of the direct solver."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import RunMPI

SCRIPT = Path(__file__).parent / "preset_ranks.py"
CASES = {
    "case1_bonded": ["mesh.along=60", "mesh.across=6"],
    "joint3d": ["mesh.along=24", "mesh.across=2", "mesh.deep=6"],
}


def ended(run_mpi: RunMPI, ranks: int, job: str, preset: str) -> dict[str, Any]:
    output = run_mpi(ranks, SCRIPT, job, preset, *CASES[job])
    found: dict[str, Any] = json.loads(output.splitlines()[-1])
    return found


@pytest.mark.parametrize("job", CASES)
def test_any_preset_on_any_number_of_ranks_gives_the_same_summary(run_mpi: RunMPI, job: str
                                                                  ) -> None:
    direct = ended(run_mpi, 1, job, "direct")
    assert direct["converged"]
    for preset, ranks in (("fieldsplit", 1), ("fieldsplit", 2), ("fieldsplit", 4), ("nested", 2)):
        found = ended(run_mpi, ranks, job, preset)
        for name, value in direct.items():
            if name in ("newton", "linear", "load_balance_error", "mass_balance_error"):
                continue
            assert found[name] == pytest.approx(value, rel=1e-7), (preset, ranks, name)
        assert found["newton"] <= direct["newton"] + 2
        assert found["linear"] <= 40 * found["newton"]
        assert found["mass_balance_error"] < 1e-8
