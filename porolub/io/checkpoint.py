"""checkpoint.h5: the unknowns themselves, in an order that no partition changes.

For each field: the natural numbers of the mesh nodes that carry it and its values in SI
(Cartesian components); scalars as single values; the scene as TOML and its digest, so that a
state is never continued with another scene by mistake.
"""

from __future__ import annotations

from pathlib import Path

import h5py

from porolub.errors import SceneError
from porolub.io.atomic import replacing
from porolub.scene import Scene
from porolub.solve.report import StateData

VERSION = 1


def write_checkpoint(path: Path, state: StateData, scene: Scene, scene_toml: str) -> None:
    """Write a state. Raises OSError."""
    with replacing(path) as (temporary,), h5py.File(temporary, "w") as file:
        file.attrs.update(version=VERSION, time=state.time, digest=scene.digest(), scene=scene_toml)
        for name, (nodes, values) in state.fields.items():
            group = file.create_group(name)
            group.create_dataset("nodes", data=nodes, dtype="i8")
            data = group.create_dataset("values", data=values, dtype="f8")
            data.attrs["unit"] = state.units[name]
        file.create_dataset("mesh_nodes", data=state.mesh_nodes, dtype="f8").attrs["unit"] = "m"


def read_checkpoint(path: Path) -> tuple[StateData, str]:
    """Read a state and the digest of its scene. Raises SceneError for a missing or alien file."""
    if not path.is_file():
        raise SceneError(f"{path}: there is no checkpoint here.")
    try:
        with h5py.File(path, "r") as file:
            if file.attrs["version"] != VERSION:
                raise SceneError(f"{path}: checkpoint version {file.attrs['version']} is not "
                                 f"{VERSION}, the one this porolub reads.")
            groups = {k: g for k, g in file.items() if isinstance(g, h5py.Group)}
            fields = {k: (g["nodes"][()], g["values"][()]) for k, g in groups.items()}
            units = {k: str(g["values"].attrs["unit"]) for k, g in groups.items()}
            state = StateData(float(file.attrs["time"]), fields, units, file["mesh_nodes"][()])
            return state, str(file.attrs["digest"])
    except (OSError, KeyError) as error:
        raise SceneError(f"{path}: this is no readable checkpoint ({error}).") from error
