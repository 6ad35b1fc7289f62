"""checkpoint.h5: all a run needs to go on, in an order that no partition changes.

An HDF5 file whose first 512 bytes (HDF5's user block) are a line with the version and one with
the SHA-256 of all that follows, so that a damaged file is known before HDF5 looks into it::

    attributes        step (s), frame, digest of the scene
    scene             the resolved scene as TOML (UTF-8 bytes)
    time, order       (states,) of each state, newest first; order 0: no step led there
    mesh_nodes        (n, dim) m
    fields/NAME       nodes (k,): natural numbers of the mesh nodes that carry the field;
                      values (states, k, components) with attribute unit; scalars have no nodes
    edges             (m,) arc positions, m
    totals            attributes: running sums by name
"""

import hashlib
import io
import re
import tomllib
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import replacing, reported
from porolub.solve.report import Resume, StateData

VERSION = 2
_USER_BLOCK = 512  # bytes, the smallest HDF5 knows
_HEADER = re.compile(rb"porolub checkpoint (\d+)\n([0-9a-f]{64})\n")


def write_checkpoint(path: Path, resume: Resume, scene_toml: str, digest: str) -> None:
    """Write what a run goes on from; whenever it is interrupted, the old file or the new is there.

    scene_toml, digest: the resolved scene and its hash. All states have the same mesh and fields
    (ValueError otherwise). Raises SolveError where the file cannot be written.
    """
    _refuse_unequal(resume)
    buffer = io.BytesIO()  # not HDF5 writes to the disk but we do: see porolub.io.hdf5
    with h5py.File(buffer, "w", userblock_size=_USER_BLOCK) as file:
        _put(file, resume)
        file.attrs["digest"] = digest
        file["scene"] = np.frombuffer(scene_toml.encode(), dtype="u1")
    data = buffer.getbuffer()
    header = f"porolub checkpoint {VERSION}\n{_sum(data)}\n".encode()
    data[: len(header)] = header
    with reported(path), replacing(path) as (temporary,):
        temporary.write_bytes(data)


def read_checkpoint(path: Path) -> tuple[Resume, dict[str, Any]]:
    """Read what to go on from and the tables of the resolved scene.

    Raises SceneError for a file that is missing, damaged, no checkpoint or of another version.
    """
    data = _read(path)
    try:
        with h5py.File(io.BytesIO(data), "r") as file:
            return _get(file), tomllib.loads(file["scene"][()].tobytes().decode())
    except (OSError, KeyError, ValueError) as error:
        raise SceneError(f"{path}: this is no complete checkpoint ({error}).") from error


def read_digest(path: Path) -> str:
    """Read the hash of the scene the checkpoint belongs to. Raises as read_checkpoint."""
    data = _read(path)
    with h5py.File(io.BytesIO(data), "r") as file:
        return str(file.attrs["digest"])


def _put(file: h5py.File, resume: Resume) -> None:
    file.attrs.update(step=resume.step, frame=resume.frame)
    file["time"] = np.array([state.time for state in resume.states])
    file["order"] = np.array(resume.orders, dtype="i8")
    file["edges"] = np.array(resume.edges, dtype=float)
    file.create_group("totals").attrs.update(resume.totals)
    newest = resume.states[0]
    file["mesh_nodes"] = newest.mesh_nodes
    for name, (nodes, _) in newest.fields.items():
        group = file.create_group(f"fields/{name}")
        group["nodes"] = np.asarray(nodes, dtype="i8")
        group["values"] = np.stack([state.fields[name][1] for state in resume.states])
        group["values"].attrs["unit"] = newest.units[name]


def _get(file: h5py.File) -> Resume:
    groups = dict(file["fields"].items())
    nodes = {name: group["nodes"][()] for name, group in groups.items()}
    values = {name: group["values"][()] for name, group in groups.items()}
    units = {name: str(group["values"].attrs["unit"]) for name, group in groups.items()}
    mesh_nodes = file["mesh_nodes"][()]
    states = tuple(
        StateData(
            float(time),
            {name: (nodes[name], values[name][k]) for name in groups},
            units,
            mesh_nodes,
        )
        for k, time in enumerate(file["time"][()])
    )
    return Resume(
        states=states,
        orders=tuple(file["order"][()].tolist()),
        step=float(file.attrs["step"]),
        frame=int(file.attrs["frame"]),
        edges=tuple(file["edges"][()].tolist()),
        totals={name: float(value) for name, value in file["totals"].attrs.items()},
    )


def _refuse_unequal(resume: Resume) -> None:
    """What is stored once must be the same in all states."""
    newest = resume.states[0]
    same = len(resume.orders) == len(resume.states)
    for state in resume.states[1:]:
        same = same and state.fields.keys() == newest.fields.keys() and state.units == newest.units
        same = same and np.array_equal(state.mesh_nodes, newest.mesh_nodes)
        same = same and all(
            np.array_equal(nodes, newest.fields[name][0])
            for name, (nodes, _) in state.fields.items()
        )
    if not same:
        raise ValueError("the states of a checkpoint differ in their mesh, fields or number")


def _read(path: Path) -> bytes:
    """The bytes of a file that is a checkpoint of this version and as it was written."""
    if not path.is_file():
        raise SceneError(f"{path}: there is no checkpoint here.")
    try:
        data = path.read_bytes()
    except OSError as error:
        reason = error.strerror or error
        raise SceneError(f"{path}: the checkpoint cannot be read ({reason}).") from error
    header = _HEADER.match(data)
    if header is None:
        raise SceneError(f"{path}: this is no checkpoint that this porolub could read.")
    version = int(header[1])
    if version != VERSION:
        raise SceneError(
            f"{path}: this checkpoint is of version {version}; this porolub reads {VERSION}."
        )
    if header[2].decode() != _sum(memoryview(data)):
        raise SceneError(f"{path}: this checkpoint is damaged.")
    return data


def _sum(data: memoryview) -> str:
    return hashlib.sha256(data[_USER_BLOCK:]).hexdigest()
