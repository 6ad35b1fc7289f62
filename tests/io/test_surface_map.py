"""A body's surface on disk: a mesh of its own for ParaView and meshio, and a table."""

import csv
from dataclasses import fields as names_of
from dataclasses import replace
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest

from porolub.errors import SceneError
from porolub.io.directory import begin_run, write_results
from porolub.io.frames import FrameWriter, read_frames, remove_frames
from porolub.io.summary import IN_SPACE, read_summary, write_summary
from porolub.io.surface import MAP_COLUMNS, write_surface
from porolub.io.surface_map import UNITS, read_surface_map, write_surface_map
from porolub.scene import Scene
from porolub.solve.report import FrameData, Report, SurfaceMap
from tests.io.body import body, body_surface


@pytest.fixture
def in_space(report: Report) -> Report:
    """Results of a body."""
    area = {"contact_area": 40e-6, "contact_width": 6.4e-3}
    return replace(report, fields=body(), surface=body_surface(), summary=report.summary | area)


def same(one: SurfaceMap, other: SurfaceMap) -> bool:
    """Equal to the last bit."""
    pairs = [(getattr(one, f.name), getattr(other, f.name)) for f in names_of(one)]
    return all(np.array_equal(a, b) for a, b in pairs)


def test_what_is_written_is_read(tmp_path: Path) -> None:
    write_surface_map(tmp_path, body_surface(), 0.25)
    assert same(read_surface_map(tmp_path), body_surface())
    with h5py.File(tmp_path / "surface.h5") as file:
        assert file.attrs["time"] == 0.25
        assert {name: file[name].attrs["unit"] for name in UNITS} == UNITS
        assert file["s"].attrs["unit"] == file["nodes"].attrs["unit"] == "m"


def test_meshio_reads_the_surface(tmp_path: Path) -> None:
    surface = body_surface()
    write_surface_map(tmp_path, surface)
    mesh = meshio.read(tmp_path / "surface.xdmf")
    assert [block.type for block in mesh.cells] == ["quad9"]
    np.testing.assert_array_equal(mesh.cells[0].data, surface.cells)
    np.testing.assert_array_equal(mesh.points, surface.nodes)
    assert list(mesh.point_data) == ["s", *UNITS]
    for name, values in mesh.point_data.items():
        np.testing.assert_array_equal(values, getattr(surface, name))


def test_triangles_are_a_surface_too(tmp_path: Path) -> None:
    surface = replace(body_surface(), cell_type="triangle", cells=np.array([[0, 2, 4, 1, 3, 5]]))
    write_surface_map(tmp_path, surface)
    assert meshio.read(tmp_path / "surface.xdmf").cells[0].type == "triangle6"
    assert same(read_surface_map(tmp_path), surface)


def test_a_damaged_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"surface\.h5: this file is missing"):
        read_surface_map(tmp_path)
    write_surface_map(tmp_path, body_surface())
    path = tmp_path / "surface.h5"
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(SceneError, match=r"surface\.h5: this file is missing, damaged"):
        read_surface_map(tmp_path)


def test_the_table_has_a_row_for_each_node(tmp_path: Path) -> None:
    surface = body_surface()
    write_surface(tmp_path / "surface.csv", surface)
    with (tmp_path / "surface.csv").open(newline="") as file:
        header, *rows = csv.reader(file)
    assert tuple(header) == MAP_COLUMNS
    table = np.array(rows, dtype=float)
    for k, name in enumerate(MAP_COLUMNS):
        np.testing.assert_array_equal(table[:, k], getattr(surface, name))


def test_a_run_of_a_body_writes_both(tmp_path: Path, in_space: Report, scene: Scene) -> None:
    write_results(tmp_path, in_space, scene)
    names = {path.name for path in tmp_path.iterdir()}
    assert {"surface.csv", "surface.h5", "surface.xdmf"} <= names
    assert {p for p in names if p.endswith(".png")} == {
        "surface.png", "flow.png", "profile_s.png", "profile_z.png"}  # fmt: skip


def test_nothing_of_a_bodys_run_stays(tmp_path: Path, in_space: Report, report: Report,
                                      scene: Scene) -> None:  # fmt: skip
    maps = {"surface.h5", "surface.xdmf", "profile_s.png", "profile_z.png"}
    write_results(tmp_path, in_space, scene)
    write_results(tmp_path, report, scene)
    assert not maps & {path.name for path in tmp_path.iterdir()}
    write_results(tmp_path, in_space, scene)
    begin_run(tmp_path, scene)
    assert not maps & {path.name for path in tmp_path.iterdir()}


def test_frames_hold_maps_on_one_mesh(tmp_path: Path) -> None:
    writer, fields = FrameWriter(tmp_path), body()
    for k in range(3):
        writer.write(FrameData(k, k / 3, fields, body_surface(k / 3)))
    found = read_frames(tmp_path)
    for k in range(3):
        surface = found.load(k).surface
        assert isinstance(surface, SurfaceMap)
        assert same(surface, body_surface(k / 3))
    with meshio.xdmf.TimeSeriesReader(tmp_path / "surface_series.xdmf") as reader:
        points, cells = reader.read_points_cells()
        np.testing.assert_array_equal(points, body_surface().nodes)
        assert cells[0].type == "quad9"
        time, data, _ = reader.read_data(2)
        assert time == 2 / 3
        np.testing.assert_array_equal(data["p"], body_surface(2 / 3).p)
        np.testing.assert_array_equal(data["Q"], body_surface().Q)
    with meshio.xdmf.TimeSeriesReader(tmp_path / "series.xdmf") as reader:
        assert reader.read_points_cells()[1][0].type == "hexahedron27"
    FrameWriter(tmp_path, first=2).write(FrameData(2, 0.9, fields, body_surface(0.9)))
    assert same(read_frames(tmp_path).load(2).surface, body_surface(0.9))
    remove_frames(tmp_path)
    assert not list(tmp_path.iterdir())


def test_the_summary_of_a_body_has_its_own_keys(tmp_path: Path, in_space: Report,
                                                report: Report) -> None:  # fmt: skip
    path = tmp_path / "summary.json"
    write_summary(path, in_space.summary)
    keys = list(read_summary(path))
    place = keys.index("contact_right")
    assert tuple(keys[place + 1 : place + 3]) == IN_SPACE
    write_summary(path, report.summary)
    assert not set(IN_SPACE) & set(read_summary(path))
