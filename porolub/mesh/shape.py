"""Shapes the scene can name, as maps between logical and physical coordinates.

Logical coordinates run from 0 to 1: *along* the lubricated surface (in +x), *across* from
bone (0) to the lubricated surface (1), and in 3D *deep* (in +z). All lengths are in the unit
of the mesh. The arc position s is measured along the lubricated surface from its middle
(x = 0), positive in +x; in 3D in the plane z = 0.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porolub.errors import SceneError

Array = NDArray[np.float64]


class Shape(ABC):
    """A structured shape: `dim`, `length` along the lubricated surface, `thickness`.

    `boundaries` names the sides in the order along = 0, along = 1, across = 0, across = 1
    (3D: deep = 0, deep = 1); `lubricated` and `bone` name the two surfaces.
    """

    thickness: float
    boundaries: tuple[str, ...]
    lubricated: str
    bone: str

    @property
    @abstractmethod
    def dim(self) -> int: ...

    @property
    @abstractmethod
    def length(self) -> float: ...

    @abstractmethod
    def physical(self, logical: Array) -> Array:
        """Positions (n, dim) in mesh units of logical coordinates (n, dim)."""

    @abstractmethod
    def logical(self, points: Array) -> Array:
        """Logical coordinates (n, dim) of positions (n, dim) in mesh units."""


@dataclass(frozen=True)
class Block(Shape):
    """[-width/2, width/2] x [0, thickness] (x [0, depth]); its top is the lubricated surface."""

    width: float
    thickness: float
    depth: float | None = None

    lubricated = "top"
    bone = "bottom"

    @property
    def dim(self) -> int:
        return 2 if self.depth is None else 3

    @property
    def length(self) -> float:
        return self.width

    @property
    def boundaries(self) -> tuple[str, ...]:  # type: ignore[override]
        return ("left", "right", "bottom", "top", "front", "back")[: 2 * self.dim]

    def physical(self, logical: Array) -> Array:
        sides = [self.width, self.thickness, self.depth or 0.0][: self.dim]
        origin = [-self.width / 2, 0.0, 0.0][: self.dim]
        return np.asarray(origin + np.asarray(logical) * sides)

    def logical(self, points: Array) -> Array:
        sides = [self.width, self.thickness, self.depth or 0.0][: self.dim]
        origin = [-self.width / 2, 0.0, 0.0][: self.dim]
        return np.asarray((np.asarray(points) - origin) / sides)


@dataclass(frozen=True)
class Sector(Shape):
    """Sector of an annulus turning about (0, outer_radius); in 3D (`width`) a barrel.

    The lubricated surface is the outer arc, lowest at the origin: the point at angle t and
    radius r is (r sin t, R0 - r cos t), |t| <= half_angle. In 3D z runs over
    [-width/2, width/2]; a `crown_radius` c lowers the radius to R0(z) = R0 - z^2 / (2 c) at
    constant thickness. `half` names the end that is the middle plane: z runs over [0, width/2]
    with front, over [-width/2, 0] with back.
    """

    outer_radius: float
    thickness: float
    half_angle: float
    width: float | None = None
    crown_radius: float | None = None
    half: str | None = None

    lubricated = "lubricated"
    bone = "bone"

    @property
    def dim(self) -> int:
        return 2 if self.width is None else 3

    @property
    def length(self) -> float:
        return 2 * self.half_angle * self.outer_radius

    @property
    def boundaries(self) -> tuple[str, ...]:  # type: ignore[override]
        return ("inlet", "outlet", "bone", "lubricated", "front", "back")[: 2 * self.dim]

    @property
    def _ends(self) -> tuple[float, float]:
        """z of front and back."""
        width = self.width or 0.0
        low = 0.0 if self.half == "front" else -width / 2
        return low, 0.0 if self.half == "back" else width / 2

    def _drop(self, z: Array) -> Array:
        """Radius lost to the crown at z."""
        return z * z / (2 * self.crown_radius) if self.crown_radius else np.zeros_like(z)

    def physical(self, logical: Array) -> Array:
        logical = np.asarray(logical, dtype=float)
        angle = self.half_angle * (2 * logical[:, 0] - 1)
        inward = self.thickness * (1 - logical[:, 1])
        front, back = self._ends
        z = None if self.width is None else front + (back - front) * logical[:, 2]
        if z is not None:
            inward = inward + self._drop(z)
        radius = self.outer_radius - inward
        # R0 - r cos t without cancellation near the lowest point
        height = inward + 2 * radius * np.sin(angle / 2) ** 2
        columns = [radius * np.sin(angle), height] + ([] if z is None else [z])
        return np.column_stack(columns)

    def logical(self, points: Array) -> Array:
        points = np.asarray(points, dtype=float)
        up = self.outer_radius - points[:, 1]
        angle = np.arctan2(points[:, 0], up)
        inward = self.outer_radius - np.hypot(points[:, 0], up)
        columns = [(angle / self.half_angle + 1) / 2]
        if self.width is None:
            return np.column_stack([*columns, 1 - inward / self.thickness])
        z = points[:, 2]
        across = 1 - (inward - self._drop(z)) / self.thickness
        front, back = self._ends
        return np.column_stack([*columns, across, (z - front) / (back - front)])


def shape_from_scene(scene: Any, length_scale: float) -> Shape:
    """The scene's structured shape with lengths divided by `length_scale`.

    Raises SceneError when `geometry.shape` is not block, sector or barrel or does not fit
    `scene.dimension`.
    """
    geometry, dimension = scene.geometry, scene.scene.dimension
    kind = geometry.shape

    def scaled(key: str) -> float | None:
        value = getattr(geometry, key, None)
        return None if value is None else float(value) / length_scale

    def needed(key: str) -> float:
        value = scaled(key)
        if value is None:
            raise SceneError(f"geometry.{key} is needed for shape = '{kind}' in {dimension}D.")
        return value

    if kind == "block":
        depth = needed("depth") if dimension == 3 else None
        return Block(needed("width"), needed("thickness"), depth)
    if kind == "sector" and dimension == 2:
        return Sector(needed("outer_radius"), needed("thickness"), float(geometry.half_angle))
    if kind == "barrel" and dimension == 3:
        return Sector(
            needed("outer_radius"),
            needed("thickness"),
            float(geometry.half_angle),
            needed("width"),
            scaled("crown_radius"),
            getattr(geometry, "half", None),
        )
    raise SceneError(
        f"geometry.shape = '{kind}' does not exist in {dimension}D: "
        "sector (2D), barrel (3D), block (2D, 3D) and file (2D, 3D) do."
    )
