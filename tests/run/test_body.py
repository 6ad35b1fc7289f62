"""A body from the scene to its files: plane strain is the plane problem, ranks leave no trace."""

import json
import shutil
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

from porolub.errors import Interrupted
from porolub.io.checkpoint import read_checkpoint
from porolub.io.fields import read_fields
from porolub.io.frames import read_frames
from porolub.io.surface_map import read_surface_map
from porolub.run_transient import restart
from porolub.scene import Scene, load_scene
from porolub.solve.report import SurfaceMap
from tests.run.output import Output, run, shipped
from tests.run.program import RUN, drawn_on_two
from tests.run.test_ranks import FLOWS, NOT_COMPARED, ROUNDING, errors_like
from tests.run.transient import ROW, same_frames, same_history, signalled

WIDE = 1e-3  # m
SLAB = ["scene.dimension=3", "geometry.shape=barrel", "geometry.width=1 mm", "mesh.deep=1",
        "load.force=1.5 N"]  # fmt: skip
PER_WIDTH = {"load_total", "load_solid", "load_fluid", *FLOWS}
CROWN = [*SLAB[:2], "geometry.width=16 mm", "geometry.crown_radius=200 mm", "mesh.deep=6",
         "mesh.along=16", "mesh.across=2", "load.force=8 N"]  # fmt: skip
SWINGING = ("motion.speed={mean='0 rad/s',amplitude='1 rad/s',frequency='1 Hz',shape='cosine'}",
            "time={end='40 ms',frames=100,tolerance=1e-2}")  # fmt: skip


def words(*overrides: str) -> list[str]:
    return [word for override in overrides for word in ("--set", override)]


@pytest.fixture(scope="module")
def slab(tmp_path_factory: pytest.TempPathFactory) -> Output:
    return run(tmp_path_factory.mktemp("slab"), shipped("case1", 40, 3, *SLAB))


@pytest.fixture(scope="module")
def plane(tmp_path_factory: pytest.TempPathFactory) -> Output:
    return run(tmp_path_factory.mktemp("plane"), shipped("case1", 40, 3))


def test_a_slab_has_the_summary_of_the_plane(slab: Output, plane: Output) -> None:
    unlike = NOT_COMPARED | ROUNDING | {"dofs"}
    for key, expected in plane.summary.items():
        if key in unlike:
            continue
        if isinstance(expected, float):
            size = 1e-6 * max(plane.summary[k] for k in FLOWS) if key in FLOWS else 0.0
            width = WIDE if key in PER_WIDTH else 1.0
            expected = pytest.approx(width * expected, rel=1e-6, abs=width * size)
        elif key == "error_estimate":
            expected = {name: pytest.approx((WIDE if name in PER_WIDTH else 1.0) * error, rel=1e-4,
                                            abs=1e-6 * abs(slab.summary[name] or 0.0))
                        for name, error in expected.items()}
        assert slab.summary[key] == expected, key
    assert all(slab.summary[key] < 1e-8 for key in ROUNDING)
    assert slab.summary["contact_width"] == pytest.approx(WIDE)
    nodes = 17.5e-3 / 80
    assert slab.summary["contact_area"] == pytest.approx(
        WIDE * slab.summary["contact_length"], abs=1.5 * WIDE * nodes)


def test_each_row_of_the_slabs_surface_is_the_planes(slab: Output, plane: Output) -> None:
    surface = read_surface_map(slab.directory)
    flat = plane.surface
    for z in (-WIDE / 2, 0.0, WIDE / 2):
        row = np.flatnonzero(np.abs(surface.z - z) < 1e-9)
        row = row[np.argsort(surface.s[row])]
        for name in ("s", "x", "p", "p_c", "h"):
            expected = getattr(flat, name)
            np.testing.assert_allclose(getattr(surface, name)[row], expected, rtol=0,
                                       atol=1e-6 * np.abs(expected).max(), err_msg=name)
        inner = slice(2, -2)  # at the ends the profile's flux goes on as it is
        for name in ("Q_s", "V"):
            expected = getattr(flat, name[0])
            np.testing.assert_allclose(getattr(surface, name)[row][inner], expected[inner], rtol=0,
                                       atol=1e-5 * np.abs(expected).max(), err_msg=name)
    assert np.abs(surface.Q_z).max() < 1e-6 * np.abs(surface.Q_s).max()


