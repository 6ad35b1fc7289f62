"""What a frame of a run consists of, where it lies, and how the series names it.

A frame holds u, p, J, von_mises and flux as fields.h5 does, in single precision (compressed, unless
the mesh is large), and in the group ``surface`` the columns of surface.csv or, of a body, the data
of surface.h5; attributes ``time`` (s) and ``number``. frames/mesh.h5 holds nodes and cells of all
of them.
"""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import replacing
from porolub.io.fields import UNITS, get_fields, get_mesh, point_data
from porolub.io.hdf5 import NewFile
from porolub.io.surface import COLUMNS
from porolub.io.surface_map import UNITS as SURFACE_UNITS
from porolub.io.surface_map import get_surface, get_surface_mesh
from porolub.io.xdmf import add_collection, add_grid, new_domain, write_document
from porolub.solve.report import FieldData, FrameData, SurfaceData, SurfaceMap
from porolub.together import ALONE

FOLDER = "frames"
MESH = "mesh.h5"
SERIES = "series.xdmf"
SURFACE_SERIES = "surface_series.xdmf"
MOST_PACKED = 250_000
"""Nodes of the largest mesh whose frames rank 0 collects, to compress them."""
_NAME = re.compile(r"frame_(\d{4,})\.h5")
_SAME_PLACE = 1e-9  # of the mesh's size


def write_series(directory: Path, times: dict[int, float]) -> None:
    """Describe all frames as a series, and their surfaces as one where these are maps; all have
    the datasets of one of them."""
    folder = directory / FOLDER
    with (
        h5py.File(folder / MESH, "r") as mesh,
        h5py.File(folder / name_of(max(times)), "r") as file,
    ):
        _write_one_series(directory / SERIES, "layer", times, mesh, file, UNITS)
        if "surface" in mesh:
            path = directory / SURFACE_SERIES
            _write_one_series(path, "surface", times, mesh, file, SURFACE_UNITS)


def _write_one_series(path: Path, name: str, times: dict[int, float], mesh: h5py.File,
                      file: h5py.File, names: Iterable[str]) -> None:  # fmt: skip
    root, domain = new_domain()
    collection = add_collection(domain, name)
    place = "" if name == "layer" else f":/{name}"
    if place:
        mesh, file = mesh[name], file[name]
    names = [key for key in names if key in file]
    for number, time in sorted(times.items()):
        data = (f"{FOLDER}/{name_of(number)}{place}", file)
        add_grid(collection, name_of(number), (f"{FOLDER}/{MESH}{place}", mesh), data, names, time)
    with replacing(path) as (temporary,):
        write_document(root, temporary)


def put_frame(file: NewFile, frame: FrameData) -> None:
    """Add all of a frame but its mesh. Collective."""
    file.attrs.update(time=frame.time, number=frame.number)
    data = point_data(frame.fields)
    # as the size of the mesh has it, not the ranks
    small = file.comm.allreduce(len(frame.fields.nodes)) <= MOST_PACKED
    for name, values in data.items():
        (file.packed if small else file.rows)(name, values, "f4", unit=UNITS[name])
    names = file.comm.bcast(_columns(frame.surface), root=0)
    for name in names:
        column = None if frame.surface is None else getattr(frame.surface, name)
        file.whole(f"surface/{name}", column, packed=True)


def _columns(surface: SurfaceData | SurfaceMap | None) -> tuple[str, ...]:
    if surface is None:
        return ()
    return COLUMNS if isinstance(surface, SurfaceData) else tuple(SURFACE_UNITS)


def get_frame(file: h5py.File, mesh: dict[str, Any]) -> FrameData:
    """Return a frame on what mesh_of gave. Raises OSError, KeyError or ValueError."""
    layer = {name: value for name, value in mesh.items() if name != "surface"}
    return FrameData(
        number=int(file.attrs["number"]),
        time=float(file.attrs["time"]),
        fields=get_fields(layer, file),
        surface=_get_surface(file, mesh),
    )


def _get_surface(file: h5py.File, mesh: dict[str, Any]) -> SurfaceData | SurfaceMap | None:
    if "surface" not in file:
        return None
    group = file["surface"]
    if mesh["surface"] is not None:
        return get_surface(mesh["surface"], group)
    return SurfaceData(*(group[name][()] for name in COLUMNS))


def name_of(number: int) -> str:
    """File name of a frame."""
    return f"frame_{number:04d}.h5"


def frame_paths(directory: Path) -> dict[int, Path]:
    """The frames there are by number."""
    found = {path: _NAME.fullmatch(path.name) for path in (directory / FOLDER).glob("frame_*.h5")}
    return {int(match[1]): path for path, match in found.items() if match}


def time_of(path: Path) -> float:
    """Time of a frame, s. Raises SceneError where the file is damaged."""
    try:
        with h5py.File(path, "r") as file:
            return float(file.attrs["time"])
    except (OSError, KeyError, ValueError) as error:
        raise damaged(path) from error


def mesh_of(directory: Path, comm: Any = ALONE) -> dict[str, Any]:
    """This rank's block of the frames' mesh; ``surface``: that of a body's surface or None."""
    path = directory / FOLDER / MESH
    try:
        with h5py.File(path, "r") as file:
            surface = get_surface_mesh(file["surface"]) if "surface" in file else None
            return {**get_mesh(file, comm), "surface": surface}
    except (OSError, KeyError, ValueError) as error:
        raise damaged(path) from error


def damaged(path: Path) -> SceneError:
    """The sentence for a file that cannot be read."""
    return SceneError(f"{path}: this file is missing, damaged or was not written by porolub.")


def same_mesh(mesh: dict[str, Any], fields: FieldData, comm: Any) -> bool:
    """Whether this rank's block of fields is on that of the mesh, but for rounding. Collective."""
    low = min(comm.allgather(fields.nodes.min(initial=np.inf)))
    high = max(comm.allgather(fields.nodes.max(initial=-np.inf)))
    same = mesh["nodes"].shape == fields.nodes.shape and mesh["cells"].shape == fields.cells.shape
    if same:
        apart = np.abs(mesh["nodes"] - fields.nodes).max(initial=0.0)
        same = apart <= _SAME_PLACE * (high - low) and np.array_equal(mesh["cells"], fields.cells)
    return all(comm.allgather(bool(same)))
