"""From the tables of a scene to its solution, on the path `porolub run` takes."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from mpi4py import MPI

from porolub.scene import scene_from_dict
from porolub.solve.derived import scalars
from porolub.solve.gather import gather_fields, gather_surface
from porolub.solve.report import FieldData, SurfaceData
from porolub.solve.steady import Outcome, SteadySolver


@dataclass
class Solved:
    """A converged steady state, in SI."""

    outcome: Outcome

    @cached_property
    def values(self) -> dict[str, Any]:
        """The scalars of summary.json."""
        return scalars(self.outcome.model, self.outcome.x)

    @cached_property
    def surface(self) -> SurfaceData:
        """Profiles along the lubricated surface."""
        found = gather_surface(self.outcome.model, self.outcome.x)
        assert found is not None
        return found

    @cached_property
    def fields(self) -> FieldData:
        """Fields on all nodes."""
        found = gather_fields(self.outcome.model, self.outcome.x)
        assert found is not None
        return found


def solved(tables: dict[str, Any], base_dir: Path | None = None) -> Solved:
    """Solve a scene; fails the test with the solver's own sentence if it does not converge."""
    outcome = SteadySolver(scene_from_dict(tables, base_dir), MPI.COMM_SELF).solve()
    assert outcome.converged, outcome.message
    return Solved(outcome)
