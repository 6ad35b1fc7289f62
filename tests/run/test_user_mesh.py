"""A user's mesh of the same shape gives the answer of the built-in one."""

from pathlib import Path

import gmsh
import numpy as np
import pytest

from porolub.errors import SceneError
from porolub.scene import load_scene
from tests.mesh.scenes import sector_file
from tests.run.output import JOBS, Output, run, shipped

R, D, ANGLE = 0.1, 1e-3, np.deg2rad(5.0)
ALONG, ACROSS = 50, 4
LOADS = ("load_fluid", "load_solid", "approach", "contact_length", "friction_coefficient")
FLOWS = ("inflow_left", "inflow_right", "outflow_right")


def structured_file(path: Path, quads: bool) -> Path:
    """ALONG x ACROSS second-order quads, or twice as many triangles, by gmsh."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        geo = gmsh.model.geo
        centre = geo.addPoint(0, R, 0)
        a, b, c, d = (geo.addPoint(r * np.sin(t), R - r * np.cos(t), 0)
                      for r, t in ((R, -ANGLE), (R, ANGLE), (R - D, ANGLE), (R - D, -ANGLE)))
        sides = {"lubricated": geo.addCircleArc(a, centre, b), "outlet": geo.addLine(b, c),
                 "bone": geo.addCircleArc(c, centre, d), "inlet": geo.addLine(d, a)}
        layer = geo.addPlaneSurface([geo.addCurveLoop(list(sides.values()))])
        geo.synchronize()
        for name, curve in sides.items():
            count = ALONG if name in ("lubricated", "bone") else ACROSS
            gmsh.model.mesh.setTransfiniteCurve(curve, count + 1)
            gmsh.model.addPhysicalGroup(1, [curve], name=name)
        gmsh.model.mesh.setTransfiniteSurface(layer, "Alternate")
        gmsh.model.addPhysicalGroup(2, [layer], name="layer")
        if quads:
            gmsh.model.mesh.setRecombine(2, layer)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return path


def on_file(directory: Path, path: Path, *overrides: str) -> Output:
    """Case 1 on a mesh file."""
    geometry = [f"geometry={{shape='file', path='{path}'}}", "mesh.along=", "mesh.across="]
    scene = load_scene(JOBS / "case1.toml", [*geometry, *overrides])
    return run(directory / "on file", scene)


@pytest.fixture(scope="module")
def built_in(tmp_path_factory: pytest.TempPathFactory) -> Output:
    return run(tmp_path_factory.mktemp("built in"), shipped("case1", ALONG, ACROSS))


def test_the_same_quads_give_the_same_answer(tmp_path: Path, built_in: Output) -> None:
    """All that differs is that edges inside are straight: by h^2/(8 R), 1e-4 of the thickness."""
    found = on_file(tmp_path, structured_file(tmp_path / "quads.msh", quads=True))
    assert found.summary["dofs"] == built_in.summary["dofs"]
    for key in (*LOADS, *FLOWS, "contact_left", "contact_right", "penetration_length"):
        assert found.summary[key] == pytest.approx(built_in.summary[key], rel=1e-3), key
    assert found.fields.cell_type == "quad"
    np.testing.assert_allclose(found.surface.s, built_in.surface.s, atol=1e-9)
    peak = built_in.surface.p.max()
    np.testing.assert_allclose(found.surface.p, built_in.surface.p, atol=1e-3 * peak)


@pytest.mark.parametrize("kind", ["structured triangles", "free triangles", "free quads"])
def test_other_elements_of_that_size_agree_within_their_error(
    tmp_path: Path, built_in: Output, kind: str
) -> None:
    path = tmp_path / "mesh.msh"
    if kind == "structured triangles":
        structured_file(path, quads=False)
    else:
        sector_file(path, order=2, quads=kind == "free quads")
    found = on_file(tmp_path, path)
    summary = found.summary
    assert found.fields.cell_type == ("quad" if kind == "free quads" else "triangle")
    assert summary["load_total"] == pytest.approx(1500.0, rel=1e-8)
    assert summary["mass_balance_error"] < 1e-8
    for key in LOADS:
        assert summary[key] == pytest.approx(built_in.summary[key], rel=0.04), key
    assert found.gap().min() > -1e-9


def test_boundaries_by_other_names_are_asked_for(tmp_path: Path) -> None:
    path = sector_file(tmp_path / "mesh.msh", names={1: "bone", 2: "outlet", 3: "wet", 4: "inlet"})
    with pytest.raises(SceneError, match="no boundary named 'lubricated'"):
        on_file(tmp_path, path)
