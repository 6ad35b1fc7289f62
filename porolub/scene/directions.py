"""Directions in a scene file: an axis by its name, or an array of numbers."""

import math
from typing import Annotated, Any

from pydantic import PlainSerializer, PlainValidator

from porolub.scene.base import refused

AXES = ("x", "y", "z")


def components(value: Any) -> Any:
    """Read a TOML array of two or three numbers as a tuple of floats."""
    numbers = isinstance(value, list | tuple) and all(
        isinstance(v, int | float) and not isinstance(v, bool) and math.isfinite(v) for v in value
    )
    if not numbers or len(value) not in (2, 3) or not any(value):
        raise refused("a direction is needed, such as [0.0, -1.0]")
    return tuple(float(v) for v in value)


def _direction(value: Any) -> Any:
    """Read the name of an axis, or a direction by components."""
    if isinstance(value, str) and value in AXES:
        return value
    if isinstance(value, str):
        raise refused("allowed are x, y, z or a direction such as [1.0, 0.0, 0.5]")
    return components(value)


def _written(direction: str | tuple[float, ...]) -> Any:
    """Write a direction as a scene file has it."""
    return direction if isinstance(direction, str) else list(direction)


Direction = Annotated[
    str | tuple[float, ...],
    PlainValidator(_direction),
    PlainSerializer(_written, return_type=Any, when_used="json"),
]


def unit_vector(
    direction: str | tuple[float, ...], dimension: int, size: float = 1.0
) -> tuple[float, ...]:
    """Return the vector (dimension,) of length ``size`` in a direction of that dimension.

    Raises ValueError for a direction of another dimension.
    """
    if isinstance(direction, str):
        direction = tuple(float(axis == direction) for axis in AXES[:dimension])
    if len(direction) != dimension or not any(direction):
        raise ValueError(f"{direction} is no direction in {dimension} dimensions")
    length = math.hypot(*direction)
    return tuple(size * component / length for component in direction)
