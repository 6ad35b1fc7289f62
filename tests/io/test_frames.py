"""Frames read back, make a series that ParaView and meshio know, and go on after a restart."""

import os
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import h5py
import meshio
import numpy as np
import pytest

from porolub.errors import SceneError, SolveError
from porolub.io.fields import UNITS, write_fields
from porolub.io.frames import FrameWriter, read_frames, remove_frames
from porolub.io.sparse import SparseFile
from porolub.solve.report import FieldData, FrameData, SurfaceData

ARRAYS = ("displacement", "pressure", "jacobian", "von_mises", "flux")


def single(values: np.ndarray) -> np.ndarray:
    return values.astype("f4").astype("f8")


@pytest.fixture
def frames(fields: FieldData, surface: SurfaceData) -> list[FrameData]:
    """Five moments; numbers may leave gaps where steps are longer than frames are apart."""
    return [
        FrameData(
            number,
            number / 30,
            replace(fields, pressure=(number + 1) * fields.pressure / 3, jacobian=fields.jacobian),
            replace(surface, p=(number + 1) * surface.p / 3),
        )
        for number in (0, 1, 2, 5, 6)
    ]


@pytest.fixture
def written(tmp_path: Path, frames: list[FrameData]) -> Path:
    writer = FrameWriter(tmp_path)
    for frame in frames:
        writer.write(frame)
    return tmp_path


def grids(directory: Path) -> list[ElementTree.Element]:
    (collection,) = ElementTree.parse(directory / "series.xdmf").iterfind("Domain/Grid")
    assert collection.attrib["GridType"] == "Collection"
    assert collection.attrib["CollectionType"] == "Temporal"
    return list(collection)


def shown(directory: Path) -> list[float]:
    """Times of the frames in the series, all of whose files are there."""
    for item in ElementTree.parse(directory / "series.xdmf").iter("DataItem"):
        assert (directory / str(item.text).split(":")[0]).is_file()
    return [float(grid.find("Time").attrib["Value"]) for grid in grids(directory)]


def test_files(written: Path) -> None:
    assert sorted(p.name for p in written.iterdir()) == ["frames", "series.xdmf"]
    assert sorted(p.name for p in (written / "frames").iterdir()) == [
        *(f"frame_000{number}.h5" for number in (0, 1, 2, 5, 6)),
        "mesh.h5",
    ]


def test_frames_read_back_in_single_precision(written: Path, frames: list[FrameData]) -> None:
    found = read_frames(written)
    assert len(found) == len(frames)
    np.testing.assert_array_equal(found.times, [frame.time for frame in frames])
    for k, (frame, again) in enumerate(zip(frames, found, strict=True)):
        assert (again.number, again.time) == (frame.number, frame.time)
        for name in ARRAYS:
            np.testing.assert_array_equal(
                getattr(again.fields, name), single(getattr(frame.fields, name))
            )
        assert again.surface is not None
        np.testing.assert_array_equal(again.surface.p, frame.surface.p)
        np.testing.assert_array_equal(again.surface.h, frame.surface.h)
        np.testing.assert_array_equal(found.load(k).fields.pressure, again.fields.pressure)


def test_frames_share_the_exact_mesh(written: Path, fields: FieldData) -> None:
    found = read_frames(written)
    one, other = found.load(0).fields, found.load(3).fields
    np.testing.assert_array_equal(one.nodes, fields.nodes)
    np.testing.assert_array_equal(one.cells, fields.cells)
    assert (one.cell_type, one.degree) == ("quad", 2)
    assert one.nodes is other.nodes
    assert one.cells is other.cells


def test_a_frame_is_small_and_names_its_units(written: Path) -> None:
    with h5py.File(written / "frames" / "frame_0005.h5") as file:
        assert (file.attrs["number"], file.attrs["time"]) == (5, 5 / 30)
        names = set(UNITS) - {"nodes"}
        assert set(file) == names | {"surface"}
        assert {name: file[name].attrs["unit"] for name in names} == {n: UNITS[n] for n in names}
        for name in names:
            assert file[name].dtype == np.float32
            assert (file[name].compression, file[name].shuffle) == ("gzip", True)


def test_a_dry_layer_and_one_without_surface(tmp_path: Path, dry_fields: FieldData) -> None:
    FrameWriter(tmp_path).write(FrameData(0, 0.0, dry_fields, None))
    frame = read_frames(tmp_path).load(0)
    assert frame.fields.pressure is None
    assert frame.fields.flux is None
    assert frame.surface is None


def test_meshio_reads_the_series(written: Path, frames: list[FrameData]) -> None:
    with meshio.xdmf.TimeSeriesReader(written / "series.xdmf") as reader:
        points, cells = reader.read_points_cells()
        np.testing.assert_array_equal(points, frames[0].fields.nodes)
        assert [block.type for block in cells] == ["quad9"]
        np.testing.assert_array_equal(cells[0].data, frames[0].fields.cells)
        assert reader.num_steps == len(frames)
        for k, frame in enumerate(frames):
            time, data, _ = reader.read_data(k)
            assert time == frame.time
            assert list(data) == ["u", "p", "J", "von_mises", "flux"]
            np.testing.assert_array_equal(data["p"], frame.fields.pressure.astype("f4"))
            np.testing.assert_array_equal(data["u"][:, :2], frame.fields.displacement.astype("f4"))


