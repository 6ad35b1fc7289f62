"""checkpoint.h5: all a run needs to go on, in an order that no partition changes.

An HDF5 file whose first 512 bytes (HDF5's user block) are a line with the version and one with
a check sum of all that follows, so that a damaged file is known before HDF5 looks into it: the
SHA-256 of the SHA-256 sums of pieces of 1 MiB, which many ranks can share::

    attributes        step (s), frame, digest of the scene
    scene             the resolved scene as TOML (UTF-8 bytes)
    time, order       (states,) of each state, newest first; order 0: no step led there
    mesh_nodes        (n, dim) m
    fields/NAME       nodes (k,): natural numbers of the mesh nodes that carry the field;
                      values (states, k, components) with attribute unit; scalars have no nodes
    edges             (m,) arc positions, m
    totals            attributes: running sums by name

Each rank writes and reads its block of the rows.
"""

import hashlib
import re
import tomllib
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import replacing, reported
from porolub.io.hdf5 import NewFile, new_hdf5
from porolub.solve.natural import bounds
from porolub.solve.report import Resume, StateData
from porolub.together import ALONE, on_each, on_root

VERSION = 3
PIECE = 1 << 20
_USER_BLOCK = 512  # bytes, the smallest HDF5 knows
_HEADER = re.compile(rb"porolub checkpoint (\d+)\n([0-9a-f]{64})\n")


def write_checkpoint(
    path: Path, resume: Resume, scene_toml: str, digest: str, comm: Any = ALONE
) -> None:
    """Write what a run goes on from; whenever it is interrupted, the old file or the new is there.

    scene_toml, digest: the resolved scene and its hash. All states have the same mesh and fields
    (ValueError otherwise). Collective: each rank gives its block; what is not of nodes counts on
    rank 0. Raises SolveError where the file cannot be written.
    """
    if not all(comm.allgather(_alike(resume))):
        raise ValueError("the states of a checkpoint differ in their mesh, fields or number")
    with reported(path), replacing(path, comm=comm) as (temporary,):
        with new_hdf5(temporary, comm, _USER_BLOCK) as file:
            _put(file, resume)
            file.attrs["digest"] = digest
            file.whole("scene", np.frombuffer(scene_toml.encode(), dtype="u1"))
        header = f"porolub checkpoint {VERSION}\n{_sum(temporary, comm)}\n".encode()
        on_root(comm, lambda: _begin_with(temporary, header))


def read_checkpoint(path: Path, comm: Any = ALONE) -> tuple[Resume, dict[str, Any]]:
    """Read what to go on from, each rank its block, and the tables of the resolved scene.

    Collective. Raises SceneError for a file that is missing, damaged, no checkpoint or of another
    version.
    """
    known = on_root(comm, lambda: _header(path))
    try:
        found = _sum(path, comm)
    except OSError as error:
        raise _unreadable(path, error) from error
    if found != known:
        raise SceneError(f"{path}: this checkpoint is damaged.")

    def read() -> tuple[Resume, dict[str, Any]]:
        try:
            with h5py.File(path, "r") as file:
                return _get(file, comm), tomllib.loads(file["scene"][()].tobytes().decode())
        except (OSError, KeyError, ValueError) as error:
            raise SceneError(f"{path}: this is no complete checkpoint ({error}).") from error

    resume, tables = on_each(comm, read)
    return resume, tables


def read_digest(path: Path) -> str:
    """Read the hash of the scene the checkpoint belongs to; whether the rest of the file is as it
    was written is for read_checkpoint to say. Raises SceneError as that does."""
    _header(path)
    try:
        with h5py.File(path, "r") as file:
            return str(file.attrs["digest"])
    except (OSError, KeyError) as error:
        raise SceneError(f"{path}: this is no complete checkpoint ({error}).") from error


