"""Rows of a made-up sweep, as a journal holds them."""

from typing import Any

import numpy as np

from porolub.study.plan.axis import Axis
from porolub.study.plan.definition import Sweep

APPROACHES = {"0 um": 0.0, "5 um": 5e-6, "20 um": 2e-5, "50 um": 5e-5}
GRADINGS = ("none", "contact")

SUMMARY: dict[str, Any] = {
    "status": "converged",
    "message": "converged",
    "load_total": 1500.1,
    "load_ratio": None,
    "friction_coefficient": 1 / 7,
    "approach": 2e-5,
    "contact_left": None,
    "effects": ["solid", "film"],
    "dofs": {"displacement": 130, "total": 165},
    "ranks": 2,
    "newton_iterations": 7,
    "wall_time": {"setup": 0.4, "total": 1.2},
    "peak_memory": 577826816,
    "versions": {"python": "3.11.2"},
}
"""A part of what a summary has."""


def sweep(*axes: Axis) -> Sweep:
    """A sweep over approach and grading, or over other axes."""
    numbers = np.array(list(APPROACHES.values()))
    usual = (
        Axis("approach", ("load.approach",), tuple((t,) for t in APPROACHES), numbers, "m", "log"),
        Axis("grading", ("mesh.grading",), tuple((t,) for t in GRADINGS)),
    )
    return Sweep('Curves, "two" of them', {}, axes or usual)


def row(case: int, status: str = "converged", **summary: Any) -> dict[str, Any]:
    """The row of a case of ``sweep()``; ``summary`` changes that of a converged one."""
    converged = status == "converged"
    k, j = divmod(case, len(GRADINGS))
    text, approach = list(APPROACHES.items())[k]
    return {
        "key": f"key {case}",
        "case": case,
        "status": status,
        "message": "converged" if converged else 'It "failed",\nor so it says.',
        "axes": {"approach": approach, "grading": GRADINGS[j]},
        "values": {"load.approach": text, "mesh.grading": GRADINGS[j]},
        "sommerfeld_number": 6.67e-8 if converged else None,
        "regime": "mixed" if converged else "",
        "start": "cases 3, 5" if case > 1 else "zero",
        "wall": 1.25,
        "summary": SUMMARY | summary if converged else {},
    }
