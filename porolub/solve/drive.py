"""What is done to the layer at a moment: speed, load or approach, boundary values, scaled."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from porolub.errors import SceneError
from porolub.scene.directions import unit_vector
from porolub.solve.conditions import prescribed_values
from porolub.solve.scales import Scales
from porolub.solve.surface import Circle
from porolub.terms.operation import Operation

if TYPE_CHECKING:
    from porolub.solve.model import Model


def operation_of(scene: Any, scales: Scales, circle: Circle | None) -> Operation:
    """The operating point of a scene at t = 0. Raises SceneError for a rotation without centre."""
    dim, motion = scales.dim, scene.motion
    op = Operation(centre=(0.0,) * dim)
    if motion is not None and motion.kind == "rotation":
        op = Operation("rotation", 0.0, _centre(motion, scales, circle),
                       axis=unit_vector(motion.axis, 3))
    elif motion is not None:
        op = Operation("sliding", 0.0, (0.0,) * dim, unit_vector(motion.direction, dim))
    if scene.time is not None and scene.contact is not None and scene.contact.friction_traction:
        op.creep = scene.contact.friction_speed / scales.speed
    set_operation(op, scene, scales, 0.0)
    return op


def _centre(motion: Any, scales: Scales, circle: Circle | None) -> tuple[float, ...]:
    """A point (dim,) of the axis, scaled: the scene's or that of the surface."""
    if motion.centre is not None:
        return tuple(x / scales.length for x in motion.centre)
    if circle is None:
        arc = "circular arc" if scales.dim == 2 else "cylinder about motion.axis, and no sphere"
        raise SceneError('motion.kind = "rotation": the lubricated surface of this mesh is no '
                         f"{arc}, so there is no centre to turn about: give motion.centre.")
    return (*circle.centre, 0.0)[: scales.dim]


def set_operation(op: Operation, scene: Any, scales: Scales, t: float) -> None:
    """Bring the operating point to time t (s)."""
    op.time = t
    if scene.motion is not None:
        unit = 1.0 / scales.time if scene.motion.kind == "rotation" else scales.speed
        op.speed = scene.motion.at(t) / unit
    if scene.load is not None and scene.load.force is not None:
        op.force = scene.load.at(t) / scales.force
    elif scene.load is not None:
        op.approach = scene.load.at(t) / scales.length


def _varies(condition: Any) -> bool:
    """Whether a prescribed value of a boundary is a history."""
    d = condition.displacement
    given = [condition.pressure, *([d.normal, d.x, d.y, d.z] if d is not None else [])]
    return not all(value is None or isinstance(value, float) for value in given)


def drive(model: Model, t: float) -> None:
    """Bring a model's operating point and prescribed boundary values to time t (s). Collective."""
    scene, scales = model.scene, model.scales
    set_operation(model.operation, scene, scales, t)
    if any(_varies(condition) for condition in scene.boundary.values()):
        constraints = model.system.constraints
        constraints.values[:] = prescribed_values(scene, model.mesh, model.dofs, scales,
                                                  model.lubricated, t)
