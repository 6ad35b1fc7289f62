"""HDF5 files whose rows lie on many ranks, written without HDF5 touching the disk.

Rank 0 makes the file's structure with HDF5 in memory, where large datasets are only places; then
every rank writes its rows there itself.  So no rank holds more than its own, the bytes do not
depend on the number of ranks, and a full disk is an error of Python like any other: HDF5 itself,
unable to write, keeps its buffers and crashes the process at its end (h5py issue 914; seen with
HDF5 1.10.8), on one of many ranks with all the others waiting.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from porolub.io.sparse import SparseFile
from porolub.together import ALONE, on_each, on_root

Rows = NDArray[Any]
_AT_ONCE = 1 << 30  # bytes; the operating system writes no more than 2 GB at a time
PACKED = {"compression": "gzip", "compression_opts": 1, "shuffle": True}  # more gains little


@dataclass
class Dataset:
    """What is known of a dataset before there is a file: as much as a description needs."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    attrs: dict[str, Any]
    rows: Rows | None  # this rank's; None where rank 0 has ``whole``
    first: int = 0
    axis: int = 0
    whole: Rows | None = None
    packed: bool = False


@dataclass
class NewFile:
    """An HDF5 file that is being put together; the same names on all ranks."""

    comm: Any
    attrs: dict[str, Any] = field(default_factory=dict)
    groups: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Attributes of groups by name."""
    datasets: dict[str, Dataset] = field(default_factory=dict)

    def rows(self, name: str, rows: Rows, dtype: str, axis: int = 0, **attrs: str) -> None:
        """Add a dataset of which each rank has a part along ``axis`` (0 or 1), one after the
        other. Collective."""
        rows = np.ascontiguousarray(rows, dtype=dtype)
        mine = rows.shape[axis]
        first = int(self.comm.scan(mine)) - mine
        count = int(self.comm.allreduce(mine))
        shape = (*rows.shape[:axis], count, *rows.shape[axis + 1 :])
        self.datasets[name] = Dataset(shape, rows.dtype, attrs, rows, first, axis)

    def packed(self, name: str, rows: Rows, dtype: str, **attrs: str) -> None:
        """As ``rows`` along axis 0, compressed: rank 0 collects all of it. Collective."""
        parts = self.comm.gather(np.asarray(rows, dtype=dtype), root=0)
        whole = None if parts is None else np.concatenate(parts)
        self.whole(name, whole, packed=True, **attrs)

    def whole(self, name: str, values: Any, *, packed: bool = False, **attrs: str) -> None:
        """Add a dataset that rank 0 has; the others give None."""
        values = np.asarray([] if values is None else values)
        self.datasets[name] = Dataset(
            values.shape, values.dtype, attrs, None, whole=values, packed=packed
        )

    def __getitem__(self, name: str) -> Dataset:
        return self.datasets[name]


@contextmanager
def new_hdf5(path: Path, comm: Any = ALONE, user_block: int = 0) -> Iterator[NewFile]:
    """Yield an empty file; when the block ends well it is written to ``path``. Collective.

    ``user_block``: zero bytes in front that are no HDF5. The block must end alike on all ranks.
    Raises OSError, on all ranks where one of them cannot write.
    """
    new = NewFile(comm)
    yield new
    places = on_root(comm, lambda: _write_structure(path, new, user_block))
    on_each(comm, lambda: _write_rows(path, new, places))


def _write_structure(path: Path, new: NewFile, user_block: int) -> dict[str, int]:
    """Write all but the rows; return where these go."""
    places = {}
    memory = SparseFile()
    with h5py.File(memory, "w", userblock_size=user_block) as file:
        file.attrs.update(new.attrs)
        for name, attrs in new.groups.items():
            file.require_group(name).attrs.update(attrs)
        for name, data in new.datasets.items():
            if data.rows is None:
                file.create_dataset(name, data=data.whole, **(PACKED if data.packed else {}))
            else:
                places[name] = _reserve(file, name, data)
            file[name].attrs.update(data.attrs)
    memory.save(path)
    return places


def _reserve(file: h5py.File, name: str, data: Dataset) -> int:
    """Make room for a dataset in one piece; return where it is."""
    how = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    how.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
    how.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
    how.set_obj_track_times(False)
    link = h5py.h5p.create(h5py.h5p.LINK_CREATE)
    link.set_create_intermediate_group(True)
    space = h5py.h5s.create_simple(data.shape)
    made = h5py.h5d.create(file.id, name.encode(), h5py.h5t.py_create(data.dtype), space, how, link)
    return int(made.get_offset() or 0)


def _write_rows(path: Path, new: NewFile, places: dict[str, int]) -> None:
    """Write this rank's rows."""
    descriptor = os.open(path, os.O_WRONLY)
    try:
        for name, place in places.items():
            data = new.datasets[name]
            assert data.rows is not None
            for start, rows in _pieces(data):
                _write_at(descriptor, place + start, rows)
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _pieces(data: Dataset) -> Iterator[tuple[int, Rows]]:
    """Contiguous pieces of this rank's rows and where in the dataset they begin, in bytes."""
    assert data.rows is not None
    rows, size = data.rows, data.dtype.itemsize
    if not rows.size:
        return
    if data.axis == 1:
        width = int(np.prod(data.shape[2:], dtype=np.int64)) * size
        for k, part in enumerate(rows):
            yield (k * data.shape[1] + data.first) * width, part
    else:
        yield data.first * int(np.prod(data.shape[1:], dtype=np.int64)) * size, rows


def _write_at(descriptor: int, place: int, rows: Rows) -> None:
    data = rows.data.cast("B")
    while data:
        written = os.pwrite(descriptor, data[:_AT_ONCE], place)
        data, place = data[written:], place + written