def _put(file: NewFile, resume: Resume) -> None:
    file.attrs.update(step=resume.step, frame=resume.frame)
    file.whole("time", np.array([state.time for state in resume.states]))
    file.whole("order", np.array(resume.orders, dtype="i8"))
    file.whole("edges", np.array(resume.edges, dtype=float))
    file.groups["totals"] = dict(resume.totals)
    newest = resume.states[0]
    file.rows("mesh_nodes", newest.mesh_nodes, "f8")
    for name, unit in newest.units.items():
        nodes = np.asarray(newest.fields[name][0], dtype="i8")
        values = np.stack([state.fields[name][1] for state in resume.states])
        if file.comm.allreduce(len(nodes)):
            file.rows(f"fields/{name}/nodes", nodes, "i8")
            file.rows(f"fields/{name}/values", values, "f8", axis=1, unit=unit)
        else:  # a scalar, which all ranks have
            file.whole(f"fields/{name}/nodes", nodes)
            file.whole(f"fields/{name}/values", values, unit=unit)


def _get(file: h5py.File, comm: Any) -> Resume:
    def mine(rows: h5py.Dataset, axis: int = 0) -> slice:
        first = bounds(rows.shape[axis], comm.size)
        return slice(*first[comm.rank : comm.rank + 2].tolist())

    groups = dict(file["fields"].items())
    nodes, values, units = {}, {}, {}
    for name, group in groups.items():
        part = mine(group["nodes"])
        nodes[name] = group["nodes"][part]
        scalar = not group["nodes"].shape[0]
        values[name] = group["values"][()] if scalar else group["values"][:, part]
        units[name] = str(group["values"].attrs["unit"])
    mesh_nodes = file["mesh_nodes"][mine(file["mesh_nodes"])]
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


def _alike(resume: Resume) -> bool:
    """Whether what is stored once is the same in all states."""
    newest = resume.states[0]
    same = len(resume.orders) == len(resume.states)
    for state in resume.states[1:]:
        same = same and state.fields.keys() == newest.fields.keys() and state.units == newest.units
        same = same and np.array_equal(state.mesh_nodes, newest.mesh_nodes)
        same = same and all(
            np.array_equal(nodes, newest.fields[name][0])
            for name, (nodes, _) in state.fields.items()
        )
    return same


def _header(path: Path) -> str:
    """The check sum of a file that is a checkpoint of this version."""
    if not path.is_file():
        raise SceneError(f"{path}: there is no checkpoint here.")
    try:
        with path.open("rb") as file:
            header = _HEADER.match(file.read(_USER_BLOCK))
    except OSError as error:
        raise _unreadable(path, error) from error
    if header is None:
        raise SceneError(f"{path}: this is no checkpoint that this porolub could read.")
    version = int(header[1])
    if version != VERSION:
        raise SceneError(
            f"{path}: this checkpoint is of version {version}; this porolub reads {VERSION}."
        )
    return header[2].decode()


def _unreadable(path: Path, error: OSError) -> SceneError:
    return SceneError(f"{path}: the checkpoint cannot be read ({error.strerror or error}).")


def _begin_with(path: Path, header: bytes) -> None:
    with path.open("r+b") as file:
        file.write(header)


def _sum(path: Path, comm: Any) -> str:
    """The check sum of all but the user block; the ranks share the pieces. Collective."""
    size = on_root(comm, lambda: path.stat().st_size) - _USER_BLOCK
    first = bounds(-(-max(size, 0) // PIECE), comm.size)

    def sums() -> bytes:
        with path.open("rb") as file:
            file.seek(_USER_BLOCK + int(first[comm.rank]) * PIECE)
            mine = range(first[comm.rank], first[comm.rank + 1])
            return b"".join(hashlib.sha256(file.read(PIECE)).digest() for _ in mine)

    parts = comm.gather(on_each(comm, sums), root=0)
    return str(comm.bcast(hashlib.sha256(b"".join(parts)).hexdigest() if parts else "", root=0))
