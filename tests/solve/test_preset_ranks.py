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


def ended(run_mpi: RunMPI, ranks: int, job: str, *presets: str) -> dict[str, dict[str, Any]]:
    """The summary by each preset; on so many ranks, which are started once."""
    output = run_mpi(ranks, SCRIPT, job, ",".join(presets), *CASES[job])
    lines = [line.split(maxsplit=2) for line in output.splitlines() if line.startswith("FOUND ")]
    assert [preset for _, preset, _ in lines] == list(presets)
    return {preset: json.loads(found) for _, preset, found in lines}


@pytest.mark.mpi
@pytest.mark.parametrize("job", CASES)
def test_any_preset_on_any_number_of_ranks_gives_the_same_summary(run_mpi: RunMPI, job: str
                                                                  ) -> None:
    alone = ended(run_mpi, 1, job, "direct", "fieldsplit")
    direct = alone.pop("direct")
    assert direct["converged"]
    others = {1: alone, 2: ended(run_mpi, 2, job, "fieldsplit", "nested"),
              4: ended(run_mpi, 4, job, "fieldsplit")}
    for ranks, by_preset in others.items():
        for preset, found in by_preset.items():
            for name, value in direct.items():
                if name in ("newton", "linear", "load_balance_error", "mass_balance_error"):
                    continue
                assert found[name] == pytest.approx(value, rel=1e-7), (preset, ranks, name)
            assert found["newton"] <= direct["newton"] + 2
            assert found["linear"] <= 40 * found["newton"]
            assert found["mass_balance_error"] < 1e-8