def test_a_body_leaves_files_that_others_read(slab: Output) -> None:
    names = {path.name for path in slab.directory.iterdir()}
    assert {"surface.csv", "surface.h5", "surface.xdmf", "surface.png", "flow.png",
            "profile_s.png", "profile_z.png", "fields.xdmf", "checkpoint.h5"} <= names
    assert not {"von_mises.png", "pressure.png"} & names
    solid, surface = (meshio.read(slab.directory / f"{n}.xdmf") for n in ("fields", "surface"))
    assert [block.type for block in solid.cells] == ["hexahedron27"]
    assert [block.type for block in surface.cells] == ["quad9"]
    on_it = {tuple(point) for point in np.round(solid.points, 12)}
    assert all(tuple(point) in on_it for point in np.round(surface.points, 12))
    assert len(surface.points) == 81 * 3


def results(directory: Path) -> tuple[dict[str, Any], Any, SurfaceMap]:
    summary = json.loads((directory / "summary.json").read_text())
    return summary, read_fields(directory), read_surface_map(directory)


@pytest.mark.mpi
def test_a_crowned_barrel_on_any_number_of_ranks(run_mpi, tmp_path: Path) -> None:
    job = Path(__file__).resolve().parents[2] / "jobs" / "case1.toml"
    found = {}
    for ranks in (1, 2, 4):
        run_mpi(ranks, drawn_on_two(ranks), "run", job, *words(*CROWN), "--quiet", "--out",
                tmp_path / str(ranks), timeout=300)
        found[ranks] = results(tmp_path / str(ranks))
    summary, fields, surface = found[1]
    assert 0 < summary["contact_width"] < 16e-3
    smallest = {key: 1e-8 * max(summary[k] for k in FLOWS) for key in FLOWS}
    for ranks in (2, 4):
        others, other_fields, other_surface = found[ranks]
        for key in set(summary) - NOT_COMPARED - ROUNDING:
            expected = summary[key]
            if isinstance(expected, float):
                expected = pytest.approx(expected, rel=1e-8, abs=smallest.get(key, 1e-30))
            elif key == "error_estimate":
                expected = errors_like(summary, smallest)
            assert others[key] == expected, f"{key} on {ranks} ranks"
        np.testing.assert_array_equal(other_surface.cells, surface.cells)
        np.testing.assert_array_equal(other_fields.cells, fields.cells)
        pairs = [(one, other, name) for one, other, names in (
            (fields, other_fields, ("nodes", "displacement", "pressure", "jacobian", "flux")),
            (surface, other_surface, ("nodes", "s", "p", "p_c", "h", "Q", "Q_s", "V")),
        ) for name in names]
        for one, other, name in pairs:
            expected = getattr(one, name)
            np.testing.assert_allclose(getattr(other, name), expected, rtol=0,
                                       atol=1e-8 * np.abs(expected).max(), err_msg=name)


def swinging() -> Scene:
    return load_scene(Path(__file__).resolve().parents[2] / "jobs" / "case1.toml",
                      [*CROWN, "mesh.along=12", "mesh.deep=4", *SWINGING])


@pytest.mark.mpi
def test_a_body_stopped_on_one_rank_goes_on_on_two(run_mpi, tmp_path: Path) -> None:
    whole = run(tmp_path / "whole", swinging())
    with signalled(ROW, 4, 15), pytest.raises(Interrupted):
        run(tmp_path / "two", swinging())
    before = read_checkpoint(tmp_path / "two" / "checkpoint.h5")[0]
    assert 0 < before.states[0].time < 0.04
    shutil.copytree(tmp_path / "two", tmp_path / "one")
    restart(tmp_path / "one", quiet=True)
    run_mpi(2, RUN, "restart", "two", "--quiet")
    for directory in (tmp_path / "one", tmp_path / "two"):
        same_history(whole.directory, directory)
        same_frames(whole.directory, directory)
    expected, found = read_frames(whole.directory), read_frames(tmp_path / "two")
    assert len(found) == len(expected) > 2
    for k in range(len(found)):
        one, other = expected.load(k).surface, found.load(k).surface
        assert isinstance(one, SurfaceMap)
        assert isinstance(other, SurfaceMap)
        np.testing.assert_array_equal(other.cells, one.cells)
        np.testing.assert_allclose(other.p, one.p, rtol=0, atol=1e-7 * one.p.max())
