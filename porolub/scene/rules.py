"""Rules that span sections: what a scene must have for its parts to make sense together."""

import difflib
import json
from collections.abc import Iterator
from typing import TYPE_CHECKING

from porolub.scene.accuracy import accuracy_violations
from porolub.scene.geometry import MeshFile
from porolub.scene.motion_rules import motion_violations
from porolub.scene.operation import Rotation
from porolub.scene.time_rules import time_violations

if TYPE_CHECKING:
    from porolub.scene.scene import Scene


def violations(scene: "Scene") -> Iterator[str]:
    """Yield one sentence per broken rule."""
    yield from _shape(scene)
    yield from _mesh(scene)
    yield from _physics(scene)
    yield from _motion(scene)
    yield from motion_violations(scene)
    yield from _symmetry(scene)
    yield from _boundaries(scene)
    yield from time_violations(scene)
    yield from accuracy_violations(scene)


def _shape(scene: "Scene") -> Iterator[str]:
    shape, dimension = scene.geometry, scene.dimension
    if dimension not in shape.dimensions:
        fitting = "sector, block or file" if dimension == 2 else "block, barrel or file"
        yield (
            f'geometry.shape = "{shape.shape}" does not fit scene.dimension = {dimension}; '
            f"allowed there: {fitting}."
        )
    if shape.shape == "block":
        if dimension == 3 and shape.depth is None:
            yield 'geometry.depth is missing: a three-dimensional block needs it, such as "10 mm".'
        if dimension == 2 and shape.depth is not None:
            yield "geometry.depth is given, but scene.dimension = 2: leave it out."
    normal = shape.plane_normal if isinstance(shape, MeshFile) else None
    if normal is not None and len(normal) != dimension:
        yield (
            f"geometry.plane_normal = {list(normal)} must have {dimension} components, because "
            f"scene.dimension = {dimension}."
        )


def _mesh(scene: "Scene") -> Iterator[str]:
    mesh = scene.mesh
    if isinstance(scene.geometry, MeshFile):
        for key in ("along", "across", "deep"):
            if getattr(mesh, key):
                yield f'mesh.{key} is given, but geometry.shape = "file" brings its own elements.'
        if mesh.grading != "none":
            yield 'mesh.grading = "contact" needs a built shape; a mesh file is used as it is.'
        if mesh.element != "quad":
            yield 'mesh.element is given, but geometry.shape = "file" brings its own elements.'
        return
    needed = ("along", "across", "deep") if scene.dimension == 3 else ("along", "across")
    for key in needed:
        if not getattr(mesh, key):
            yield f"mesh.{key} is missing: a number of elements such as 30 is needed."
    if scene.dimension == 2 and mesh.deep:
        yield f"mesh.deep = {mesh.deep} is given, but scene.dimension = 2: leave it out."
    if mesh.grading == "contact" and scene.film is None and scene.contact is None:
        yield 'mesh.grading = "contact" needs [contact] or [film]: otherwise there is no contact.'
    if scene.dimension == 3 and mesh.element != "quad":
        yield 'mesh.element = "triangle" does not fit scene.dimension = 3; allowed there: quad.'


def _physics(scene: "Scene") -> Iterator[str]:
    if scene.solid is None:
        if scene.pores is not None:
            yield "[pores] needs a [solid] section: pores without a skeleton are not defined."
        if scene.contact is not None:
            yield "[contact] needs a [solid] section: a rigid layer has no contact pressure."
        if scene.film is None:
            yield "[solid] is missing: without it the layer is rigid, and then [film] is needed."
    pressed = scene.film is not None or scene.contact is not None
    if scene.load is not None and not pressed:
        yield "[load] needs [contact] or [film]: otherwise nothing carries the load."
    if scene.load is None and pressed:
        which = "[contact]" if scene.contact is not None else "[film]"
        yield f"[load] is missing: {which} needs the plane's load.force or load.approach."
    if scene.film is not None and scene.pores is not None:
        density = scene.film.fluid_density
        if density is not None and density != scene.pores.fluid_density:
            yield (
                f"film.fluid_density = {density:g} kg/m^3 must equal pores.fluid_density = "
                f"{scene.pores.fluid_density:g} kg/m^3: it is the same fluid."
            )


def _motion(scene: "Scene") -> Iterator[str]:
    motion = scene.motion
    if scene.pores is not None and scene.pores.carry and not isinstance(motion, Rotation):
        yield 'pores.carry = true needs motion.kind = "rotation": otherwise nothing is carried.'
    if scene.contact is not None and scene.contact.friction_traction and motion is None:
        yield "contact.friction_traction = true needs a [motion] section: it sets the direction."


def _symmetry(scene: "Scene") -> Iterator[str]:
    shape = scene.geometry
    names = shape.boundary_names(scene.dimension)
    for name in shape.symmetry:
        here = f'geometry.symmetry = {json.dumps(shape.symmetry)}: "{name}"'
        if shape.symmetry.count(name) > 1:
            yield f"{here} is named twice."
            return
        if name in (shape.lubricated, shape.bone):
            yield f"{here} cannot be a symmetry plane: allowed are sides of the layer."
        elif names is not None and name not in names:
            sides = [n for n in names if n not in (shape.lubricated, shape.bone)]
            near = difflib.get_close_matches(name, sides, 1)
            hint = f" (did you mean {near[0]}?)" if near else ""
            yield f"{here} is no boundary; allowed are {', '.join(sides)}{hint}."


def _boundaries(scene: "Scene") -> Iterator[str]:
    names = scene.geometry.boundary_names(scene.dimension)
    for name, boundary in scene.boundary.items():
        here = f"boundary.{name}"
        if names is not None and name not in names:
            near = difflib.get_close_matches(name, names, 1)
            hint = f"; did you mean boundary.{near[0]}?" if near else ""
            yield (
                f'[{here}]: the shape "{scene.geometry.shape}" has no boundary of that name{hint} '
                f"(it has {', '.join(names)})."
            )
            continue
        if name == scene.geometry.lubricated and (scene.film or scene.contact):
            yield f"[{here}] cannot be set while [film] or [contact] act on that surface."
        if boundary.pressure is not None and scene.pores is None:
            yield f"{here}.pressure needs a [pores] section."
        if scene.solid is None and (boundary.displacement or boundary.traction is not None):
            yield f"[{here}] prescribes the skeleton, which needs a [solid] section."
        for key in ("displacement", "traction"):
            part = getattr(boundary, key)
            if scene.dimension == 2 and "z" in getattr(part, "model_fields_set", ()):
                yield f"{here}.{key}.z is given, but scene.dimension = 2: leave it out."
