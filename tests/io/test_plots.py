"""Figures are drawn from the output directory alone and show its numbers."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import TriMesh
from matplotlib.image import imread

from porolub.errors import SceneError
from porolub.fem.elements import nodes
from porolub.io.directory import PLOTS, write_results
from porolub.io.draw_fields import TRIANGLES, draw_field
from porolub.io.draw_surface import draw_flows, draw_pressures
from porolub.io.plots import plot_directory
from porolub.scene import Scene
from porolub.solve.report import FieldData, Report, SurfaceData


def test_the_papers_figures_are_drawn(tmp_path: Path, report: Report, scene: Scene) -> None:
    write_results(tmp_path, report, scene, plots=False)
    paths = plot_directory(tmp_path)
    assert [path.name for path in paths] == list(PLOTS)
    for path in paths:
        picture = imread(path)
        assert picture.shape[:2] == (700, 1200)
        assert len(np.unique(picture.reshape(-1, picture.shape[-1]), axis=0)) > 50


def test_a_dry_run_has_what_it_has(tmp_path: Path, dry_report: Report, dry_scene: Scene) -> None:
    for name in PLOTS:
        (tmp_path / name).write_text("of an earlier run")
    write_results(tmp_path, dry_report, dry_scene)
    assert {path.name for path in tmp_path.glob("*.png")} == {"von_mises.png", "surface.png"}
    assert all(imread(path).any() for path in tmp_path.glob("*.png"))


def test_a_rigid_layer_has_no_stress_to_draw(tmp_path: Path, report: Report, scene: Scene) -> None:
    rigid = replace(report.fields, von_mises=0 * report.fields.von_mises)
    write_results(tmp_path, replace(report, fields=rigid, surface=None), scene)
    assert [path.name for path in tmp_path.glob("*.png")] == ["pressure.png"]


def test_field_is_drawn_on_the_deformed_layer_in_kpa(fields: FieldData) -> None:
    figure = draw_field(fields, fields.von_mises, "von Mises stress", "test", plane=95e-6)
    ax, bar = figure.axes
    (mesh,) = (c for c in ax.collections if isinstance(c, TriMesh))
    np.testing.assert_allclose(mesh.get_array(), 1e-3 * fields.von_mises)
    assert bar.get_ylabel() == "von Mises stress [kPa]"
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [mm]", "y [μm]")
    position = fields.nodes + fields.displacement
    box = ax.dataLim
    np.testing.assert_allclose([box.x0, box.x1], 1e3 * position[[4, -1], 0])
    assert box.y0 == pytest.approx(95.0)  # the flattened surface lies on the plane
    assert ax.lines[0].get_ydata()[0] == pytest.approx(95.0)


def test_high_stress_in_a_thick_layer_is_drawn_in_mpa_and_mm(fields: FieldData) -> None:
    thick = replace(fields, nodes=20 * fields.nodes)
    figure = draw_field(thick, 10 * fields.von_mises, "stress", "test", plane=None)
    ax, bar = figure.axes
    assert bar.get_ylabel() == "stress [MPa]"
    assert ax.get_ylabel() == "y [mm]"
    assert not ax.lines


@pytest.mark.parametrize(("cell", "degree"), TRIANGLES)
def test_triangles_cover_their_cell_once(cell: str, degree: int) -> None:
    corners = nodes(cell, degree)[np.array(TRIANGLES[cell, degree])]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    assert (areas > 0).all()
    assert areas.sum() == pytest.approx(4.0 if cell == "quad" else 0.5)
    assert set(np.ravel(TRIANGLES[cell, degree])) == set(range(len(nodes(cell, degree))))


def test_surface_figure_has_both_pressures_the_film_and_the_contact(surface: SurfaceData) -> None:
    figure = draw_pressures(surface, "test")
    left, right = figure.axes
    lines = {str(line.get_label()): line for line in [*left.lines, *right.lines]}
    for name, values in (("fluid", surface.p), ("contact", surface.p_c)):
        (line,) = (line for label, line in lines.items() if label.startswith(name))
        np.testing.assert_allclose(line.get_xdata(), 1e3 * surface.s)
        np.testing.assert_allclose(line.get_ydata(), 1e-3 * values)
    film = lines["film thickness h"].get_ydata()
    assert np.isnan(film[surface.h == 0]).all()
    np.testing.assert_allclose(film[surface.h > 0], 1e6 * surface.h[surface.h > 0])
    assert right.get_yscale() == "log"
    assert right.get_ylabel() == "film thickness h [μm]"
    (patch,) = left.patches
    zone = patch.get_patch_transform().transform(patch.get_path().vertices)
    np.testing.assert_allclose([zone[:, 0].min(), zone[:, 0].max()], [-4.0, 4.0])


def test_without_fluid_the_gap_is_no_film(surface: SurfaceData) -> None:
    zero = 0 * surface.s
    left, right = draw_pressures(replace(surface, p=zero, Q=zero, V=zero), "test").axes
    assert right.get_ylabel() == "gap h [μm]"
    assert not any(str(line.get_label()).startswith("fluid") for line in left.lines)


def test_without_contact_nothing_is_shaded(surface: SurfaceData) -> None:
    figure = draw_pressures(replace(surface, p_c=0 * surface.p_c, h=surface.h + 1e-6), "test")
    assert not figure.axes[0].patches
    figure = draw_flows(replace(surface, p_c=0 * surface.p_c), "test")
    assert not any(ax.patches or ax.get_legend() for ax in figure.axes)


def test_flow_figure_shows_reversed_flow(surface: SurfaceData) -> None:
    figure = draw_flows(surface, "test")
    flux, flow = figure.axes
    assert (flux.get_ylabel(), flow.get_ylabel()) == (
        "film flux Q [mm²/s]",
        "flow out of the layer V [μm/s]",
    )
    np.testing.assert_allclose(flux.lines[1].get_ydata(), 1e6 * surface.Q)
    np.testing.assert_allclose(flow.lines[1].get_ydata(), 1e6 * surface.V)
    assert -surface.Q.min() < 0.02 * surface.Q.max()  # it would be invisible on a linear scale
    assert flux.get_yscale() == "symlog"
    assert flow.get_yscale() == "linear"


def test_missing_and_damaged_directories_are_refused(
    tmp_path: Path, report: Report, scene: Scene
) -> None:
    with pytest.raises(SceneError, match="nowhere: there is no such directory"):
        plot_directory(tmp_path / "nowhere")
    with pytest.raises(SceneError, match=r"there is no summary\.json"):
        plot_directory(tmp_path)
    for name in ("fields.h5", "surface.csv", "summary.json"):
        write_results(tmp_path, report, scene, plots=False)
        (tmp_path / name).write_text("damaged")
        with pytest.raises(SceneError, match=name.replace(".", r"\.")):
            plot_directory(tmp_path)


def test_a_lost_scene_file_costs_the_title_only(
    tmp_path: Path, report: Report, scene: Scene
) -> None:
    write_results(tmp_path, report, scene, plots=False)
    (tmp_path / "scene.resolved.toml").unlink()
    assert len(plot_directory(tmp_path)) == 4


def test_neither_petsc_nor_mpi_is_needed() -> None:
    code = (
        "import sys, porolub.io.plots, porolub.io.table, porolub.io.progress, porolub.io.log;"
        "print([m for m in ('petsc4py', 'mpi4py.MPI', 'matplotlib.pyplot') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
