"""Rules on directions: the plane slides in itself, and nothing moves through a symmetry plane."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from porolub.scene.describe import toml_value
from porolub.scene.directions import unit_vector
from porolub.scene.operation import Rotation, Sliding

if TYPE_CHECKING:
    from porolub.scene.scene import Scene

Vector = tuple[float, ...]
ALIGNED = 1e-6  # sine or cosine below which directions count as parallel or perpendicular


def motion_violations(scene: "Scene") -> Iterator[str]:
    """Yield one sentence per broken rule on the direction, axis and centre of the motion."""
    motion = scene.motion
    if isinstance(motion, Sliding):
        yield from _sliding(scene, motion)
    elif isinstance(motion, Rotation):
        yield from _rotation(scene, motion)


def _dot(a: Vector, b: Vector) -> float:
    return math.fsum(x * y for x, y in zip(a, b, strict=True))


def _wrong_dimension(scene: "Scene", key: str, direction: str | Vector, allowed: str) -> str | None:
    dimension = scene.dimension
    given = f"motion.{key} = {toml_value(direction)}"
    if isinstance(direction, str) and direction not in allowed:
        return f"{given} needs scene.dimension = 3; allowed here: {', '.join(allowed)}."
    if not isinstance(direction, str) and len(direction) != dimension:
        return f"{given} must have {dimension} components, because scene.dimension = {dimension}."
    return None


def _sliding(scene: "Scene", motion: Sliding) -> Iterator[str]:
    allowed = "xyz"[: scene.dimension]
    wrong = _wrong_dimension(scene, "direction", motion.direction, allowed)
    if wrong is not None:
        yield wrong
        return
    along = unit_vector(motion.direction, scene.dimension)
    normal = scene.geometry.toward_plane(scene.dimension)
    given = f"motion.direction = {toml_value(motion.direction)}"
    if abs(_dot(along, normal)) > ALIGNED:
        yield (
            f"{given} must lie in the rigid plane, whose normal is "
            f"{toml_value([round(n, 6) + 0.0 for n in normal])}: the plane slides in itself."
        )
        return
    yield from _crosses(
        scene, given, [n for n, out in _planes(scene) if abs(_dot(along, out)) > ALIGNED]
    )


def _rotation(scene: "Scene", motion: Rotation) -> Iterator[str]:
    if not scene.geometry.has_axis and not (scene.dimension == 3 and motion.centre):
        yield (
            'motion.kind = "rotation" needs a shape with an axis: sector, barrel or file, or in '
            "three dimensions motion.centre."
        )
    if motion.centre is not None and len(motion.centre) != scene.dimension:
        yield (
            f"motion.centre must have {scene.dimension} entries, because scene.dimension = "
            f"{scene.dimension}; it has {len(motion.centre)}."
        )
    if scene.dimension == 2:
        if motion.axis != "z":
            yield (
                f"motion.axis = {toml_value(motion.axis)} needs scene.dimension = 3; allowed "
                "here: z."
            )
        axis: Vector = (0.0, 0.0, 1.0)
    else:
        wrong = _wrong_dimension(scene, "axis", motion.axis, "xyz")
        if wrong is not None:
            yield wrong
            return
        axis = unit_vector(motion.axis, 3)
    tilted = [
        name
        for name, outward in _planes(scene)
        if math.hypot(*_cross(axis, (*outward, 0.0)[:3])) > ALIGNED
    ]
    yield from _crosses(scene, f"motion.axis = {toml_value(motion.axis)}", tilted)


def _cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _planes(scene: "Scene") -> Iterator[tuple[str, Vector]]:
    """The symmetry planes whose normals are known without a mesh."""
    normals = scene.geometry.side_normals(scene.dimension)
    return ((name, normals[name]) for name in scene.geometry.symmetry if name in normals)


def _crosses(scene: "Scene", given: str, names: list[str]) -> Iterator[str]:
    if not names:
        return
    are = "which is a symmetry plane" if len(names) == 1 else "which are symmetry planes"
    others = toml_value([n for n in scene.geometry.symmetry if n not in names])
    yield (
        f"{given} moves through {' and '.join(names)}, {are}: set another direction or "
        f"geometry.symmetry = {others}."
    )
