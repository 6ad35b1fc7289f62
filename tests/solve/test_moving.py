"""Where a body turns, on what surface, and through which boundaries: measured on meshes."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from porolub.errors import SceneError
from porolub.mesh import build_mesh
from porolub.scene import Scene, scene_from_dict
from porolub.solve.model import Model, build_model, scales_of
from porolub.solve.moving import passing
from porolub.solve.surface import fit_round, typical_thickness
from porolub.terms.carry import Carry
from tests.physics.solid_files import barrel, cap, solid_file
from tests.scene.scenes import ROLLING, changed

RANKS = Path(__file__).with_name("moving_ranks.py")
R, D = 0.1, 1e-3
TURN = {"x": [1, 2, 0], "y": [2, 0, 1], "z": [0, 1, 2]}  # of the axes, so that z becomes the key


def tables(path: Path, **sections: Any) -> dict[str, Any]:
    """Case 1 on a mesh file."""
    base = changed(ROLLING, scene={"dimension": 3}, mesh=None, load={"force": "1 N"})
    base["geometry"] = {"shape": "file", "path": str(path), "symmetry": ["front", "back"]}
    return changed(base, **sections)


def model(given: dict[str, Any] | Scene) -> Model:
    scene = scene_from_dict(given) if isinstance(given, dict) else given
    thickness = getattr(scene.geometry, "thickness", None)
    if thickness is None:
        thickness = typical_thickness(build_mesh(scene, MPI.COMM_SELF), "lubricated")
    mesh = build_mesh(scene, MPI.COMM_SELF, length_scale=thickness)
    return build_model(scene, mesh, scales_of(scene, thickness))


def ends(of: Model) -> set[str]:
    (carry,) = [t for t in of.system.terms if isinstance(t, Carry)]
    return set(carry.ends)


BARREL = changed(
    ROLLING, scene={"dimension": 3}, load={"force": "1 N"},
    geometry={"shape": "barrel", "width": "4 mm", "crown_radius": "20 mm"},
    mesh={"along": 8, "across": 1, "deep": 2})


@pytest.mark.parametrize(("planes", "low", "high"), [
    ([], -2e-3, 2e-3), (["front"], 0.0, 2e-3), (["back"], -2e-3, 0.0),
    (["front", "back"], -2e-3, 2e-3)])
def test_symmetry_planes_halve_a_barrel_and_the_film_goes_on_behind_them(planes, low, high):
    of = model(changed(BARREL, geometry={"symmetry": planes}))
    mesh, dofs = of.mesh, of.dofs
    z = mesh.coordinates[:, 2] * D
    assert (z.min(), z.max()) == pytest.approx((low, high), abs=1e-12)
    np.testing.assert_allclose(mesh.shape.physical(mesh.logical(mesh.coordinates)),
                               mesh.coordinates, atol=1e-12)
    fixed = set(of.system.constraints.fixed.tolist())
    base = dofs.base["p"]
    for name in ("inlet", "outlet", "front", "back"):
        rim = np.intersect1d(mesh.boundary_nodes("lubricated"), mesh.boundary_nodes(name))
        inner = [n for n in rim if base[n] >= 0 and abs(mesh.coordinates[n, 0]) < 8.0]
        held = {int(base[n]) in fixed for n in (inner or rim[base[rim] >= 0])}
        assert held == {name not in planes}, name
    assert ends(of) == {"inlet", "outlet"}


def test_a_mesh_without_the_plane_says_what_it_has(tmp_path):
    path = solid_file(tmp_path / "b.msh", (4, 1, 1), barrel(R, D, 0.05, 2e-3))
    with pytest.raises(SceneError, match='geometry.symmetry: "middle": the mesh has no such bound'):
        model(tables(path, geometry={"symmetry": ["middle"]}))


@pytest.mark.parametrize("axis", TURN)
def test_a_cylinder_in_a_file_turns_about_any_axis(tmp_path, axis):
    """The barrel with its axes renamed: same centre, same arc positions, same ends."""
    order = np.argsort(TURN[axis])  # component k of the file is component order[k] of the barrel
    place = barrel(R, D, 0.05, 2e-3)
    path = solid_file(tmp_path / "b.msh", (6, 1, 2), lambda q: place(q)[:, order])
    normal = np.array([0.0, -1.0, 0.0])[order]
    of = model(tables(path, geometry={"plane_normal": normal.tolist()}, motion={"axis": axis}))
    centre = np.array([0.0, R, 0.0])[order] / of.scales.length
    a = np.array(of.operation.axis)
    apart = np.asarray(of.operation.centre) - centre
    np.testing.assert_allclose(apart - (apart @ a) * a, 0.0, atol=1e-8)
    assert ends(of) == {"inlet", "outlet"}
    assert of.surface is not None
    assert of.surface.circle is not None
    X = of.mesh.coordinates[of.mesh.boundary_nodes("lubricated")]
    s = of.surface.circle.arc(X) * of.scales.length
    assert (s.min(), s.max()) == pytest.approx((-0.05 * R, 0.05 * R), rel=1e-6)
    speed = of.operation.body_velocity(X)
    along = np.asarray(of.surface.circle.along)
    of.operation.speed = 1.0
    assert (of.operation.body_velocity(X) @ along > 0.9 * np.linalg.norm(centre)).all()
    assert speed.shape == X.shape


@pytest.mark.parametrize(("axis", "passed"), [
    ("z", {"inlet", "outlet"}), ("x", {"inlet", "outlet", "front", "back"}),
    ([1.0, 0.0, 1.0], {"inlet", "outlet", "front", "back"})])
def test_a_sphere_is_found_and_turns_about_any_axis(tmp_path, axis, passed):
    path = solid_file(tmp_path / "cap.msh", (6, 1, 6), cap(R, D, 0.05, 5e-3))
    of = model(tables(path, geometry={"symmetry": []}, motion={"axis": axis}))
    centre = np.asarray(of.operation.centre) * of.scales.length
    along = np.array([0.0, 0.0, 1.0]) if axis == "z" else np.zeros(3)  # free along the axis
    np.testing.assert_allclose((centre - [0.0, R, 0.0]) * (1.0 - along), 0.0, atol=1e-9)
    assert ends(of) == passed


def test_carry_refuses_a_body_that_turns_through_itself(tmp_path):
    path = solid_file(tmp_path / "b.msh", (6, 1, 2), barrel(R, D, 0.05, 2e-3))
    for motion in ({"axis": "x", "centre": ["0 m", "0.1 m", "0 m"]},
                   {"centre": ["5 mm", "0.1 m", "0 m"]}):
        given = tables(path, motion=motion, geometry={"symmetry": []})
        with pytest.raises(SceneError, match=r"pores\.carry = true: .* no surface of revolution"):
            model(given)
        assert model(changed(given, pores={"carry": False})).operation.kind == "rotation"


def test_the_motion_may_not_pass_a_symmetry_plane_of_a_file(tmp_path):
    path = solid_file(tmp_path / "cap.msh", (4, 1, 4), cap(R, D, 0.05, 5e-3))
    with pytest.raises(SceneError, match='geometry.symmetry: "front" is passed by the motion'):
        model(tables(path, geometry={"symmetry": ["front"]}, motion={"axis": "x"}))
    slides = {"kind": "sliding", "speed": "1 mm/s", "direction": [1.0, 0.0, 0.2]}
    given = tables(path, pores={"carry": False})
    given["motion"] = slides
    with pytest.raises(SceneError, match="is passed by the motion"):
        model(given)


def test_without_a_round_surface_there_is_no_centre(tmp_path):
    def wavy(q):
        return barrel(R, D, 0.05, 2e-3)(q) + [0.0, 1e-4, 0.0] * np.sin(9 * q[:, :1])

    path = solid_file(tmp_path / "w.msh", (6, 1, 2), wavy)
    with pytest.raises(SceneError, match="no cylinder about motion.axis, and no sphere.*centre"):
        model(tables(path))
    of = model(tables(path, motion={"centre": ["0 m", "0.1 m", "0 m"]}, pores={"carry": False}))
    np.testing.assert_allclose(of.operation.centre, [0.0, R / of.scales.length, 0.0])


def test_what_is_passed_does_not_depend_on_the_speed():
    of = model(changed(BARREL, geometry={"symmetry": ["front"]}))
    names = of.mesh.boundary_names
    share = passing(of.mesh, of.operation, names)
    of.operation.speed = 0.0
    assert passing(of.mesh, of.operation, names) == share
    assert share["inlet"] == pytest.approx(1.0, abs=1e-5)
    assert max(share[name] for name in ("front", "back", "lubricated", "bone")) < 1e-10


@pytest.mark.parametrize("dim", [2, 3])
def test_circles_and_spheres_are_found_from_a_part_of_them(dim):
    random = np.random.default_rng(3)
    rays = random.normal(size=(200, dim)) * 0.1
    rays[:, 1] = -1.0
    X = 7.0 * rays / np.linalg.norm(rays, axis=1)[:, None] + np.arange(1.0, dim + 1)
    found = fit_round(X, MPI.COMM_SELF)
    assert found is not None
    np.testing.assert_allclose(found[0], np.arange(1.0, dim + 1), rtol=1e-9)
    assert found[1] == pytest.approx(7.0, rel=1e-9)
    assert fit_round(X * [1.0, 1.05, 1.0][:dim] + 0.01 * random.normal(size=X.shape),
                     MPI.COMM_SELF) is None
    flat = X.copy()
    flat[:, 1] = 0.0
    assert fit_round(flat, MPI.COMM_SELF) is None
    assert fit_round(X[:dim], MPI.COMM_SELF) is None


@pytest.mark.mpi
def test_all_ranks_find_the_same(run_mpi, tmp_path):
    path, axes = solid_file(tmp_path / "cap.msh", (6, 1, 6), cap(R, D, 0.05, 5e-3)), ("x", "z")
    found = []
    for ranks in (1, 3):
        said = run_mpi(ranks, RANKS, path, *axes).splitlines()
        lines = [line.split()[1:] for line in said if "FOUND" in line]
        found.append([[float(word) for word in line] for line in lines])
    for axis, one, other in zip(axes, *found, strict=True):
        assert one[1] == pytest.approx(100.0, rel=1e-9), axis
        np.testing.assert_allclose(other, one, rtol=1e-9, atol=1e-7, err_msg=axis)
