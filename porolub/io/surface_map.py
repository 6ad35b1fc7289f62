"""surface.h5 and surface.xdmf: the lubricated surface of a body as a mesh of its own."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import replacing
from porolub.io.hdf5 import NewFile, new_hdf5
from porolub.io.xdmf import add_grid, new_domain, write_document
from porolub.solve.report import SurfaceMap

UNITS = {"p": "Pa", "p_c": "Pa", "h": "m", "Q": "m^2/s", "Q_s": "m^2/s", "Q_z": "m^2/s", "V": "m/s"}
"""SI unit of each dataset that is not of the mesh."""

DATA, INDEX = "surface.h5", "surface.xdmf"


def write_surface_map(directory: Path, surface: SurfaceMap, time: float = 0.0) -> None:
    """Write surface.h5 and surface.xdmf, for ParaView and meshio. Raises OSError.

    Datasets: nodes (n, 3) in the reference configuration, cells (nf, nn), s, p, p_c, h, Q_s, Q_z, V
    (n,) and Q (n, 3) as in SurfaceMap; attribute ``unit`` on each, ``time`` (s), ``cell_type`` and
    ``degree`` on the file.
    """
    with replacing(directory / DATA, directory / INDEX) as (h5, xdmf):
        with new_hdf5(h5) as file:
            file.attrs["time"] = time
            put_surface_mesh(file, surface)
            for name, unit in UNITS.items():
                file.rows(name, getattr(surface, name), "f8", unit=unit)
        root, domain = new_domain()
        add_grid(domain, "surface", (DATA, file), (DATA, file), ["s", *UNITS])
        write_document(root, xdmf)


def read_surface_map(directory: Path) -> SurfaceMap:
    """Read what write_surface_map wrote. Raises SceneError where it is missing or damaged."""
    path = directory / DATA
    try:
        with h5py.File(path, "r") as file:
            return get_surface(get_surface_mesh(file), file)
    except (OSError, KeyError, ValueError) as error:
        raise SceneError(
            f"{path}: this file is missing, damaged or was not written by porolub."
        ) from error


def put_surface_mesh(file: NewFile, surface: SurfaceMap | None, group: str = "") -> None:
    """Add nodes, facets and s of a surface that rank 0 has, to a group. Collective."""
    about = None if surface is None else {"cell_type": surface.cell_type, "degree": surface.degree}
    about = file.comm.bcast(about, root=0)
    (file.groups.setdefault(group, {}) if group else file.attrs).update(about)

    def add(name: str, kind: str, **attrs: Any) -> None:
        values = None if surface is None else np.asarray(getattr(surface, name), dtype=kind)
        file.whole(f"{group}/{name}" if group else name, values, **attrs)

    add("cells", "i8")
    add("nodes", "f8", unit="m")
    add("s", "f8", unit="m")


def get_surface_mesh(group: Any) -> dict[str, Any]:
    """Return what put_surface_mesh wrote by the names of SurfaceMap. Raises OSError, KeyError."""
    return {
        "nodes": group["nodes"][()],
        "cells": group["cells"][()],
        "s": group["s"][()],
        "cell_type": str(group.attrs["cell_type"]),
        "degree": int(group.attrs["degree"]),
    }


def get_surface(mesh: dict[str, Any], group: Any) -> SurfaceMap:
    """Return what acts on a surface mesh. Raises OSError, KeyError."""
    return SurfaceMap(**mesh, **{name: group[name][()].astype(float) for name in UNITS})
