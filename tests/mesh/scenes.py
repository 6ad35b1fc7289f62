"""Scenes and mesh files for the mesh tests."""

from pathlib import Path
from types import SimpleNamespace as Section
from typing import Any

import gmsh
import numpy as np

RADIUS, THICKNESS, ANGLE = 0.1, 1e-3, np.deg2rad(5.0)


def scene(shape: str, dimension: int = 2, element: str = "quad", **geometry: Any) -> Section:
    """The parts of a scene that build_mesh reads, for a 12 x 4 (x 3) mesh; lengths in m."""
    sizes = {
        "sector": {"outer_radius": RADIUS, "half_angle": ANGLE},
        "barrel": {"outer_radius": RADIUS, "half_angle": ANGLE, "width": 0.01},
        "block": {"width": 0.02, "depth": 0.003 if dimension == 3 else None},
        "file": {},
    }[shape]
    return Section(
        scene=Section(dimension=dimension),
        geometry=Section(shape=shape, thickness=THICKNESS, **{**sizes, **geometry}),
        mesh=Section(along=12, across=4, deep=3, degree=2, element=element),
    )


ARC = {1: "bone", 2: "outlet", 3: "lubricated", 4: "inlet"}


def sector_file(
    path: Path,
    *,
    order: int = 1,
    quads: bool = False,
    names: dict[int, str] = ARC,
    version: float = 4.1,
    incomplete: bool = False,
) -> Path:
    """An unstructured mesh of the sector by gmsh: sides 1 to 4 named by `names`."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", int(incomplete))
        geo = gmsh.model.geo
        centre = geo.addPoint(0, RADIUS, 0)
        size = THICKNESS / 3
        ends = []
        for radius, side in ((1, -1), (1, 1), (0, 1), (0, -1)):
            r, t = RADIUS - radius * THICKNESS, side * ANGLE
            ends.append(geo.addPoint(r * np.sin(t), RADIUS - r * np.cos(t), 0, size))
        a, b, c, d = ends
        geo.addCircleArc(a, centre, b, 1)
        geo.addLine(b, c, 2)
        geo.addCircleArc(c, centre, d, 3)
        geo.addLine(d, a, 4)
        geo.addPlaneSurface([geo.addCurveLoop([1, 2, 3, 4])], 1)
        geo.synchronize()
        if quads:
            gmsh.model.mesh.setRecombine(2, 1)
        for tag, name in names.items():
            gmsh.model.addPhysicalGroup(1, [tag], tag, name)
        gmsh.model.addPhysicalGroup(2, [1], 9, "layer")
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return path


BOX = {"left": (0, 0.0), "right": (0, 2e-3), "bottom": (1, 0.0), "top": (1, 1e-3)}
BOX |= {"front": (2, 0.0), "back": (2, 3e-3)}


def box_file(
    path: Path, *, order: int, hexahedra: bool, names: dict[str, str] | None = None
) -> Path:
    """An unstructured mesh of the box 2 x 1 x 3 mm; the sides have the names of a block, or what
    `names` calls them instead."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.7e-3)
        gmsh.model.occ.addBox(0, 0, 0, 2e-3, 1e-3, 3e-3)
        gmsh.model.occ.synchronize()
        if hexahedra:
            gmsh.model.mesh.setTransfiniteAutomatic()
        for tag, (side, (axis, value)) in enumerate(BOX.items(), start=1):
            faces = [
                face
                for _, face in gmsh.model.getEntities(2)
                if abs(gmsh.model.occ.getCenterOfMass(2, face)[axis] - value) < 1e-9
            ]
            gmsh.model.addPhysicalGroup(2, faces, tag, (names or {}).get(side, side))
        gmsh.model.addPhysicalGroup(3, [1], 9, "layer")
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(order)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return path


def barrel_file(
    path: Path,
    *,
    hexahedra: bool,
    counts: tuple[int, int, int] = (12, 2, 3),
    width: float = 4e-3,
    order: int = 2,
) -> Path:
    """The sector drawn out in z from -width/2 by gmsh: hexahedra, or tetrahedra in their place."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.ElementOrder", order)
        geo = gmsh.model.geo
        z = -width / 2
        centre = geo.addPoint(0, RADIUS, z)
        a, b, c, d = (
            geo.addPoint(r * np.sin(t), RADIUS - r * np.cos(t), z)
            for r in (RADIUS, RADIUS - THICKNESS)
            for t in ((-ANGLE, ANGLE) if r == RADIUS else (ANGLE, -ANGLE))
        )
        lines = [
            *(geo.addCircleArc(a, centre, b), geo.addLine(b, c)),
            *(geo.addCircleArc(c, centre, d), geo.addLine(d, a)),
        ]
        for line, many in zip(lines, (counts[0], counts[1]) * 2, strict=True):
            geo.mesh.setTransfiniteCurve(line, many + 1)
        face = geo.addPlaneSurface([geo.addCurveLoop(lines)])
        geo.mesh.setTransfiniteSurface(face)
        if hexahedra:
            geo.mesh.setRecombine(2, face)
        drawn = geo.extrude([(2, face)], 0, 0, width, [counts[2]], recombine=hexahedra)
        geo.synchronize()
        names = ("lubricated", "outlet", "bone", "inlet")
        sides = dict(zip(names, (tag for _, tag in drawn[2:6]), strict=True))
        sides |= {"front": face, "back": drawn[0][1]}
        for name, tag in sides.items():
            gmsh.model.addPhysicalGroup(2, [tag], name=name)
        gmsh.model.addPhysicalGroup(3, [drawn[1][1]], name="layer")
        gmsh.model.mesh.generate(3)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return path
