"""A scene costs what it asks for, and effects that are left out leave what theory says."""

from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from porolub.mesh import build_mesh
from porolub.scene import Scene
from porolub.solve.model import build_model, scales_of
from tests.run.output import Output, run, shipped

DRY = ["pores=none", "film=none", "motion=none"]
NO_FILM = ["film=none"]
NO_PORES = ["pores=none"]


def matrix_of(scene: Scene) -> tuple[set[str], int]:
    """Fields with rows in the scene's matrix, and the number of its entries."""
    scales = scales_of(scene, scene.geometry.thickness)
    mesh = build_mesh(scene, MPI.COMM_SELF, length_scale=scales.length)
    model = build_model(scene, mesh, scales)
    matrix = model.system.create_matrix()
    entries = int(matrix.getInfo()["nz_used"])
    matrix.destroy()
    return set(model.dofs.fields), entries


def test_a_dry_scene_has_its_own_unknowns_only(tmp_path: Path, case1: Output) -> None:
    dry = run(tmp_path, shipped("case1", 60, 6, *DRY))
    fields = {"displacement", "contact_pressure", "approach"}
    assert set(dry.summary["dofs"]) == {*fields, "total"}
    assert all(dry.summary["dofs"][f] == case1.summary["dofs"][f] for f in fields)
    assert dry.summary["effects"] == ["solid", "contact", "load"]
    assert dry.fields.pressure is None
    assert dry.fields.flux is None
    assert np.all(dry.surface.p == 0.0)
    for key in ("pressure_max", "mass_balance_error", "inflow_left", "friction_fluid"):
        assert dry.summary[key] is None
    assert dry.summary["load_solid"] == pytest.approx(1500.0, rel=1e-8)
    assert dry.summary["friction_coefficient"] == pytest.approx(0.45)
    assert not (tmp_path / "flow.png").exists()


def test_a_dry_matrix_is_smaller_by_more_than_its_rows() -> None:
    wet_fields, wet = matrix_of(shipped("case1", 60, 6))
    dry_fields, dry = matrix_of(shipped("case1", 60, 6, *DRY))
    assert dry_fields == {"u", "l", "v0"}
    assert dry_fields < wet_fields
    assert dry < 0.8 * wet


def test_pores_at_rest_without_a_film_are_a_drained_solid(tmp_path: Path) -> None:
    """p = 0 in a steady state at rest; the skeleton is neo-Hookean with a G and (1 - a) K."""
    wet = run(tmp_path / "wet", shipped("case1", 40, 4, *NO_FILM, "motion=none",
                                        "pores.carry=false"))
    a, solid = wet.scene.pores.biot, wet.scene.solid
    moduli = [f"solid.shear_modulus={a * solid.shear_modulus!r} Pa",
              f"solid.bulk_modulus={(1 - a) * solid.bulk_modulus!r} Pa"]
    dry = run(tmp_path / "dry", shipped("case1", 40, 4, *DRY, *moduli))
    assert np.abs(wet.fields.pressure).max() < 1e-6
    for key in ("approach", "contact_length", "contact_pressure_max", "von_mises_max"):
        assert wet.summary[key] == pytest.approx(dry.summary[key], rel=1e-8), key
    np.testing.assert_allclose(wet.fields.displacement, dry.fields.displacement, atol=1e-13)


def test_without_a_film_the_open_surface_drains_and_the_closed_one_is_sealed(
    tmp_path: Path,
) -> None:
    found = run(tmp_path, shipped("case1", 60, 6, *NO_FILM))
    surface, summary = found.surface, found.summary
    assert "film" not in summary["effects"]
    assert summary["load_total"] == pytest.approx(1500.0, rel=1e-8)
    assert summary["mass_balance_error"] < 1e-8
    assert summary["load_fluid"] > 100.0
    closed = surface.h == 0.0
    inside = closed[:-2:2] & closed[1:-1:2] & closed[2::2]  # elements
    sealed, drained = inside[:-1] & inside[1:], ~closed[:-4:2] & ~closed[2:-2:2] & ~closed[4::2]
    assert 10 < sealed.sum() < 50
    assert 5 < drained.sum() < 50
    p, V = surface.p[2:-2:2], surface.V[2:-2:2]
    assert np.abs(p[drained]).max() < 1e-3 * surface.p.max()
    assert np.abs(V[sealed]).max() < 1e-9 * np.abs(V).max()
    assert np.all(surface.Q == 0.0)
    assert found.gap().min() > -1e-9


@pytest.mark.parametrize("speed", [0.1, 1.0])
def test_a_film_on_a_layer_without_pores(tmp_path: Path, speed: float) -> None:
    found = run(tmp_path, shipped("case1", 60, 6, *NO_PORES, f"motion.speed={speed} rad/s"))
    surface, summary = found.surface, found.summary
    assert set(summary["dofs"]) == {
        "displacement", "film_pressure", "contact_pressure", "approach", "total"}
    assert summary["dofs"]["film_pressure"] == 61
    assert summary["load_total"] == pytest.approx(1500.0, rel=1e-8)
    assert summary["mass_balance_error"] < 1e-8
    assert summary["inflow_left"] == summary["outflow_left"] == 0.0
    assert np.all(surface.V == 0.0)
    # with no exchange the film carries the same flux all along
    assert np.ptp(surface.Q) < 1e-12 * speed * 0.1 * surface.h.max()
    assert found.gap().min() > -1e-9
    assert surface.p_c.min() >= 0.0


def test_the_approach_may_be_given_instead_of_the_load(tmp_path: Path, case1: Output) -> None:
    approach = f"load={{approach='{case1.summary['approach']!r} m'}}"
    found = run(tmp_path, shipped("case1", 60, 6, approach))
    assert "approach" not in found.summary["dofs"]
    assert found.summary["load_balance_error"] is None
    assert found.summary["load_total"] == pytest.approx(1500.0, rel=1e-7)
    assert found.summary["approach"] == pytest.approx(case1.summary["approach"], rel=1e-12)
    np.testing.assert_allclose(found.surface.p, case1.surface.p, atol=1e-6 * case1.surface.p.max())
