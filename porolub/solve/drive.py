"""What is done to the layer at a moment: speed, load or approach, boundary values, scaled."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from porolub.errors import SceneError
from porolub.solve.conditions import prescribed_values
from porolub.solve.scales import Scales
from porolub.solve.surface import Circle
from porolub.terms.operation import Operation

if TYPE_CHECKING:
    from porolub.solve.model import Model


def operation_of(scene: Any, scales: Scales, circle: Circle | None) -> Operation:
    """The operating point of a scene at t = 0. Raises SceneError for a rotation without centre."""
    op = Operation(centre=(0.0,) * scales.dim)
    if scene.motion is not None and scene.motion.kind == "rotation":
        if circle is None:
            raise SceneError('motion.kind = "rotation": the lubricated surface of this mesh is '
                             "no circular arc, so there is no centre to turn about.")
        op = Operation("rotation", 0.0, (*circle.centre, 0.0)[: scales.dim])
    elif scene.motion is not None:
        axis = {"x": 0, "z": 2}[getattr(scene.motion, "direction", "x")]
        direction = tuple(float(k == axis) for k in range(scales.dim))
        op = Operation("sliding", 0.0, (0.0,) * scales.dim, direction)
    if scene.time is not None and scene.contact is not None and scene.contact.friction_traction:
        op.creep = scene.contact.friction_speed / scales.speed
    set_operation(op, scene, scales, 0.0)
    return op


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
