"""A valid scene: values in SI, defaults, what follows from what, and that it cannot change."""

import math
from pathlib import Path

import pytest
from pydantic import ValidationError

from porolub.scene import Scene, effects, estimate_unknowns, load_scene, scene_from_dict
from porolub.scene.derived import derived
from porolub.scene.geometry import Sector
from porolub.scene.read import read_tables
from tests.scene.scenes import CUBE, ROLLING, changed

JOBS = Path(__file__).parents[2] / "jobs"


def test_quantities_are_plain_si_floats() -> None:
    scene = scene_from_dict(ROLLING)
    assert isinstance(scene.geometry, Sector)
    assert scene.geometry.outer_radius == 0.1
    assert scene.geometry.inner_radius == pytest.approx(0.099)
    assert scene.geometry.half_angle == math.radians(5)
    assert scene.solid is not None
    assert scene.solid.shear_modulus == 5e5
    assert scene.pores is not None
    assert (scene.pores.permeability, scene.pores.storage) == (1e-15, 2.08e-9)
    assert scene.load is not None
    assert scene.load.force == 1500.0


def test_defaults_are_those_of_the_manual() -> None:
    scene = scene_from_dict(ROLLING)
    assert (scene.mesh.degree, scene.mesh.pressure_degree) == (2, 1)
    assert (scene.mesh.grading, scene.mesh.element, scene.mesh.edge_size) == ("none", "quad", None)
    assert scene.solid is not None
    assert scene.solid.base == "sliding"
    assert scene.film is not None
    assert (scene.film.shear_film_min, scene.film.squeeze) == (1e-7, True)
    assert scene.contact is not None
    assert scene.contact.friction_traction is False
    assert scene.fluid_density == 1000.0
    assert scene.conventions.surface_traction == "balanced"
    assert scene.conventions.frame == "spatial"
    assert scene.boundary == {}
    assert scene.time is None


@pytest.mark.parametrize(
    ("base", "asked", "entering"),
    [
        ("sliding", None, "computed"),
        ("bonded", None, "fresh"),
        ("bonded", "computed", "computed"),
        ("sliding", "fresh", "fresh"),
    ],
)
def test_what_enters_is_fresh_by_default_only_with_a_bonded_base(
    base: str, asked: str | None, entering: str
) -> None:
    tables = changed(ROLLING, solid={"base": base}, conventions={"entering": asked})
    assert scene_from_dict(tables).conventions.entering == entering


def test_young_and_poisson_are_converted_to_shear_and_bulk() -> None:
    solid = scene_from_dict(CUBE).solid
    assert solid is not None
    assert solid.shear_modulus == pytest.approx(3e6 / 2.5)
    assert solid.bulk_modulus == pytest.approx(3e6 / 1.5)
    assert solid.young_modulus is None


def test_fluid_density_may_come_from_the_film() -> None:
    film = {"viscosity": "1 mPa*s", "fluid_density": "870 kg/m^3"}
    tables = changed(ROLLING, pores=None, film=film)
    assert scene_from_dict(tables).fluid_density == 870.0
    assert scene_from_dict(changed(ROLLING, pores=None)).fluid_density == 1000.0


def test_a_scene_cannot_change() -> None:
    scene = scene_from_dict(ROLLING)
    with pytest.raises(ValidationError):
        scene.mesh.along = 3  # type: ignore[misc]


def test_effects_are_those_the_scene_has_in_a_fixed_order() -> None:
    assert effects(scene_from_dict(ROLLING)) == [
        "solid", "pores", "carry", "film", "contact", "rotation", "load",
    ]  # fmt: skip
    assert effects(scene_from_dict(CUBE)) == ["solid", "contact", "load"]
    sheared = changed(ROLLING, contact={"friction_traction": True}, time={"end": "1 s"})
    assert effects(scene_from_dict(sheared))[3:8] == [
        "film", "squeeze", "contact", "friction_traction", "rotation",
    ]  # fmt: skip


def test_a_rigid_layer_needs_no_solid() -> None:
    tables = changed(ROLLING, solid=None, pores=None, contact=None)
    assert effects(scene_from_dict(tables)) == ["film", "rotation", "load"]


