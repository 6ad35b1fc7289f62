"""Small meshes to test with: straight and curved, of every cell, in units of their own."""

import dataclasses
import tempfile
from functools import cache
from pathlib import Path
from types import SimpleNamespace as Section

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from porolub.mesh import Mesh, build_mesh
from tests.mesh.scenes import box_file

Array = NDArray[np.float64]

RADIUS, THICKNESS, ANGLE, WIDTH = 2.0, 1.0, 0.6, 1.5  # a thick, strongly curved layer
BLOCK = {"width": 3.0, "thickness": 1.0}
ARC = {"outer_radius": RADIUS, "thickness": THICKNESS, "half_angle": ANGLE}

SHAPES = {
    "sector": (2, "quad", {"shape": "sector", **ARC}),
    "sector of triangles": (2, "triangle", {"shape": "sector", **ARC}),
    "barrel": (3, "quad", {"shape": "barrel", **ARC, "width": WIDTH, "crown_radius": 3.0}),
    "block": (2, "quad", {"shape": "block", **BLOCK, "depth": None}),
    "block of triangles": (2, "triangle", {"shape": "block", **BLOCK, "depth": None}),
    "cuboid": (3, "quad", {"shape": "block", **BLOCK, "depth": 2.0}),
}
CURVED = ["sector", "sector of triangles", "barrel"]
FLAT = ["block", "block of triangles", "cuboid"]
ALL = [*CURVED, *FLAT, "box of tets"]


@cache
def mesh(kind: str, along: int = 4, across: int = 3, deep: int = 2, degree: int = 2) -> Mesh:
    """A mesh of SHAPES, or "box of tets": [0, 2] x [0, 1] x [0, 3]."""
    if kind == "box of tets":
        with tempfile.TemporaryDirectory() as directory:
            path = box_file(Path(directory) / "box.msh", order=1, hexahedra=False)
            what = Section(scene=Section(dimension=3), mesh=Section(degree=degree),
                           geometry=Section(shape="file", path=str(path)), boundary=("top",))
            return build_mesh(what, MPI.COMM_SELF, length_scale=1e-3)
    dimension, element, geometry = SHAPES[kind]
    what = Section(
        scene=Section(dimension=dimension),
        geometry=Section(**geometry),
        mesh=Section(along=along, across=across, deep=deep, degree=degree, element=element),
    )
    return build_mesh(what, MPI.COMM_SELF)


def surface(kind: str) -> str:
    """The lubricated surface of a kind of mesh."""
    return "lubricated" if kind in CURVED else "top"


def moved(of: Mesh, vertices: Array) -> Mesh:
    """The mesh with other positions of its vertices (nvertices, dim) and straight edges."""
    places = np.empty_like(of.coordinates)
    places[: of.nvertices] = vertices
    column = of.cell.vertices
    for parents in of.cell.parents():
        nodes = of.cells[:, column : column + len(parents)]
        places[nodes] = places[of.cells[:, parents]].mean(axis=2)
        column += len(parents)
    return dataclasses.replace(of, coordinates=places)


def distorted(of: Mesh, size: float = 0.08) -> Mesh:
    """All vertices moved at random by up to `size`, edges straight."""
    shift = np.random.default_rng(2).uniform(-size, size, (of.nvertices, of.dim))
    return moved(of, of.coordinates[: of.nvertices] + shift)
