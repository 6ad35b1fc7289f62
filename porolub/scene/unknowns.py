"""How many unknowns a scene costs, counted before anything is built."""

from math import prod

from porolub.scene.geometry import MeshFile
from porolub.scene.scene import Scene


def estimate_unknowns(scene: Scene) -> dict[str, int]:
    """Return the number of unknowns per field and in total; empty for a mesh file.

    Fields that the scene does not have are left out. Nodes with prescribed values are counted:
    they stay in the system. Displacement nodes of an along x across mesh of degree d are
    (d along + 1)(d across + 1); contact pressure sits on those of the lubricated surface. Pore
    pressure has its own degree; without pores the film pressure sits on the surface only.
    """
    if isinstance(scene.geometry, MeshFile):
        return {}
    mesh = scene.mesh
    cells = [mesh.along, mesh.across] + ([mesh.deep] if scene.dimension == 3 else [])
    surface = [mesh.along] + ([mesh.deep] if scene.dimension == 3 else [])

    def nodes(counts: list[int], degree: int) -> int:
        return prod(degree * n + 1 for n in counts)

    count = {}
    if scene.solid is not None:
        count["displacement"] = scene.dimension * nodes(cells, mesh.degree)
    if scene.pores is not None:
        count["pore_pressure"] = nodes(cells, mesh.pressure_degree)
    elif scene.film is not None:
        count["film_pressure"] = nodes(surface, mesh.pressure_degree)
    if scene.contact is not None:
        count["contact_pressure"] = nodes(surface, mesh.degree)
    if scene.load is not None and scene.load.force is not None:
        count["approach"] = 1
    return count | {"total": sum(count.values())}
