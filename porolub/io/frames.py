"""Pictures of a run: frames/frame_0000.h5 and so on, and series.xdmf for ParaView.

See porolub.io.frame_files for what they hold. series.xdmf (and, of a body, surface_series.xdmf)
shows the frames as one series in time; meshio reads it with meshio.xdmf.TimeSeriesReader.
"""

from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import replacing, reported
from porolub.io.fields import put_mesh
from porolub.io.frame_files import (
    FOLDER,
    MESH,
    SERIES,
    SURFACE_SERIES,
    damaged,
    frame_paths,
    get_frame,
    mesh_of,
    name_of,
    put_frame,
    same_mesh,
    time_of,
    write_series,
)
from porolub.io.hdf5 import new_hdf5
from porolub.io.surface_map import put_surface_mesh
from porolub.solve.report import Array, FrameData, SurfaceMap
from porolub.together import ALONE, on_each, on_root


class FrameWriter:
    """Writes frames into an output directory; the series is up to date after each of them.

    All of it is collective; the files are as on one rank.
    """

    def __init__(self, directory: Path, first: int = 0, comm: Any = ALONE) -> None:
        """Go on with frame number ``first``; frames from there on are taken away: all with 0.

        Raises SceneError where a frame that stays is damaged and SolveError where the directory
        cannot be written.
        """
        self._directory, self._comm = directory, comm

        def begin() -> dict[int, float]:
            times = {n: time_of(path) for n, path in frame_paths(directory).items() if n < first}
            with reported(directory, "the frames"):
                if times:
                    write_series(directory, times)
                remove_frames(directory, first)
            return times

        self._times: dict[int, float] = on_root(comm, begin)
        self._mesh = on_each(comm, lambda: mesh_of(directory, comm)) if self._times else None

    def write(self, frame: FrameData) -> None:
        """Write a frame; one of the same number is replaced.

        Raises SceneError where earlier frames are of another mesh, SolveError where the frame
        cannot be written.
        """
        path, comm = self._directory / FOLDER / name_of(frame.number), self._comm

        def tell() -> None:
            self._times[frame.number] = frame.time
            write_series(self._directory, self._times)

        with reported(path):
            on_root(comm, lambda: path.parent.mkdir(exist_ok=True))
            self._keep_mesh(frame)
            with replacing(path, comm=comm) as (temporary,), new_hdf5(temporary, comm) as file:
                put_frame(file, frame)
            on_root(comm, tell)

    def _keep_mesh(self, frame: FrameData) -> None:
        path, comm, fields = self._directory / FOLDER / MESH, self._comm, frame.fields
        if self._mesh is None:
            with replacing(path, comm=comm) as (temporary,), new_hdf5(temporary, comm) as file:
                put_mesh(file, fields)
                surface = frame.surface if isinstance(frame.surface, SurfaceMap) else None
                if comm.bcast(surface is not None, root=0):
                    put_surface_mesh(file, surface, "surface")
            self._mesh = {"nodes": fields.nodes, "cells": fields.cells}
        elif not same_mesh(self._mesh, fields, comm):
            raise SceneError(
                f"{path}: the frames so far are of another mesh than this run's; move them away."
            )


class Frames:
    """The frames of a run in the order of time; each is read when it is asked for."""

    def __init__(self, directory: Path) -> None:
        """Raises SceneError where there are none or one is damaged."""
        self._directory = directory
        self._paths = [path for _, path in sorted(frame_paths(directory).items())]
        if not self._paths:
            raise SceneError(f"{directory}: there are no frames of a transient run here.")
        self.times: Array = np.array([time_of(path) for path in self._paths])

    def __len__(self) -> int:
        return len(self._paths)

    def __iter__(self) -> Iterator[FrameData]:
        return (self.load(k) for k in range(len(self)))

    def load(self, k: int) -> FrameData:
        """Read frame k; all share the arrays of the mesh. Raises SceneError for a damaged one."""
        try:
            with h5py.File(self._paths[k], "r") as file:
                return get_frame(file, self._mesh)
        except (OSError, KeyError, ValueError) as error:
            raise damaged(self._paths[k]) from error

    @cached_property
    def _mesh(self) -> dict[str, Any]:
        return mesh_of(self._directory)


def read_frames(directory: Path) -> Frames:
    """Open the frames of an output directory. Raises SceneError where there are none."""
    return Frames(directory)


def remove_frames(directory: Path, first: int = 0) -> None:
    """Take away the frames from number ``first`` on; with 0 the series and the mesh too.

    Raises OSError.
    """
    folder = directory / FOLDER
    if first == 0:
        for series in (SERIES, SURFACE_SERIES):  # before what they refer to
            (directory / series).unlink(missing_ok=True)
            (directory / f".{series}.tmp").unlink(missing_ok=True)
    for number, path in frame_paths(directory).items():
        if number >= first:
            path.unlink()
    for left_over in folder.glob(".*.h5.tmp"):  # of a write that was killed
        left_over.unlink()
    if first == 0:
        (folder / MESH).unlink(missing_ok=True)
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
