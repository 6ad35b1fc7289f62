"""HDF5 files made in memory and written as bytes.

A full disk is then an error of Python like any other. HDF5 itself, unable to write, keeps its
buffers and crashes the process at its end (h5py issue 914; seen with HDF5 1.10.8).
"""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py


@contextmanager
def new_hdf5(path: Path) -> Iterator[h5py.File]:
    """Yield an empty file; when the block ends well it is written to ``path``. Raises OSError."""
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        yield file
    path.write_bytes(buffer.getbuffer())
