"""Pictures of a run: frames/frame_0000.h5 and so on, their mesh, and series.xdmf for ParaView.

A frame holds u, p, J, von_mises and flux as fields.h5 does, in single precision and compressed,
and in the group ``surface`` the columns of surface.csv; attributes ``time`` (s) and ``number``.
frames/mesh.h5 holds nodes and cells of all of them. series.xdmf shows the frames as one series in
time; meshio reads it with meshio.xdmf.TimeSeriesReader.
"""

import re
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import replacing, reported
from porolub.io.fields import UNITS, get_fields, get_mesh, point_data, put_mesh
from porolub.io.hdf5 import new_hdf5
from porolub.io.surface import COLUMNS
from porolub.io.xdmf import add_collection, add_grid, new_domain, write_document
from porolub.solve.report import Array, FieldData, FrameData, SurfaceData

FOLDER = "frames"
MESH = "mesh.h5"
SERIES = "series.xdmf"
_NAME = re.compile(r"frame_(\d{4,})\.h5")
_SAME_PLACE = 1e-9  # of the mesh's size
_PACKED = {"compression": "gzip", "compression_opts": 1, "shuffle": True}  # more gains little


class FrameWriter:
    """Writes frames into an output directory; the series is up to date after each of them."""

    def __init__(self, directory: Path, first: int = 0) -> None:
        """Go on with frame number ``first``; frames from there on are taken away: all with 0.

        Raises SceneError where a frame that stays is damaged and SolveError where the directory
        cannot be written.
        """
        self._directory = directory
        self._times = {n: _time(path) for n, path in _frames(directory).items() if n < first}
        self._mesh = _mesh(directory) if self._times else None
        with reported(directory, "the frames"):
            if self._times:
                _write_series(directory, self._times)
            remove_frames(directory, first)

    def write(self, frame: FrameData) -> None:
        """Write a frame; one of the same number is replaced.

        Raises SceneError where earlier frames are of another mesh, SolveError where the frame
        cannot be written.
        """
        path = self._directory / FOLDER / _name(frame.number)
        with reported(path):
            path.parent.mkdir(exist_ok=True)
            self._keep_mesh(frame.fields)
            with replacing(path) as (temporary,), new_hdf5(temporary) as file:
                _put(file, frame)
            self._times[frame.number] = frame.time
            _write_series(self._directory, self._times)

    def _keep_mesh(self, fields: FieldData) -> None:
        path = self._directory / FOLDER / MESH
        if self._mesh is None:
            with replacing(path) as (temporary,), new_hdf5(temporary) as file:
                put_mesh(file, fields)
            self._mesh = {"nodes": fields.nodes, "cells": fields.cells}
        elif not _same_mesh(self._mesh, fields):
            raise SceneError(
                f"{path}: the frames so far are of another mesh than this run's; move them away."
            )


class Frames:
    """The frames of a run in the order of time; each is read when it is asked for."""

    def __init__(self, directory: Path) -> None:
        """Raises SceneError where there are none or one is damaged."""
        self._directory = directory
        self._paths = [path for _, path in sorted(_frames(directory).items())]
        if not self._paths:
            raise SceneError(f"{directory}: there are no frames of a transient run here.")
        self.times: Array = np.array([_time(path) for path in self._paths])

    def __len__(self) -> int:
        return len(self._paths)

    def __iter__(self) -> Iterator[FrameData]:
        return (self.load(k) for k in range(len(self)))

    def load(self, k: int) -> FrameData:
        """Read frame k; all share the arrays of the mesh. Raises SceneError for a damaged one."""
        try:
            with h5py.File(self._paths[k], "r") as file:
                return _get(file, self._mesh)
        except (OSError, KeyError, ValueError) as error:
            raise _damaged(self._paths[k]) from error

    @cached_property
    def _mesh(self) -> dict[str, Any]:
        return _mesh(self._directory)


def read_frames(directory: Path) -> Frames:
    """Open the frames of an output directory. Raises SceneError where there are none."""
    return Frames(directory)


def remove_frames(directory: Path, first: int = 0) -> None:
    """Take away the frames from number ``first`` on; with 0 the series and the mesh too.

    Raises OSError.
    """
    folder = directory / FOLDER
    if first == 0:
        (directory / SERIES).unlink(missing_ok=True)  # before what it refers to
        (directory / f".{SERIES}.tmp").unlink(missing_ok=True)
    for number, path in _frames(directory).items():
        if number >= first:
            path.unlink()
    for left_over in folder.glob(".*.h5.tmp"):  # of a write that was killed
        left_over.unlink()
    if first == 0:
        (folder / MESH).unlink(missing_ok=True)
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()


def _write_series(directory: Path, times: dict[int, float]) -> None:
    """Describe all frames as a series; all have the datasets of one of them."""
    root, domain = new_domain()
    collection = add_collection(domain, "layer")
    folder = directory / FOLDER
    with (
        h5py.File(folder / MESH, "r") as mesh,
        h5py.File(folder / _name(max(times)), "r") as file,
        replacing(directory / SERIES) as (temporary,),
    ):
        names = [name for name in UNITS if name in file]
        for number, time in sorted(times.items()):
            data = (f"{FOLDER}/{_name(number)}", file)
            add_grid(collection, _name(number), (f"{FOLDER}/{MESH}", mesh), data, names, time)
        write_document(root, temporary)


def _put(file: h5py.File, frame: FrameData) -> None:
    file.attrs.update(time=frame.time, number=frame.number)
    for name, values in point_data(frame.fields).items():
        file.create_dataset(name, data=values, dtype="f4", **_PACKED).attrs["unit"] = UNITS[name]
    if frame.surface is not None:
        for name in COLUMNS:
            values = getattr(frame.surface, name)
            file.create_dataset(f"surface/{name}", data=values, dtype="f8", **_PACKED)


def _get(file: h5py.File, mesh: dict[str, Any]) -> FrameData:
    profiles = [file["surface"][name][()] for name in COLUMNS] if "surface" in file else None
    return FrameData(
        number=int(file.attrs["number"]),
        time=float(file.attrs["time"]),
        fields=get_fields(mesh, file),
        surface=None if profiles is None else SurfaceData(*profiles),
    )


def _name(number: int) -> str:
    return f"frame_{number:04d}.h5"


def _frames(directory: Path) -> dict[int, Path]:
    """The frames there are by number."""
    found = {path: _NAME.fullmatch(path.name) for path in (directory / FOLDER).glob("frame_*.h5")}
    return {int(match[1]): path for path, match in found.items() if match}


def _time(path: Path) -> float:
    try:
        with h5py.File(path, "r") as file:
            return float(file.attrs["time"])
    except (OSError, KeyError, ValueError) as error:
        raise _damaged(path) from error


def _mesh(directory: Path) -> dict[str, Any]:
    path = directory / FOLDER / MESH
    try:
        with h5py.File(path, "r") as file:
            return get_mesh(file)
    except (OSError, KeyError, ValueError) as error:
        raise _damaged(path) from error


def _damaged(path: Path) -> SceneError:
    return SceneError(f"{path}: this file is missing, damaged or was not written by porolub.")


def _same_mesh(mesh: dict[str, Any], fields: FieldData) -> bool:
    if mesh["nodes"].shape != fields.nodes.shape or mesh["cells"].shape != fields.cells.shape:
        return False
    limit = _SAME_PLACE * np.ptp(fields.nodes, axis=0).max()
    near = np.abs(mesh["nodes"] - fields.nodes).max() <= limit
    return bool(near) and np.array_equal(mesh["cells"], fields.cells)
