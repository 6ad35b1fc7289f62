"""An annulus sector as a mesh file, as a user would bring it: triangles, named boundaries.

    python meshes/sector.py sector.msh --size 0.1e-3

Lengths in m.  The boundaries a lubricated layer needs are named lubricated, bone, inlet, outlet.
"""

import argparse
import math

import gmsh


def build(path: str, outer: float, thickness: float, half_angle: float, size: float) -> None:
    """Write the mesh of second-order triangles; the lubricated arc is lowest at the origin."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    add = gmsh.model.occ

    def point(radius: float, angle: float) -> int:
        return add.addPoint(radius * math.sin(angle), outer - radius * math.cos(angle), 0.0)

    centre = add.addPoint(0.0, outer, 0.0)
    a, b = point(outer, -half_angle), point(outer, half_angle)
    d, c = point(outer - thickness, -half_angle), point(outer - thickness, half_angle)
    sides = {"lubricated": add.addCircleArc(a, centre, b), "outlet": add.addLine(b, c),
             "bone": add.addCircleArc(c, centre, d), "inlet": add.addLine(d, a)}
    layer = add.addPlaneSurface([add.addCurveLoop(list(sides.values()))])
    add.remove([(0, centre)])
    add.synchronize()
    for name, curve in sides.items():
        gmsh.model.addPhysicalGroup(1, [curve], name=name)
    gmsh.model.addPhysicalGroup(2, [layer], name="layer")
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)
    gmsh.write(path)
    gmsh.finalize()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path")
    parser.add_argument("--outer-radius", type=float, default=100e-3)
    parser.add_argument("--thickness", type=float, default=1e-3)
    parser.add_argument("--half-angle", type=float, default=math.radians(5))
    parser.add_argument("--size", type=float, default=0.12e-3)
    o = parser.parse_args()
    build(o.path, o.outer_radius, o.thickness, o.half_angle, o.size)