def test_the_series_declares_what_paraview_needs(written: Path) -> None:
    """Each grid with mesh and time of its own; shapes and precision as in the files."""
    assert len(grids(written)) == 5
    for grid in grids(written):
        assert [child.tag for child in grid] == ["Time", "Topology", "Geometry", *["Attribute"] * 5]
        assert grid.attrib["GridType"] == "Uniform"
        for item in grid.iter("DataItem"):
            place, dataset = str(item.text).split(":/")
            assert not place.startswith("/")
            with h5py.File(written / place) as file:
                shape = tuple(map(int, item.attrib["Dimensions"].split()))
                assert shape == file[dataset].shape
                assert int(item.attrib["Precision"]) == file[dataset].dtype.itemsize
                kind = {"i": "Int", "f": "Float"}[file[dataset].dtype.kind]
                assert item.attrib["NumberType"] == kind


def test_the_series_is_up_to_date_after_each_frame(tmp_path: Path, frames: list[FrameData]) -> None:
    writer = FrameWriter(tmp_path)
    for k, frame in enumerate(frames):
        writer.write(frame)
        assert shown(tmp_path) == [f.time for f in frames[: k + 1]]


def test_the_output_may_be_moved(written: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    there = tmp_path_factory.mktemp("there") / "moved"
    written.rename(there)
    with meshio.xdmf.TimeSeriesReader(there / "series.xdmf") as reader:
        reader.read_points_cells()
        assert reader.read_data(4)[1]["p"].any()


def test_a_new_run_takes_all_frames_away(written: Path, frames: list[FrameData]) -> None:
    (written / "frames" / ".frame_0007.h5.tmp").write_text("of a killed write")
    writer = FrameWriter(written)
    assert list(written.iterdir()) == []
    writer.write(frames[0])
    assert shown(written) == [0.0]


def test_a_restart_takes_later_frames_away(written: Path, frames: list[FrameData]) -> None:
    (written / "frames" / ".frame_0007.h5.tmp").write_text("of a killed write")
    writer = FrameWriter(written, first=3)
    assert shown(written) == [0.0, 1 / 30, 2 / 30]
    assert len(read_frames(written)) == 3
    assert len(list((written / "frames").iterdir())) == 4
    for number in (3, 4):
        writer.write(replace(frames[0], number=number, time=number / 30))
    assert shown(written) == [k / 30 for k in range(5)]


def test_many_frames_stay_in_order(tmp_path: Path, frames: list[FrameData]) -> None:
    writer = FrameWriter(tmp_path)
    for number in (9999, 10000, 10001):
        writer.write(replace(frames[0], number=number, time=float(number)))
    assert shown(tmp_path) == read_frames(tmp_path).times.tolist() == [9999.0, 10000.0, 10001.0]


def test_a_restart_with_another_mesh_is_refused(written: Path, frames: list[FrameData]) -> None:
    writer = FrameWriter(written, first=6)
    fields = frames[0].fields
    for other in (
        replace(fields, nodes=fields.nodes * (1 + 1e-6)),
        replace(fields, cells=fields.cells[:, ::-1]),
        replace(fields, cells=fields.cells[:-1]),
    ):
        with pytest.raises(SceneError, match="the frames so far are of another mesh than this"):
            writer.write(replace(frames[0], number=6, fields=other))
    rounded = replace(fields, nodes=fields.nodes * (1 + 1e-14))
    writer.write(replace(frames[0], number=6, time=0.2, fields=rounded))
    assert len(shown(written)) == 5


def test_other_files_are_left_alone(written: Path) -> None:
    (written / "frames" / "notes.txt").write_text("mine")
    remove_frames(written)
    assert [p.name for p in (written / "frames").iterdir()] == ["notes.txt"]
    with pytest.raises(SceneError, match="there are no frames of a transient run here"):
        read_frames(written)


def test_a_directory_without_frames_is_refused(tmp_path: Path, fields: FieldData) -> None:
    write_fields(tmp_path, fields)
    with pytest.raises(SceneError, match="there are no frames of a transient run here"):
        read_frames(tmp_path)


def test_a_damaged_frame_is_named(written: Path) -> None:
    path = written / "frames" / "frame_0002.h5"
    good = path.read_bytes()
    path.write_bytes(good[: len(good) // 2])
    for read in (read_frames, lambda directory: FrameWriter(directory, first=4)):
        with pytest.raises(SceneError, match=r"frame_0002\.h5: this file is missing, damaged"):
            read(written)
    path.write_bytes(good)
    found = read_frames(written)
    with h5py.File(path, "w") as file:
        file.attrs["time"] = 2 / 30
    with pytest.raises(SceneError, match=r"frame_0002\.h5: this file is missing, damaged"):
        found.load(2)
    (written / "frames" / "mesh.h5").unlink()
    with pytest.raises(SceneError, match=r"mesh\.h5: this file is missing, damaged"):
        read_frames(written).load(0)


def test_a_write_that_fails_leaves_the_frames_so_far(
    written: Path, frames: list[FrameData], monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = FrameWriter(written, first=7)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    for owner, name in ((SparseFile, "save"), (os, "fsync"), (Path, "replace")):
        monkeypatch.setattr(owner, name, full)
        with pytest.raises(
            SolveError, match=r"frame_0007\.h5: this file cannot be written \(No sp"
        ):
            writer.write(replace(frames[0], number=7))
        monkeypatch.undo()
    assert shown(written) == [frame.time for frame in frames]
    assert len(read_frames(written)) == 5
    writer.write(replace(frames[0], number=7, time=0.25))
    assert shown(written)[-1] == 0.25


def test_killed_between_a_frame_and_the_series_the_next_run_mends_it(
    written: Path, frames: list[FrameData], monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = FrameWriter(written, first=7)

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("porolub.io.frames.write_series", stop)
    with pytest.raises(KeyboardInterrupt):
        writer.write(replace(frames[0], number=7, time=0.25))
    monkeypatch.undo()
    assert len(shown(written)) == 5
    FrameWriter(written, first=8)
    assert shown(written)[-1] == 0.25
    os.unlink(written / "series.xdmf")
    FrameWriter(written, first=7)
    assert len(shown(written)) == 5
