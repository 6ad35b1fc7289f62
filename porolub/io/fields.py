"""Fields on all nodes: fields.h5 holds the arrays, fields.xdmf tells ParaView and meshio."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import replacing
from porolub.io.hdf5 import NewFile, new_hdf5
from porolub.io.xdmf import add_grid, new_domain, write_document
from porolub.solve.natural import bounds
from porolub.solve.report import Array, FieldData
from porolub.together import ALONE, on_root

UNITS = {"nodes": "m", "u": "m", "p": "Pa", "J": "1", "von_mises": "Pa", "flux": "m/s"}
"""SI unit of each dataset."""


def write_fields(
    directory: Path, fields: FieldData, time: float = 0.0, comm: Any = ALONE
) -> None:
    """Write fields.h5 and fields.xdmf; fields the scene does not have are left out. Collective.

    Datasets: nodes (n, dim) in the reference configuration, cells (nc, nn), u and flux (n, 3;
    z is 0 in a two-dimensional scene), p, J, von_mises (n,); attribute ``unit`` on each, ``time``
    (s), ``cell_type`` and ``degree`` on the file. Raises OSError.
    """
    data = point_data(fields)
    files = directory / "fields.h5", directory / "fields.xdmf"
    with replacing(*files, comm=comm) as (h5, xdmf):
        with new_hdf5(h5, comm) as file:
            file.attrs["time"] = time
            put_mesh(file, fields)
            for name, values in data.items():
                file.rows(name, values, "f8", unit=UNITS[name])
        root, domain = new_domain()
        add_grid(domain, "layer", ("fields.h5", file), ("fields.h5", file), data)
        on_root(comm, lambda: write_document(root, xdmf))


def read_fields(directory: Path) -> FieldData:
    """Read all of what write_fields wrote (fields.h5 alone).

    Raises SceneError where the file is missing or damaged.
    """
    with _opened(directory) as file:
        return get_fields(get_mesh(file), file)


@contextmanager
def _opened(directory: Path) -> Iterator[h5py.File]:
    path = directory / "fields.h5"
    if not path.is_file():
        raise SceneError(f"{directory}: there is no fields.h5, so this is no output of a run.")
    try:
        with h5py.File(path, "r") as file:
            yield file
    except (OSError, KeyError, ValueError) as error:
        raise SceneError(f"{path}: this file is damaged or was not written by porolub.") from error


def is_flat(directory: Path) -> bool:
    """Whether the fields there are of a two-dimensional scene. Raises as read_fields."""
    with _opened(directory) as file:
        return bool(file["nodes"].shape[1] == 2)


def point_data(fields: FieldData) -> dict[str, Array]:
    """Return the fields that exist by their name in the files; vectors have 3 components."""
    found = {
        "u": _three(fields.displacement),
        "p": fields.pressure,
        "J": fields.jacobian,
        "von_mises": fields.von_mises,
        "flux": None if fields.flux is None else _three(fields.flux),
    }
    return {name: values for name, values in found.items() if values is not None}


def put_mesh(file: NewFile, fields: FieldData) -> None:
    """Add nodes and cells with their kind. Collective."""
    file.attrs.update(cell_type=fields.cell_type, degree=fields.degree)
    file.rows("cells", fields.cells, "i8")
    file.rows("nodes", fields.nodes, "f8", unit=UNITS["nodes"])


def get_mesh(file: h5py.File, comm: Any = ALONE) -> dict[str, Any]:
    """Return this rank's block of what put_mesh wrote by the names of FieldData.

    Raises OSError, KeyError.
    """
    nodes, cells = (
        slice(*bounds(len(file[name]), comm.size)[comm.rank : comm.rank + 2].tolist())
        for name in ("nodes", "cells")
    )
    return {
        "nodes": file["nodes"][nodes],
        "cells": file["cells"][cells],
        "cell_type": str(file.attrs["cell_type"]),
        "degree": int(file.attrs["degree"]),
    }


def get_fields(mesh: dict[str, Any], file: h5py.File) -> FieldData:
    """Return the fields of a file on their mesh.

    Raises OSError, KeyError or ValueError where the file is damaged.
    """
    dim = mesh["nodes"].shape[1]
    given = {name: file[name][()].astype(float) for name in UNITS if name in file}
    return FieldData(
        **mesh,
        displacement=given["u"][:, :dim],
        pressure=given.get("p"),
        jacobian=given["J"],
        von_mises=given["von_mises"],
        flux=given["flux"][:, :dim] if "flux" in given else None,
    )


def _three(vectors: Array) -> Array:
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))
