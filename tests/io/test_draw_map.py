"""Maps and cuts of a body's surface show its numbers in the units they name."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import TriMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.quiver import Quiver

from porolub.io.draw_map import THINNEST, draw_maps
from porolub.io.section import Chart, middle
from porolub.scene import Scene, scene_from_dict
from porolub.solve.report import SurfaceMap
from tests.io.body import ANGLE, HALF_S, HALF_Z, RADIUS, WIDTH, body_surface
from tests.scene.scenes import changed
from tests.terms.case1 import BARREL


def scene(*symmetry: str) -> Scene:
    """A barrel with these symmetry planes."""
    return scene_from_dict(changed(BARREL, geometry={"symmetry": list(symmetry)}))


@pytest.fixture
def surface() -> SurfaceMap:
    return body_surface()


def panels(figure: Figure) -> dict[str, TriMesh]:
    """Painted triangles by the words at their colours."""
    painted = [next(c for c in ax.collections if isinstance(c, TriMesh))
               for ax in figure.axes if any(isinstance(c, TriMesh) for c in ax.collections)]
    return {mesh.colorbar.ax.get_xlabel() or mesh.colorbar.ax.get_ylabel(): mesh
            for mesh in painted if mesh.colorbar is not None}  # fmt: skip


def test_pressures_and_film_in_kpa_and_um(surface: SurfaceMap) -> None:
    found = panels(draw_maps(surface, "test", None)["surface.png"])
    names = ["fluid pressure p [kPa]", "contact pressure $p_c$ [kPa]", "film thickness h [μm]"]
    assert list(found) == names
    np.testing.assert_allclose(found[names[0]].get_array(), 1e-3 * surface.p)
    np.testing.assert_allclose(found[names[1]].get_array(), 1e-3 * surface.p_c)
    shown = np.maximum(1e6 * surface.h, 1e6 * THINNEST)
    np.testing.assert_allclose(found[names[2]].get_array(), shown)
    assert isinstance(found[names[2]].norm, LogNorm)


def test_only_where_things_happen_is_shown(surface: SurfaceMap) -> None:
    figure = draw_maps(surface, "test", None)["surface.png"]
    ax = figure.axes[0]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("s [mm]", "z [mm]")
    assert 1e3 * HALF_S < ax.get_xlim()[1] < 1e3 * RADIUS * ANGLE
    assert 1e3 * HALF_Z < ax.get_ylim()[1] < 1e3 * WIDTH / 2
    assert ax.get_legend().get_texts()[0].get_text() == "edge of contact"


def test_the_edge_of_contact_is_where_it_ends(surface: SurfaceMap) -> None:
    ax = draw_maps(surface, "test", None)["surface.png"].axes[0]
    lines = [p.vertices for c in ax.collections if not isinstance(c, TriMesh)
             for p in c.get_paths() if len(p.vertices)]
    edge = 1e-3 * np.vstack(lines)
    spacing = np.hypot(RADIUS * ANGLE / 16, WIDTH / 24)
    apart = np.abs(np.hypot(edge[:, 0] / HALF_S, edge[:, 1] / HALF_Z) - 1) * HALF_S
    assert apart.max() < 1.5 * spacing


def test_arrows_point_along_the_flux(surface: SurfaceMap) -> None:
    figures = draw_maps(surface, "test", None)
    (ax,) = (ax for ax in figures["flow.png"].axes
             if any(isinstance(c, Quiver) for c in ax.collections))
    (arrows,) = (c for c in ax.collections if isinstance(c, Quiver))
    drawn = ~arrows.Umask
    assert drawn.sum() > 50
    assert (arrows.U[drawn] > 0).all()
    outside = drawn & (np.abs(arrows.X) > 0.6) & (np.abs(arrows.Y) > 0.6)  # beyond a cell
    towards = np.sign(-arrows.X * arrows.Y)
    assert (np.sign(arrows.V)[outside] == towards[outside]).all()
    found = panels(figures["flow.png"])
    assert list(found) == ["film flux |Q| [mm²/s]", "flow out of the layer V [μm/s]"]
    np.testing.assert_allclose(found["flow out of the layer V [μm/s]"].get_array(),
                               1e6 * surface.V)


def test_a_strip_is_drawn_in_rows_that_use_the_width() -> None:
    strip = body_surface(depth=1e-3)
    strip = replace(strip, p_c=np.where(np.abs(strip.s) < HALF_S, 1e5, 0.0))
    figure = draw_maps(strip, "test", None)["surface.png"]
    axes = [ax for ax in figure.axes if any(isinstance(c, TriMesh) for c in ax.collections)]
    places = [ax.get_subplotspec().get_gridspec().get_geometry() for ax in axes]
    assert len(axes) == 3
    assert set(places) == {(3, 1)}
    assert axes[0].get_aspect() == "auto"


def test_a_dry_surface_has_no_flow(surface: SurfaceMap) -> None:
    zero = np.zeros_like(surface.s)
    dry = replace(surface, p=zero, V=zero, Q_s=zero, Q_z=zero, Q=np.zeros_like(surface.Q))
    figures = draw_maps(dry, "test", None)
    assert set(figures) == {"surface.png", "profile_s.png", "profile_z.png"}
    assert list(panels(figures["surface.png"])) == ["contact pressure $p_c$ [kPa]", "gap h [μm]"]


def test_an_untouched_surface_can_be_drawn(surface: SurfaceMap) -> None:
    zero = np.zeros_like(surface.s)
    for h in (zero + 1e-5, surface.h + 1e-6):
        draw_maps(replace(surface, p=zero, p_c=zero, V=zero, h=h), "test", None)


def test_cuts_are_through_the_middle_and_the_highest_pressure(surface: SurfaceMap) -> None:
    figures = draw_maps(surface, "test", None)
    along, across = (figures[f"profile_{way}.png"].axes[0] for way in ("s", "z"))
    assert "z = 0 mm, the middle" in along.get_title(loc="left")
    fluid = next(line for line in along.lines if line.get_label() == "fluid pressure p")
    assert fluid.get_ydata().max() == pytest.approx(1e-3 * surface.p[surface.z == 0].max())
    assert "s = 0" in across.get_title(loc="left")
    assert across.get_xlabel() == "position across, z [mm]"


@pytest.mark.parametrize("along_nodes", [True, False])
def test_a_profile_is_that_of_the_nodes(surface: SurfaceMap, along_nodes: bool) -> None:
    chart = Chart.of(surface)
    profile = chart.profile(aside=0.0 if along_nodes else 1e-7)
    assert (len(profile.s) == 33) == along_nodes
    on = surface.z == 0
    order = np.argsort(surface.s[on])
    for name in ("p", "p_c", "V", "x"):
        expected = np.interp(profile.s, surface.s[on][order], getattr(surface, name)[on][order])
        np.testing.assert_allclose(getattr(profile, name), expected, atol=1e-3 * expected.max())
    np.testing.assert_array_equal(profile.h[profile.p_c > 0], 0.0)
    if along_nodes:
        touching = profile.s[profile.p_c > 0]
        assert touching.max() == surface.s[on & (surface.p_c > 0)].max()


@pytest.mark.parametrize(
    ("low", "high", "planes", "place", "words"),
    [
        (-6e-3, 6e-3, None, 0.0, "middle"),
        (0.0, 6e-3, ["front"], 0.0, "symmetry plane"),
        (-6e-3, 0.0, ["back"], 0.0, "symmetry plane"),
        (0.0, 6e-3, None, 3e-3, "middle"),
    ],
)
def test_where_a_surface_is_cut(surface: SurfaceMap, low: float, high: float,
                                planes: list[str] | None, place: float, words: str) -> None:
    nodes = surface.nodes.copy()
    nodes[:, 2] = low + (high - low) * (nodes[:, 2] / WIDTH + 0.5)
    chart = Chart.of(replace(surface, nodes=nodes))
    found = middle(chart, None if planes is None else scene(*planes))
    assert found == (pytest.approx(place, abs=1e-15), words)


def test_a_surface_that_looks_along_z_is_drawn_over_y(surface: SurfaceMap) -> None:
    turned = replace(surface, nodes=surface.nodes[:, [0, 2, 1]] * [1, 1, 0])
    assert Chart.of(turned).name == "y"


def test_a_large_surface_is_drawn_by_its_vertices(
    surface: SurfaceMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert len(Chart.of(surface).triangles.triangles) == 8 * len(surface.cells)
    monkeypatch.setattr("porolub.io.section._MOST", 1000)
    chart = Chart.of(surface)
    assert len(chart.triangles.triangles) == 2 * len(surface.cells)
    assert set(draw_maps(surface, "test", None)) == {
        "surface.png", "flow.png", "profile_s.png", "profile_z.png"}  # fmt: skip
