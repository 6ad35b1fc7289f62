"""The sequence of meshes a scene is solved on."""

from itertools import pairwise
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from porolub.scene import load_scene
from porolub.solve.levels import COARSEST, Level, levels_of
from tests.mesh.scenes import sector_file
from tests.solve.models import JOBS, block, case1


@given(st.integers(1, 1500), st.integers(3, 60), st.sampled_from(["none", "contact"]))
def test_each_mesh_halves_the_elements_of_the_next_down_to_a_coarse_one(
    along: int, across: int, grading: str
) -> None:
    levels = levels_of(case1(along, across, f"mesh.grading={grading}"))
    assert levels[-1] == Level(along, across, graded=grading == "contact")
    assert levels[0].along <= COARSEST[2]
    alike = [level for level in levels if level.graded == levels[-1].graded]
    for coarse, fine in pairwise(alike):
        assert coarse.along == (fine.along + 1) // 2
        assert 3 <= coarse.across <= fine.across
        assert fine.along > COARSEST[2]


def test_graded_meshes_start_from_the_coarsest_one_ungraded() -> None:
    scene = case1(60, 6, "mesh.grading=contact")
    assert levels_of(scene) == [Level(60, 6), Level(60, 6, graded=True)]
    scene = case1(300, 30, "mesh.grading=contact")
    graded = [Level(75, 8, graded=True), Level(150, 15, graded=True), Level(300, 30, graded=True)]
    assert levels_of(scene) == [Level(75, 8), *graded]


def test_the_shipped_mesh_comes_last_of_three() -> None:
    assert levels_of(case1(300, 30)) == [Level(75, 8), Level(150, 15), Level(300, 30)]


def test_what_has_no_contact_or_no_logical_coordinates_is_solved_on_its_own_mesh(
    tmp_path: Path,
) -> None:
    seepage = block(mesh={"along": 300, "across": 30}, boundary={"top": {"traction": "1 kPa"}})
    assert levels_of(seepage) == [Level(300, 30)]
    path = sector_file(tmp_path / "sector.msh")
    scene = case1(1, 1, f"geometry={{shape='file', path='{path}'}}", "mesh.along=", "mesh.across=",
                  "motion=none", "pores=none")
    assert len(levels_of(scene)) == 1


def test_bodies_are_coarser_in_all_three_directions() -> None:
    scene = load_scene(JOBS / "joint3d.toml", ["mesh.along=160", "mesh.across=8", "mesh.deep=30"])
    assert levels_of(scene) == [Level(40, 3, 8), Level(80, 4, 15), Level(160, 8, 30)]
    assert [level.cells for level in levels_of(scene)] == [960, 4800, 38400]
    assert levels_of(scene)[0].name == "40 x 3 x 8"
