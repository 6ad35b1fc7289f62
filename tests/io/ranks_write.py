"""Run by mpirun: write made-up fields, frames and a checkpoint from blocks, read them back.

Arguments: the directory to write; optionally a limit of file sizes in bytes on the last rank.
"""

import resource
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from mpi4py import MPI

import porolub.io.frame_files as frame_files
from porolub.errors import PorolubError
from porolub.io.checkpoint import read_checkpoint, write_checkpoint
from porolub.io.fields import write_fields
from porolub.io.frames import FrameWriter
from porolub.solve.natural import bounds
from porolub.solve.report import FieldData, FrameData, Resume, StateData
from tests.io.body import body, body_surface
from tests.io.resume import made_up

COMM = MPI.COMM_WORLD


def mine(rows: np.ndarray) -> np.ndarray:
    """This rank's block of rows that all ranks have."""
    first = bounds(len(rows), COMM.size)
    return rows[first[COMM.rank] : first[COMM.rank + 1]]


def block_of_fields(fields: FieldData) -> FieldData:
    return replace(fields, **{name: mine(value) for name, value in vars(fields).items()
                              if isinstance(value, np.ndarray)})  # fmt: skip


def block_of_state(state: StateData) -> StateData:
    """As a solver's: rows by the block of their node numbers."""
    first = bounds(len(state.mesh_nodes), COMM.size)
    fields = {}
    for name, (nodes, values) in state.fields.items():
        here = (nodes >= first[COMM.rank]) & (nodes < first[COMM.rank + 1])
        fields[name] = (nodes[here], values[here]) if len(nodes) else (nodes, values)
    return replace(state, fields=fields, mesh_nodes=mine(state.mesh_nodes))


def write(out: Path) -> None:
    resume = made_up(nodes=60_000, states=3)  # three pieces of its check sum
    blocks = replace(resume, states=tuple(map(block_of_state, resume.states)))
    fields, surface = body(), body_surface() if COMM.rank == 0 else None
    write_fields(out, block_of_fields(fields), 0.5, COMM)
    for name, most in (("packed", 10**6), ("large", 0)):
        frame_files.MOST_PACKED = most
        if COMM.rank == 0:
            (out / name).mkdir()
        COMM.barrier()
        writer = FrameWriter(out / name, comm=COMM)
        for k in range(2):
            writer.write(FrameData(k, k / 3, block_of_fields(fields), surface))
        again = FrameWriter(out / name, first=1, comm=COMM)  # as a restart does
        again.write(FrameData(1, 1 / 3, block_of_fields(fields), surface))
    write_checkpoint(out / "checkpoint.h5", blocks, "number = 1", "digest", COMM)
    check(resume, *read_checkpoint(out / "checkpoint.h5", COMM))


def check(resume: Resume, found: Resume, tables: dict[str, int]) -> None:
    assert tables == {"number": 1}
    assert replace(found, states=()) == replace(resume, states=())
    for state, expected in zip(found.states, resume.states, strict=True):
        np.testing.assert_array_equal(state.mesh_nodes, mine(expected.mesh_nodes))
        for name, (nodes, values) in expected.fields.items():
            scalar = not len(nodes)
            np.testing.assert_array_equal(state.fields[name][0], nodes if scalar else mine(nodes))
            np.testing.assert_array_equal(state.fields[name][1], values if scalar else mine(values))


def main() -> None:
    if len(sys.argv) > 2 and COMM.rank == COMM.size - 1:
        resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]),) * 2)
    try:
        write(Path(sys.argv[1]))
    except (PorolubError, OSError) as error:
        print(f"rank {COMM.rank}: {type(error).__name__}: {error}", flush=True)


main()