def test_a_block_without_plane_is_a_scene() -> None:
    consolidation = {
        "geometry": {"shape": "block", "width": "1 mm", "thickness": "10 mm"},
        "mesh": {"along": 1, "across": 20},
        "solid": ROLLING["solid"],
        "pores": changed(ROLLING, pores={"carry": False})["pores"],
        "boundary": {
            "top": {"traction": "10 kPa", "pressure": "0 Pa"},
            "left": {"displacement": {"x": "0 m"}, "traction": {"y": "1 kPa"}},
        },
    }
    scene = scene_from_dict(consolidation)
    assert scene.boundary["top"].traction == 1e4
    assert scene.boundary["top"].displacement is None
    left = scene.boundary["left"]
    assert left.displacement is not None
    assert (left.displacement.x, left.displacement.y, left.pressure) == (0.0, None, None)


def test_a_linear_law_is_not_weighted() -> None:
    """M = K + 4/3 G, whatever the Biot coefficient."""
    linear = {**ROLLING, "solid": {**ROLLING["solid"], "law": "linear"}}
    scene = scene_from_dict(linear)
    expected = scene.solid.bulk_modulus + 4 / 3 * scene.solid.shear_modulus
    assert derived(scene).confined_modulus == pytest.approx(expected)


def test_derived_numbers_of_the_reference_scene() -> None:
    # by hand: M = 0.1 * 5 MPa + 4/3 * 0.9 * 0.5 MPa; c = M 1e-12 / 0.81; U = 0.1 m/s, d = 1 mm
    d = derived(scene_from_dict(ROLLING))
    assert d.confined_modulus == pytest.approx(1.1e6)
    assert d.consolidation == pytest.approx(1.1e-6 / 0.81)
    assert d.surface_speed == pytest.approx(0.1)
    assert d.peclet == pytest.approx(1e-4 * 0.81 / 1.1e-6)
    assert d.outlet_layer == pytest.approx(1.1e-5 / 0.81)
    assert d.element_length == pytest.approx(0.2 * math.radians(5) / 300)


SCENES = sorted(path for path in JOBS.glob("*.toml") if "sweep" not in read_tables(path))


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_shipped_scenes_are_valid(path: Path) -> None:
    assert isinstance(load_scene(path), Scene)


def test_case_1_is_the_paper_s() -> None:
    """Table 3 of the reference paper, and its mesh."""
    scene = load_scene(JOBS / "case1.toml")
    reference = changed(ROLLING, scene={"title": scene.title})
    assert scene == scene_from_dict(reference)


def test_case_1_variants_differ_from_it_only_where_they_say() -> None:
    def differences(name: str) -> dict[str, object]:
        one, other = (load_scene(JOBS / f"{n}.toml").resolved() for n in ("case1", name))
        return {
            f"{section}.{key}": other[section][key]
            for section in one
            for key in one[section]
            if other[section][key] != one[section][key] and key != "title"
        }

    graded = {"mesh.grading": "contact"}
    bonded = {
        "solid.base": "bonded",
        "contact.friction_traction": True,
        "conventions.entering": "fresh",
    }
    slides = {"pores.carry": False, "motion.kind": "sliding", "motion.speed": "0.1 m/s"}
    assert differences("case1_graded") == graded
    assert differences("case1_bonded") == bonded
    assert differences("case1_bonded_graded") == graded | bonded
    # the film at the inlet decides Appendix A's fluid load, so it ships graded
    assert differences("appendix_a") == slides | graded


def test_the_cluster_s_joint_is_that_of_the_desk_on_a_finer_mesh() -> None:
    desk, cluster = (load_scene(JOBS / f"{n}.toml") for n in ("joint3d", "joint3d_cluster"))
    mesh = {key: getattr(cluster.mesh, key) for key in ("along", "across", "deep")}
    refined = desk.model_copy(update={"mesh": desk.mesh.model_copy(update=mesh)})
    assert refined.resolved() | {"scene": None} == cluster.resolved() | {"scene": None}
    assert 150_000 < estimate_unknowns(desk)["total"] < 250_000
    assert 18e6 < estimate_unknowns(cluster)["total"] < 25e6


def test_the_batch_script_runs_the_cluster_s_scene() -> None:
    text = (JOBS / "joint3d.slurm").read_text()
    assert "run jobs/joint3d_cluster.toml" in text
