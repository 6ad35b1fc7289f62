"""Exact integrals over a mesh: sizes of its cells and facets from the nodes' positions."""

import numpy as np
from numpy.typing import NDArray

from porolub.mesh import Mesh

Array = NDArray[np.float64]


def line_shape(t: Array) -> tuple[Array, Array]:
    """Values and derivatives of the three quadratic shape functions on [-1, 1]: ends, middle."""
    value = np.stack([t * (t - 1) / 2, t * (t + 1) / 2, 1 - t * t], axis=-1)
    slope = np.stack([t - 0.5, t + 0.5, -2 * t], axis=-1)
    return value, slope


def facet_lengths(mesh: Mesh, name: str) -> Array:
    """Lengths (nf,) of the facets of a 2D mesh of degree 2, along their parabolas."""
    nodes = mesh.coordinates[mesh.facets(name).nodes]
    points, weights = np.polynomial.legendre.leggauss(8)
    tangent = np.einsum("qk,fkd->fqd", line_shape(points)[1], nodes)
    return np.linalg.norm(tangent, axis=2) @ weights


def outward(mesh: Mesh, name: str) -> Array:
    """Integral of the outward normal (dim,) over the vertices' polygons of a boundary."""
    facets = mesh.facets(name)
    corner = mesh.coordinates[facets.nodes]
    if mesh.dim == 2:
        along = corner[:, 1] - corner[:, 0]
        return np.stack([along[:, 1], -along[:, 0]], axis=1).sum(axis=0)
    if mesh.cell_type == "tet":
        twice = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    else:
        twice = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    return twice.sum(axis=0) / 2


def polygon_areas(mesh: Mesh) -> Array:
    """Signed areas (ncell,) of the cells of a 2D mesh between straight edges."""
    corner = mesh.coordinates[mesh.vertices_of_cells]
    following = np.roll(corner, -1, axis=1)
    return (corner[..., 0] * following[..., 1] - corner[..., 1] * following[..., 0]).sum(axis=1) / 2


def curved_area(mesh: Mesh) -> float:
    """Area of a 2D mesh of degree 2 from its outline: the sides are parabolas."""
    points, weights = np.polynomial.legendre.leggauss(8)
    value, slope = line_shape(points)
    total = 0.0
    for name in mesh.boundary_names:
        nodes = mesh.coordinates[mesh.facets(name).nodes]
        x, dx = np.einsum("qk,fkd->fqd", value, nodes), np.einsum("qk,fkd->fqd", slope, nodes)
        total += float(((x[..., 0] * dx[..., 1] - x[..., 1] * dx[..., 0]) @ weights).sum()) / 2
    return total


def straight_defect(mesh: Mesh) -> float:
    """Largest distance of a non-vertex node from the mean of the vertices it joins."""
    column, worst = mesh.cell.vertices, 0.0
    for parents in mesh.cell.parents():
        mean = mesh.coordinates[mesh.cells[:, parents]].mean(axis=2)
        nodes = mesh.coordinates[mesh.cells[:, column : column + len(parents)]]
        worst = max(worst, float(np.abs(nodes - mean).max()))
        column += len(parents)
    return worst


def volumes(mesh: Mesh) -> Array:
    """Volumes (ncell,) of straight tets or of parallelepiped hexahedra."""
    corner = mesh.coordinates[mesh.vertices_of_cells]
    ends = (1, 2, 3) if mesh.cell_type == "tet" else (1, 3, 4)
    a, b, c = (corner[:, end] - corner[:, 0] for end in ends)
    parts = 6 if mesh.cell_type == "tet" else 1
    return np.einsum("ij,ij->i", np.cross(a, b), c) / parts
