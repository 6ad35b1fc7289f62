"""How many entries the matrix has, counted from the connectivity of the elements.

Two nodes are coupled if an element has both. Summed over elements, pairs are counted once for
each element they share; taking off interior faces, adding interior edges and taking off interior
vertices (inclusion and exclusion) counts each pair once. So all that is needed of a mesh are its
numbers of elements and of interior faces, edges and vertices.
"""

from dataclasses import dataclass

from porolub.scene.geometry import MeshFile
from porolub.scene.mesh_file import count_file_parts
from porolub.scene.scene import Scene
from porolub.scene.unknowns import node_counts

NODES = {  # on an element or a part of it, by degree
    "vertex": {1: 1, 2: 1},
    "line": {1: 2, 2: 3},
    "triangle": {1: 3, 2: 6},
    "quad": {1: 4, 2: 9},
    "tetra": {1: 4, 2: 10},
    "hexahedron": {1: 8, 2: 27},
}
DIMENSION = {"vertex": 0, "line": 1, "triangle": 2, "quad": 2, "tetra": 3, "hexahedron": 3}


@dataclass(frozen=True)
class Parts:
    """Numbers of elements and of their interior faces, edges and vertices, by kind."""

    dimension: int
    numbers: dict[str, int]

    @property
    def elements(self) -> int:
        """How many elements there are."""
        return sum(n for kind, n in self.numbers.items() if DIMENSION[kind] == self.dimension)

    def pairs(self, test: int, trial: int) -> int:
        """Count the pairs of a node of degree ``test`` and one of degree ``trial``."""
        return sum(
            (-1) ** (self.dimension - DIMENSION[kind]) * n * NODES[kind][test] * NODES[kind][trial]
            for kind, n in self.numbers.items()
        )


def mesh_parts(scene: Scene) -> Parts:
    """Count the parts of the scene's mesh. Raises SceneError if a mesh file cannot be read."""
    mesh, dim = scene.mesh, scene.dimension
    if isinstance(scene.geometry, MeshFile):
        return Parts(dim, count_file_parts(scene.geometry.path, dim))
    n, m, k = mesh.along, mesh.across, mesh.deep
    if dim == 3:
        faces = (n - 1) * m * k + n * (m - 1) * k + n * m * (k - 1)
        edges = n * (m - 1) * (k - 1) + (n - 1) * m * (k - 1) + (n - 1) * (m - 1) * k
        vertices = (n - 1) * (m - 1) * (k - 1)
        numbers = {"hexahedron": n * m * k, "quad": faces, "line": edges, "vertex": vertices}
        return Parts(3, numbers)
    edges, vertices = (n - 1) * m + n * (m - 1), (n - 1) * (m - 1)
    if mesh.element == "triangle":
        return Parts(2, {"triangle": 2 * n * m, "line": edges + n * m, "vertex": vertices})
    return Parts(2, {"quad": n * m, "line": edges, "vertex": vertices})


def count_nonzeros(scene: Scene) -> int:
    """Return the number of entries of the matrix; rows of prescribed values count as others.

    Raises SceneError if a mesh file cannot be read.
    """
    pairs, mesh, dim = mesh_parts(scene).pairs, scene.mesh, scene.dimension
    _, surface = node_counts(scene)
    d, e = mesh.degree, mesh.pressure_degree
    solid, pores, film, contact = scene.solid, scene.pores, scene.film, scene.contact
    force = scene.load is not None and scene.load.force is not None
    count = int(force)
    if solid is not None:
        count += dim**2 * pairs(d, d)
        if solid.inertia and scene.time is not None:
            count += 3 * dim**2 * pairs(d, d)
    if pores is not None:
        count += pairs(e, e) + dim * pairs(d, e)
        if pores.carry or scene.time is not None or scene.conventions.frame == "spatial":
            count += dim * pairs(e, d)
        elif film is not None:  # in the elements along the surface only
            count += dim * (2 * d + 1) ** (dim - 1) * (d + 1) * (e + 1) * surface(e)
        if pores.carry:
            count += 2 * pairs(e, e) + dim * pairs(e, d)
    elif film is not None:  # on the surface only, but with all the nodes of the elements above it
        count += 3 ** (dim - 1) * surface(e)
        if solid is not None:
            count += 2 * dim * (2 * d + 1) ** (dim - 1) * (d + 1) * surface(e)
    if contact is not None:
        count += (2 * dim + 1) * surface(d) + 2 * force * surface(d)
    if force and (pores is not None or film is not None):
        count += (3 + e if pores is not None else 2) * surface(e)
    return count
