"""Fields on all nodes: fields.h5 holds the arrays, fields.xdmf tells ParaView and meshio of them.

XDMF lists the nodes of quad9, triangle6, hexahedron27 and tetra10 in VTK's order (VTK's own
readers copy the connectivity as it is), which is that of FieldData.cells.
"""

from pathlib import Path
from xml.etree import ElementTree

import h5py
import numpy as np
from numpy.typing import NDArray

from porolub.errors import SceneError
from porolub.io.atomic import replacing
from porolub.solve.report import Array, FieldData

TOPOLOGY = {
    ("quad", 1): "Quadrilateral",
    ("quad", 2): "Quadrilateral_9",
    ("triangle", 1): "Triangle",
    ("triangle", 2): "Triangle_6",
    ("hex", 1): "Hexahedron",
    ("hex", 2): "Hexahedron_27",
    ("tet", 1): "Tetrahedron",
    ("tet", 2): "Tetrahedron_10",
}
"""XDMF name of a cell type and degree."""

UNITS = {"nodes": "m", "u": "m", "p": "Pa", "J": "1", "von_mises": "Pa", "flux": "m/s"}
"""SI unit of each dataset."""


def write_fields(directory: Path, fields: FieldData, time: float = 0.0) -> None:
    """Write fields.h5 and fields.xdmf; fields the scene does not have are left out.

    Datasets: nodes (n, dim) in the reference configuration, cells (nc, nn), u and flux (n, 3;
    z is 0 in a two-dimensional scene), p, J, von_mises (n,); attribute ``unit`` on each, ``time``
    (s), ``cell_type`` and ``degree`` on the file. Raises OSError.
    """
    data = _point_data(fields)
    with replacing(directory / "fields.h5", directory / "fields.xdmf") as (h5, xdmf):
        with h5py.File(h5, "w") as file:
            file.attrs.update(time=time, cell_type=fields.cell_type, degree=fields.degree)
            file.create_dataset("cells", data=fields.cells, dtype="i8")
            for name, values in {"nodes": fields.nodes, **data}.items():
                file.create_dataset(name, data=values, dtype="f8").attrs["unit"] = UNITS[name]
        tree = ElementTree.ElementTree(_xdmf(fields, data))
        ElementTree.indent(tree)
        tree.write(xdmf, encoding="utf-8", xml_declaration=True)


def read_fields(directory: Path) -> FieldData:
    """Read what write_fields wrote (fields.h5 alone).

    Raises SceneError where the file is missing or damaged.
    """
    path = directory / "fields.h5"
    if not path.is_file():
        raise SceneError(f"{directory}: there is no fields.h5, so this is no output of a run.")
    try:
        with h5py.File(path, "r") as file:
            return _fields(file)
    except (OSError, KeyError, ValueError) as error:
        raise SceneError(f"{path}: this file is damaged or was not written by porolub.") from error


def _fields(file: h5py.File) -> FieldData:
    arrays = {name: file[name][()] for name in file}
    nodes = arrays["nodes"]
    dim = nodes.shape[1]
    return FieldData(
        nodes=nodes,
        cells=arrays["cells"],
        cell_type=str(file.attrs["cell_type"]),
        degree=int(file.attrs["degree"]),
        displacement=arrays["u"][:, :dim],
        pressure=arrays.get("p"),
        jacobian=arrays["J"],
        von_mises=arrays["von_mises"],
        flux=arrays["flux"][:, :dim] if "flux" in arrays else None,
    )


def _point_data(fields: FieldData) -> dict[str, Array]:
    """The fields that exist, by the name they have in the files; vectors with 3 components."""
    found = {
        "u": _three(fields.displacement),
        "p": fields.pressure,
        "J": fields.jacobian,
        "von_mises": fields.von_mises,
        "flux": None if fields.flux is None else _three(fields.flux),
    }
    return {name: values for name, values in found.items() if values is not None}


def _three(vectors: Array) -> Array:
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def _xdmf(fields: FieldData, data: dict[str, Array]) -> ElementTree.Element:
    """The XDMF 3 description. No <Time>: meshio refuses a grid that has one."""
    root = ElementTree.Element("Xdmf", Version="3.0")
    domain = ElementTree.SubElement(root, "Domain")
    grid = ElementTree.SubElement(domain, "Grid", Name="layer", GridType="Uniform")
    count, per_cell = fields.cells.shape
    topology = ElementTree.SubElement(
        grid,
        "Topology",
        TopologyType=TOPOLOGY[fields.cell_type, fields.degree],
        NumberOfElements=str(count),
        NodesPerElement=str(per_cell),
    )
    _item(topology, "cells", fields.cells, "Int")
    kind = "XYZ"[: fields.nodes.shape[1]]
    _item(ElementTree.SubElement(grid, "Geometry", GeometryType=kind), "nodes", fields.nodes)
    for name, values in data.items():
        rank = "Scalar" if values.ndim == 1 else "Vector"
        attribute = ElementTree.SubElement(
            grid, "Attribute", Name=name, AttributeType=rank, Center="Node"
        )
        _item(attribute, name, values)
    return root


def _item(
    parent: ElementTree.Element,
    name: str,
    values: Array | NDArray[np.int64],
    number: str = "Float",
) -> None:
    item = ElementTree.SubElement(
        parent,
        "DataItem",
        Format="HDF",
        NumberType=number,
        Precision="8",
        Dimensions=" ".join(map(str, values.shape)),
    )
    item.text = f"fields.h5:/{name}"
