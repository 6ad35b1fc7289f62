"""Fields and profiles handed to the writers: in SI, the same from any number of ranks."""

from pathlib import Path

import numpy as np
import pytest

from porolub.solve.gather import gather_fields, gather_state, gather_surface
from tests.mpirun import mpirun
from tests.solve.models import PORES, block, case1, model_of, vector, waves

SCRIPT = Path(__file__).with_name("gather_ranks.py")
ELEMENTS = ["quad", "triangle", "hex"]


@pytest.fixture(scope="module")
def gathered(tmp_path_factory: pytest.TempPathFactory) -> dict[int, Path]:
    """The directory of a number of ranks; starting them takes longer than what they do."""
    written = {}
    for ranks in (1, 2, 4):
        written[ranks] = tmp_path_factory.mktemp(f"{ranks} ranks")
        mpirun(written[ranks], ranks, SCRIPT, written[ranks], *ELEMENTS)
    return written


@pytest.mark.mpi
@pytest.mark.parametrize("element", ELEMENTS)
def test_no_rank_count_changes_what_is_gathered(gathered: dict[int, Path], element: str) -> None:
    found = {ranks: dict(np.load(path / f"{element}.npz")) for ranks, path in gathered.items()}
    one = found[1]
    assert {"fields nodes", "fields flux", "surface V", "state u"} <= set(one)
    assert ("surface cells" in one) == (element == "hex")
    for ranks in (2, 4):
        assert set(found[ranks]) == set(one)
        for name, values in one.items():
            scale = np.abs(values).max(initial=0.0)
            np.testing.assert_allclose(found[ranks][name], values, rtol=0, atol=1e-11 * scale,
                                       err_msg=f"{name} on {ranks} ranks")


def test_nodes_and_unknowns_are_in_si() -> None:
    with model_of(case1(6, 3)) as model:
        local = waves(model.dofs)
        x = vector(model, local)
        fields, state = gather_fields(model, x), gather_state(model, x)
        mesh, s = model.mesh, model.scales
        u = model.dofs.field("u", local)
        p = np.zeros(len(mesh.coordinates))
        p[model.dofs.nodes["p"]] = model.dofs.field("p", local)[:, 0]
    order = np.argsort(mesh.natural_node)
    np.testing.assert_allclose(fields.nodes, mesh.coordinates[order] * 1e-3, rtol=1e-14)
    np.testing.assert_allclose(fields.displacement, u[order] * 1e-3, atol=1e-18)
    vertices = order < mesh.nvertices
    np.testing.assert_allclose(fields.pressure[vertices], (p[order] * s.pressure)[vertices],
                               rtol=1e-12)
    np.testing.assert_array_equal(np.sort(fields.cells.ravel()), np.sort(
        mesh.natural_node[mesh.cells].ravel()))
    np.testing.assert_allclose(state.fields["u"][1], fields.displacement, rtol=1e-14)
    np.testing.assert_array_equal(state.mesh_nodes, fields.nodes)
    assert state.fields["v0"][1] == pytest.approx(0.05e-3)


def test_a_uniform_stretch_has_one_j_and_a_linear_pressure_one_flux() -> None:
    with model_of(block(pores=PORES, boundary={"top": {"pressure": "0 Pa"}},
                        conventions={"frame": "material"})) as model:
        local = np.zeros(model.dofs.size_local)
        X = model.mesh.coordinates
        model.dofs.field("u", local)[:] = X[model.dofs.nodes["u"]] * [0.02, -0.05]
        model.dofs.field("p", local)[:, 0] = X[model.dofs.nodes["p"]] @ [0.3, -0.7]
        fields = gather_fields(model, vector(model, local))
        pressure = model.scales.pressure
    np.testing.assert_allclose(fields.jacobian, 1.02 * 0.95, rtol=1e-12)
    assert np.ptp(fields.von_mises) < 1e-9 * fields.von_mises.max()
    assert fields.von_mises.max() > 0
    flux = -1e-12 * pressure / 1e-3 * np.array([0.3, -0.7])
    np.testing.assert_allclose(fields.flux, np.broadcast_to(flux, fields.flux.shape), rtol=1e-9)
    np.testing.assert_allclose(fields.pressure, fields.nodes @ [0.3, -0.7] * pressure / 1e-3,
                               atol=1e-9 * pressure)


def test_the_flux_of_the_spatial_frame_sees_the_stretched_distances() -> None:
    with model_of(block(pores=PORES, boundary={"top": {"pressure": "0 Pa"}})) as model:
        local = np.zeros(model.dofs.size_local)
        X = model.mesh.coordinates
        model.dofs.field("u", local)[:] = X[model.dofs.nodes["u"]] * [0.0, -0.2]
        model.dofs.field("p", local)[:, 0] = -X[model.dofs.nodes["p"], 1]
        fields = gather_fields(model, vector(model, local))
        expected = 1e-12 * model.scales.pressure / 1e-3 / 0.8
    np.testing.assert_allclose(fields.flux[:, 1], expected, rtol=1e-9)


def test_the_surface_is_sorted_and_complete() -> None:
    with model_of(case1(10, 3)) as model:
        local = waves(model.dofs)
        surface = gather_surface(model, vector(model, local))
    assert len(surface.s) == 21
    assert np.all(np.diff(surface.s) > 0)
    np.testing.assert_allclose(surface.x, 0.1 * np.sin(surface.s / 0.1), atol=1e-12)
    np.testing.assert_allclose(surface.p[1::2], (surface.p[:-1:2] + surface.p[2::2]) / 2)
    assert np.all(surface.h >= 0.0)
    assert np.all(surface.p_c >= 0.0)


def test_without_a_lubricated_surface_there_are_no_profiles() -> None:
    with model_of(block(boundary={"top": {"traction": "1 kPa"}})) as model:
        assert gather_surface(model, model.dofs.vector()) is None
        fields = gather_fields(model, model.dofs.vector())
        assert fields.pressure is None
        assert fields.flux is None
