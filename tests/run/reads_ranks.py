"""Run by test_mesh_file_ranks.py: `porolub` on a mesh file; each rank says how often it read it."""

import sys
from pathlib import Path
from typing import Any

import meshio
from mpi4py import MPI

from porolub.cli import main

reads = 0
meshio_read, read_bytes = meshio.read, Path.read_bytes


def read(*args: Any, **kwargs: Any) -> Any:
    """As meshio.read."""
    global reads
    reads += 1
    return meshio_read(*args, **kwargs)


def read_all(path: Path) -> bytes:
    """As Path.read_bytes."""
    global reads
    reads += path.suffix == ".msh"
    return read_bytes(path)


meshio.read, Path.read_bytes = read, read_all  # type: ignore[method-assign]
try:
    main()
except SystemExit as end:
    if end.code:
        raise
found = MPI.COMM_WORLD.gather(reads, root=0)
if found is not None:
    print(*found)
    sys.stdout.flush()
