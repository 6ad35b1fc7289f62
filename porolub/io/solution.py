"""A solution that other scenes start from (HDF5): fields on a structured mesh, in SI.

::

    attributes     length of the lubricated surface (m)
    ticks/K        logical positions of the vertices along axis K
    edges          (m,) arc positions, m
    marks          attributes: arc positions by name, m
    scalars        attributes: values by name
    rows/NAME      (k, components) of each field, by the numbers of its nodes

Each rank writes and reads its block of the rows.
"""

from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import replacing, reported
from porolub.io.hdf5 import new_hdf5
from porolub.solve.natural import bounds
from porolub.solve.neighbours import Solution
from porolub.solve.transfer import Snapshot
from porolub.together import ALONE, on_each

# what h5py raises for files that are none, end early, or hold something else
DAMAGED = (OSError, LookupError, ValueError, TypeError, AttributeError, RuntimeError)


def write_solution(path: Path, solution: Solution, comm: Any = ALONE) -> None:
    """Write a solution; each rank gives its block. Collective.

    Raises SolveError where it cannot be written.
    """
    data = solution.data
    with (
        reported(path),
        replacing(path, comm=comm) as (temporary,),
        new_hdf5(temporary, comm) as file,
    ):
        file.attrs["length"] = solution.length
        file.whole("edges", np.array(solution.edges, dtype=float))
        for axis, line in enumerate(data.ticks):
            file.whole(f"ticks/{axis}", line)
        file.groups["marks"] = dict(solution.marks)
        file.groups["scalars"] = dict(data.scalars)
        for name, rows in data.rows.items():
            file.rows(f"rows/{name}", rows, "f8")


def read_solution(path: Path, comm: Any = ALONE) -> Solution:
    """Read a solution, each rank its block. Collective.

    Raises SceneError for a file that is missing, damaged or no such file.
    """

    def mine(rows: h5py.Dataset) -> Any:
        first = bounds(rows.shape[0], comm.size)
        return rows[first[comm.rank] : first[comm.rank + 1]]

    def read() -> Solution:
        try:
            with h5py.File(path, "r") as file:
                ticks = tuple(file[f"ticks/{axis}"][()] for axis in range(len(file["ticks"])))
                rows = {name: mine(block) for name, block in file["rows"].items()}
                scalars, marks = (
                    {name: float(value) for name, value in file[group].attrs.items()}
                    for group in ("scalars", "marks")
                )
                data = Snapshot(ticks, rows, scalars, comm.size > 1)
                edges = tuple(file["edges"][()].tolist())
                return Solution(data, float(file.attrs["length"]), edges, marks)
        except DAMAGED as error:
            raise SceneError(f"{path}: this is no solution to start from ({error}).") from error

    solution: Solution = on_each(comm, read)
    return solution
