"""Meshes: built in parallel or read from a file, distributed; plain arrays of each rank."""

from porolub.mesh.build import build_mesh, coarsened
from porolub.mesh.mesh import Boundary, Facets, Mesh
from porolub.mesh.shape import Block, Sector, Shape

__all__ = ["Block", "Boundary", "Facets", "Mesh", "Sector", "Shape", "build_mesh", "coarsened"]
