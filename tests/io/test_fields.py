"""fields.h5 and fields.xdmf hold what was given, in the order VTK and meshio expect."""

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import h5py
import meshio
import numpy as np
import pytest

from porolub.errors import SceneError
from porolub.fem.elements import dimension, nodes
from porolub.io.fields import UNITS, read_fields, write_fields
from porolub.solve.report import FieldData

# Nodes beyond the vertices as VTK places them: at the mean of these vertices
# (vtkBiQuadraticQuad, vtkQuadraticTriangle, vtkTriQuadraticHexahedron, vtkQuadraticTetra).
_HEX_EDGES = [
    *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
]
_HEX_FACES = [(0, 3, 4, 7), (1, 2, 5, 6), (0, 1, 4, 5), (2, 3, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7)]
VTK = {
    ("quad", 1): ("quad", []),
    ("quad", 2): ("quad9", [(0, 1), (1, 2), (2, 3), (0, 3), (0, 1, 2, 3)]),
    ("triangle", 1): ("triangle", []),
    ("triangle", 2): ("triangle6", [(0, 1), (1, 2), (0, 2)]),
    ("hex", 1): ("hexahedron", []),
    ("hex", 2): ("hexahedron27", [*_HEX_EDGES, *_HEX_FACES, tuple(range(8))]),
    ("tet", 1): ("tetra", []),
    ("tet", 2): ("tetra10", [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]),
}
VTK_VERTICES = {  # on the unit square or cube
    "quad": [(0, 0), (1, 0), (1, 1), (0, 1)],
    "triangle": [(0, 0), (1, 0), (0, 1)],
    "hex": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
    "tet": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
}


@pytest.mark.parametrize(("cell", "degree"), VTK)
def test_nodes_of_a_cell_are_read_in_vtk_order(tmp_path: Path, cell: str, degree: int) -> None:
    """One cell of the mesh's own reference nodes, its numbers shuffled."""
    points = nodes(cell, degree)
    if cell in ("quad", "hex"):
        points = (points + 1) / 2
    order = np.random.default_rng(1).permutation(len(points))
    shuffled = np.empty_like(points)
    shuffled[order] = points
    zero = np.zeros(len(points))
    vectors = np.zeros((len(points), dimension(cell)))
    data = FieldData(shuffled, order[None], cell, degree, vectors, zero, zero, zero, vectors)
    write_fields(tmp_path, data)

    mesh = meshio.read(tmp_path / "fields.xdmf")
    kind, means = VTK[cell, degree]
    vertices = np.array(VTK_VERTICES[cell], dtype=float)
    expected = [*vertices, *(vertices[list(mean)].mean(axis=0) for mean in means)]
    assert [block.type for block in mesh.cells] == [kind]
    np.testing.assert_allclose(mesh.points[mesh.cells[0].data[0]], expected, atol=1e-14)


def test_meshio_reads_back_every_number(tmp_path: Path, fields: FieldData) -> None:
    write_fields(tmp_path, fields)
    mesh = meshio.read(tmp_path / "fields.xdmf")
    np.testing.assert_array_equal(mesh.points, fields.nodes)
    np.testing.assert_array_equal(mesh.cells[0].data, fields.cells)
    assert list(mesh.point_data) == ["u", "p", "J", "von_mises", "flux"]
    np.testing.assert_array_equal(mesh.point_data["p"], fields.pressure)
    np.testing.assert_array_equal(mesh.point_data["J"], fields.jacobian)
    np.testing.assert_array_equal(mesh.point_data["von_mises"], fields.von_mises)
    for name, vectors in (("u", fields.displacement), ("flux", fields.flux)):
        assert mesh.point_data[name].shape == (len(fields.nodes), 3)
        np.testing.assert_array_equal(mesh.point_data[name][:, :2], vectors)
        assert not mesh.point_data[name][:, 2].any()


def test_a_dry_layer_has_no_fluid_fields(tmp_path: Path, dry_fields: FieldData) -> None:
    write_fields(tmp_path, dry_fields)
    assert set(meshio.read(tmp_path / "fields.xdmf").point_data) == {"u", "J", "von_mises"}
    again = read_fields(tmp_path)
    assert again.pressure is None
    assert again.flux is None


def test_datasets_name_their_units_and_the_file_its_time(tmp_path: Path, fields: FieldData) -> None:
    write_fields(tmp_path, fields, time=0.25)
    with h5py.File(tmp_path / "fields.h5") as file:
        assert file.attrs["time"] == 0.25
        assert {n: file[n].attrs["unit"] for n in file if n != "cells"} == UNITS
        assert file["u"].dtype == np.float64
        assert file["cells"].dtype == np.int64
        assert {file[name].compression for name in file} == {None}


def test_xdmf_declares_the_shapes_of_the_datasets(tmp_path: Path, fields: FieldData) -> None:
    """meshio ignores Dimensions, ParaView does not."""
    write_fields(tmp_path, fields)
    items = list(ElementTree.parse(tmp_path / "fields.xdmf").iter("DataItem"))
    with h5py.File(tmp_path / "fields.h5") as file:
        assert len(items) == len(file)
        for item in items:
            name, dataset = str(item.text).split(":/")
            assert name == "fields.h5"
            shape = tuple(map(int, item.attrib["Dimensions"].split()))
            assert shape == file[dataset].shape
            assert int(item.attrib["Precision"]) == file[dataset].dtype.itemsize


def test_reader_returns_what_was_written(tmp_path: Path, fields: FieldData) -> None:
    write_fields(tmp_path, fields)
    again = read_fields(tmp_path)
    assert (again.cell_type, again.degree) == ("quad", 2)
    for name in ("nodes", "cells", "displacement", "pressure", "jacobian", "von_mises", "flux"):
        np.testing.assert_array_equal(getattr(again, name), getattr(fields, name))


def test_interrupted_write_leaves_the_old_pair(
    tmp_path: Path, fields: FieldData, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_fields(tmp_path, fields)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(ElementTree.ElementTree, "write", stop)
    with pytest.raises(KeyboardInterrupt):
        write_fields(tmp_path, replace(fields, jacobian=2 * fields.jacobian))
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_missing_and_damaged_files_are_named(tmp_path: Path, fields: FieldData) -> None:
    with pytest.raises(SceneError, match=r"there is no fields\.h5"):
        read_fields(tmp_path)
    write_fields(tmp_path, fields)
    path = tmp_path / "fields.h5"
    path.write_bytes(path.read_bytes()[:1000])
    with pytest.raises(SceneError, match=r"fields\.h5: this file is damaged"):
        read_fields(tmp_path)
    with h5py.File(path, "w") as file:
        file["nodes"] = np.zeros((3, 2))
    with pytest.raises(SceneError, match=r"fields\.h5: this file is damaged"):
        read_fields(tmp_path)
