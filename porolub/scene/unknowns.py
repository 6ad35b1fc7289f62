"""How many unknowns a scene costs, counted before anything is built."""

from collections.abc import Callable
from math import prod

from porolub.scene.geometry import MeshFile
from porolub.scene.mesh_file import count_file_nodes
from porolub.scene.scene import Scene


def estimate_unknowns(scene: Scene) -> dict[str, int]:
    """Return the number of unknowns per field and in total.

    Fields that the scene does not have are left out. Nodes with prescribed values are counted:
    they stay in the system. Velocity comes with inertia. Contact pressure sits on the displacement
    nodes of the lubricated surface; pore pressure has its own degree, and so has the projected
    volume change that stabilises the carry term; without pores the film pressure sits on the
    surface only.
    Raises SceneError if a mesh file cannot be read.
    """
    mesh = scene.mesh
    layer, surface = node_counts(scene)
    count = {}
    if scene.solid is not None:
        count["displacement"] = scene.dimension * layer(mesh.degree)
        if scene.solid.inertia:
            count["velocity"] = count["displacement"]
    if scene.pores is not None:
        count["pore_pressure"] = layer(mesh.pressure_degree)
        if scene.pores.carry:
            count["volume_change"] = layer(mesh.pressure_degree)
    elif scene.film is not None:
        count["film_pressure"] = surface(mesh.pressure_degree)
    if scene.contact is not None:
        count["contact_pressure"] = surface(mesh.degree)
    if scene.load is not None and scene.load.force is not None:
        count["approach"] = 1
    return count | {"total": sum(count.values())}


def node_counts(scene: Scene) -> tuple[Callable[[int], int], Callable[[int], int]]:
    """Return the numbers of nodes in the layer and on the lubricated surface, by degree.

    A structured mesh of n x m elements of degree d has (d n + 1)(d m + 1) nodes.
    """
    shape, mesh = scene.geometry, scene.mesh
    if isinstance(shape, MeshFile):
        nodes = count_file_nodes(shape.path, scene.dimension, shape.lubricated)
        return nodes.layer.__getitem__, nodes.surface.__getitem__
    along = [mesh.along] + ([mesh.deep] if scene.dimension == 3 else [])
    return (
        lambda degree: prod(degree * n + 1 for n in (*along, mesh.across)),
        lambda degree: prod(degree * n + 1 for n in along),
    )
