"""XDMF 3 descriptions of HDF5 files, for ParaView and meshio.

XDMF lists the nodes of quad9, triangle6, hexahedron27 and tetra10 in VTK's order (VTK's own
readers copy the connectivity as it is), which is that of FieldData.cells.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

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

Source = tuple[str, Any]
"""The place of an HDF5 file (or of a group in it, as frame.h5:/surface) as seen from the XDMF file,
and what knows its attributes and datasets: an open h5py.File or Group, or a NewFile."""


def new_domain() -> tuple[ElementTree.Element, ElementTree.Element]:
    """Return the root of a document and the domain its grids go into."""
    root = ElementTree.Element("Xdmf", Version="3.0")
    return root, ElementTree.SubElement(root, "Domain")


def add_collection(parent: ElementTree.Element, name: str) -> ElementTree.Element:
    """Add a series in time and return it: the grids of its moments go into it."""
    return ElementTree.SubElement(
        parent, "Grid", Name=name, GridType="Collection", CollectionType="Temporal"
    )


def add_grid(
    parent: ElementTree.Element,
    name: str,
    mesh: Source,
    data: Source,
    names: Iterable[str],
    time: float | None = None,
) -> None:
    """Add a grid: its mesh is the datasets nodes and cells, its nodal data those named.

    Every grid names its mesh anew: all readers know that, few know references. A grid on its own
    must have no time: meshio refuses it.
    """
    grid = ElementTree.SubElement(parent, "Grid", Name=name, GridType="Uniform")
    if time is not None:
        ElementTree.SubElement(grid, "Time", Value=repr(time))
    attributes = mesh[1].attrs
    count, per_cell = mesh[1]["cells"].shape
    topology = ElementTree.SubElement(
        grid,
        "Topology",
        TopologyType=TOPOLOGY[str(attributes["cell_type"]), int(attributes["degree"])],
        NumberOfElements=str(count),
        NodesPerElement=str(per_cell),
    )
    _item(topology, mesh, "cells")
    dim = mesh[1]["nodes"].shape[1]
    _item(ElementTree.SubElement(grid, "Geometry", GeometryType="XYZ"[:dim]), mesh, "nodes")
    for key in names:
        rank = "Scalar" if len(data[1][key].shape) == 1 else "Vector"
        attribute = ElementTree.SubElement(
            grid, "Attribute", Name=key, AttributeType=rank, Center="Node"
        )
        _item(attribute, data, key)


def write_document(root: ElementTree.Element, path: Path) -> None:
    """Write a document with indents. Raises OSError."""
    tree = ElementTree.ElementTree(root)
    ElementTree.indent(tree)
    tree.write(path, encoding="utf-8", xml_declaration=True)


def _item(parent: ElementTree.Element, source: Source, name: str) -> None:
    place, file = source
    item = ElementTree.SubElement(
        parent,
        "DataItem",
        Format="HDF",
        NumberType="Int" if file[name].dtype.kind == "i" else "Float",
        Precision=str(file[name].dtype.itemsize),
        Dimensions=" ".join(map(str, file[name].shape)),
    )
    item.text = f"{place}/{name}" if ":" in place else f"{place}:/{name}"
