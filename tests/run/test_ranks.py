"""The same numbers on 1, 2 and 4 ranks."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from porolub.io.fields import read_fields
from porolub.io.surface import read_surface
from tests.run.output import JOBS
from tests.run.program import drawn_on_two, small

# what depends on the machine; how contact is reached may hang on rounding, where it ends may not
NOT_COMPARED = {"wall_time", "peak_memory", "ranks", "versions",
                "newton_iterations", "linear_iterations", "rejected_steps"}
ROUNDING = {"mass_balance_error", "load_balance_error"}
FLOWS = {"inflow_left", "inflow_right", "outflow_left", "outflow_right"}

SCENES = {
    "case1": ("case1.toml", small(40, 5)),
    "bonded, graded": ("case1_bonded_graded.toml", [*small(60, 5), "--set",
                                                    "mesh.edge_size=100 um"]),
    "triangles": ("case1.toml", [*small(40, 4), "--set", "mesh.element=triangle"]),
}


def errors_like(summary: dict[str, Any], smallest: dict[str, float]) -> dict[str, Any]:
    """The estimated errors of a summary, to be compared: differences of numbers that are the same
    to 1e-8, or to ``smallest``."""
    return {name: pytest.approx(error, rel=1e-6, abs=smallest.get(
        name, 1e-8 * abs(summary.get(name) or 0.0)))
        for name, error in summary["error_estimate"].items()}


@pytest.mark.mpi
@pytest.mark.parametrize(
    "name", ["case1", "bonded, graded", pytest.param("triangles", marks=pytest.mark.slow)])
def test_numbers_do_not_depend_on_the_ranks(run_mpi, tmp_path: Path, name: str) -> None:
    job, options = SCENES[name]
    found = {}
    for ranks in (1, 2, 4):
        out = tmp_path / str(ranks)
        run_mpi(ranks, drawn_on_two(ranks), "run", JOBS / job, *options, "--quiet", "--out", out)
        summary = json.loads((out / "summary.json").read_text())
        assert (summary["status"], summary["ranks"]) == ("converged", ranks)
        found[ranks] = summary, read_surface(out / "surface.csv"), read_fields(out)
    summary, surface, fields = found[1]
    compared = set(summary) - NOT_COMPARED - ROUNDING
    # one side may pass next to nothing: what counts is the fluid that is exchanged
    smallest = {key: 1e-8 * max(summary[k] for k in FLOWS) for key in FLOWS}
    for ranks in (2, 4):
        others, other_surface, other_fields = found[ranks]
        for key in compared:
            expected = summary[key]
            if isinstance(expected, float):
                expected = pytest.approx(expected, rel=1e-8, abs=smallest.get(key, 1e-30))
            if key == "error_estimate":
                expected = errors_like(summary, smallest)
            assert others[key] == expected, f"{key} on {ranks} ranks"
        assert all(others[key] < 1e-8 for key in ROUNDING)
        for column in ("s", "p", "p_c", "h", "Q", "V"):
            one, other = getattr(surface, column), getattr(other_surface, column)
            np.testing.assert_allclose(other, one, rtol=0, atol=1e-8 * np.abs(one).max(),
                                       err_msg=column)
        for field in ("displacement", "pressure", "jacobian", "von_mises", "flux"):
            one, other = getattr(fields, field), getattr(other_fields, field)
            np.testing.assert_allclose(other, one, rtol=0, atol=1e-8 * np.abs(one).max(),
                                       err_msg=field)
