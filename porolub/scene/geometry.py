"""The shape of the layer and the names of its boundaries.

A sector is the part of an annulus within +- half_angle of the downward direction; ``lubricated``
is its outer arc, lowest in the middle and facing the rigid plane below, ``bone`` the inner one,
``inlet`` and ``outlet`` the radial ends. A barrel is a sector with an axial width and, if wanted,
a crown. A block is a rectangle or a cuboid with the rigid plane above.
"""

import math
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, ValidationInfo, field_validator, model_validator

from porolub.scene.base import Section, beside_scene, broken, refused
from porolub.scene.directions import components, unit_vector
from porolub.scene.units import PositiveLength, SectorAngle

Vector = tuple[float, ...]


def _names(value: Any) -> Any:
    """Read a TOML array of boundary names."""
    if not isinstance(value, list | tuple) or not all(isinstance(v, str) for v in value):
        raise refused('names of boundaries are needed, such as ["front"]')
    return tuple(value)


class Shape(Section):
    """Base of the shapes: which dimensions a shape exists in and what its boundaries are called.

    ``boundary_names`` is None for a mesh file: its names are only known once it is read.

    ``symmetry`` names the boundaries that are symmetry planes: no displacement through them, no
    flow, and the film goes on behind them. At all other sides the film meets the bath: p = 0 at
    the rim. Left out, it is front and back of a three-dimensional block and of a barrel without a
    crown (plane strain), and empty otherwise. Loads and flows are those of the modelled part.
    """

    dimensions: ClassVar[tuple[int, ...]]
    lubricated: ClassVar[str] = "lubricated"
    bone: ClassVar[str] = "bone"
    has_axis: ClassVar[bool] = True
    symmetry: Annotated[tuple[str, ...], BeforeValidator(_names)] = ()

    def toward_plane(self, dimension: int) -> Vector:
        """Return the unit vector from the layer to the rigid plane."""
        return unit_vector("y", dimension, -1.0)

    def side_normals(self, dimension: int) -> dict[str, Vector]:
        """Return the outward normals of the flat sides, as far as they are known unread."""
        return {}

    def boundary_names(self, dimension: int) -> tuple[str, ...] | None:
        """Return the names of the boundaries in a scene of the given dimension, if known."""
        return None


class Arc(Shape):
    """What sector and barrel share; lengths in m, angle in rad."""

    outer_radius: PositiveLength
    thickness: PositiveLength
    half_angle: SectorAngle

    @property
    def inner_radius(self) -> float:
        """Radius of the bone surface, m."""
        return self.outer_radius - self.thickness

    @property
    def surface_length(self) -> float:
        """Length of the lubricated surface along the motion, m."""
        return 2.0 * self.half_angle * self.outer_radius

    def side_normals(self, dimension: int) -> dict[str, Vector]:
        """Return the outward normals of the ends."""
        across = math.cos(self.half_angle), math.sin(self.half_angle)
        sides = {"inlet": (-across[0], across[1], 0.0), "outlet": (*across, 0.0)}
        ends = {"front": (0.0, 0.0, -1.0), "back": (0.0, 0.0, 1.0)} if dimension == 3 else {}
        return {name: normal[:dimension] for name, normal in (sides | ends).items()}

    @model_validator(mode="after")
    def _has_an_inside(self) -> Self:
        if self.thickness >= self.outer_radius:
            raise broken(
                f"geometry.thickness = {self.thickness:g} m must be less than "
                f"geometry.outer_radius = {self.outer_radius:g} m."
            )
        return self


class Sector(Arc):
    """Annulus sector."""

    dimensions = (2,)
    shape: Literal["sector"]

    def boundary_names(self, dimension: int) -> tuple[str, ...]:
        """Return the names of the boundaries."""
        return ("lubricated", "bone", "inlet", "outlet")


class Barrel(Arc):
    """Sector with the axial length ``width`` and, optionally, a crown; m.

    It lies in |z| <= width/2, highest at z = 0. If just one of front and back is in ``symmetry``,
    that plane is z = 0 and the modelled part is the half behind or before it: 0 <= z <= width/2
    for front. ``width`` stays that of the whole.
    """

    dimensions = (3,)
    shape: Literal["barrel"]
    width: PositiveLength
    crown_radius: PositiveLength | None = None

    @property
    def half(self) -> Literal["front", "back"] | None:
        """The end that is the middle plane of the whole, or None where all of it is modelled."""
        cut = {"front", "back"} & set(self.symmetry)
        return None if len(cut) != 1 else "front" if "front" in cut else "back"

    def boundary_names(self, dimension: int) -> tuple[str, ...]:
        """Return the names of the boundaries."""
        return ("lubricated", "bone", "inlet", "outlet", "front", "back")

    @model_validator(mode="after")
    def _crown_spans_the_width(self) -> Self:
        if self.crown_radius is not None and self.crown_radius <= self.width / 2:
            raise broken(
                f"geometry.crown_radius = {self.crown_radius:g} m must be greater than half of "
                f"geometry.width = {self.width:g} m."
            )
        return self


class Block(Shape):
    """Rectangle of width and thickness, in three dimensions a cuboid of that depth; m."""

    dimensions = (2, 3)
    lubricated = "top"
    bone = "bottom"
    has_axis = False
    shape: Literal["block"]
    width: PositiveLength
    thickness: PositiveLength
    depth: PositiveLength | None = None

    @property
    def surface_length(self) -> float:
        """Length of the lubricated surface along the motion, m."""
        return self.width

    def boundary_names(self, dimension: int) -> tuple[str, ...]:
        """Return the names of the boundaries in a scene of the given dimension."""
        plane = ("left", "right", "bottom", "top")
        return plane if dimension == 2 else (*plane, "front", "back")

    def toward_plane(self, dimension: int) -> Vector:
        """Return the unit vector from the layer to the rigid plane: upwards."""
        return unit_vector("y", dimension)

    def side_normals(self, dimension: int) -> dict[str, Vector]:
        """Return the outward normals of the sides."""
        axes = {"left": ("x", -1.0), "right": ("x", 1.0)}
        axes |= {"front": ("z", -1.0), "back": ("z", 1.0)} if dimension == 3 else {}
        return {name: unit_vector(a, dimension, size) for name, (a, size) in axes.items()}


class MeshFile(Shape):
    """A user's mesh; ``path`` is relative to the scene file. Boundaries as named in the mesh.

    ``plane_normal`` points from the layer to the rigid plane (components along the axes);
    None stands for downwards, -y.
    """

    dimensions = (2, 3)
    shape: Literal["file"]
    path: Path
    plane_normal: Annotated[tuple[float, ...], BeforeValidator(components)] | None = None

    @field_validator("path")
    @classmethod
    def _exists(cls, path: Path, info: ValidationInfo) -> Path:
        full = beside_scene(path, info)
        if not full.is_file():
            raise refused("there is no such mesh file")
        return full

    def boundary_names(self, dimension: int) -> tuple[str, ...] | None:
        """Return None: any name may occur."""
        return None

    def toward_plane(self, dimension: int) -> Vector:
        """Return the unit vector from the layer to the rigid plane."""
        if self.plane_normal is None or len(self.plane_normal) != dimension:
            return super().toward_plane(dimension)
        return unit_vector(self.plane_normal, dimension)


Geometry = Annotated[Sector | Block | Barrel | MeshFile, Field(discriminator="shape")]
