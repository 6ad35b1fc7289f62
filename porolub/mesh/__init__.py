"""Meshes: gmsh builds them, DMPlex distributes them, the rest of porolub reads the arrays."""

from porolub.mesh.build import build_mesh
from porolub.mesh.mesh import Facets, Mesh
from porolub.mesh.shape import Block, Sector, Shape

__all__ = ["Block", "Facets", "Mesh", "Sector", "Shape", "build_mesh"]
