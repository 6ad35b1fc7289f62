"""A scene: all a user asks for in one run. Its attributes are the sections of the file."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from porolub.scene.base import Section, Whole, broken
from porolub.scene.conditions import Boundary, Conventions
from porolub.scene.discretisation import Mesh
from porolub.scene.geometry import Geometry
from porolub.scene.material import Film, Pores, Solid
from porolub.scene.operation import Contact, Load, Motion, Time
from porolub.scene.resolved import digest, resolved
from porolub.scene.rules import violations


class Header(Section):
    """Title and dimension (2: plane strain, or 3)."""

    title: str = "untitled scene"
    dimension: Annotated[Literal[2, 3], Whole] = 2


class Scene(Section):
    """A checked scene; quantities are floats in SI units. An absent section is None.

    ``motion`` and ``load`` may change with time: ask ``at(t)``; a steady run uses t = 0.
    """

    scene: Header = Header()
    geometry: Geometry
    mesh: Mesh = Mesh()
    solid: Solid | None = None
    pores: Pores | None = None
    film: Film | None = None
    contact: Contact | None = None
    motion: Motion | None = None
    load: Load | None = None
    time: Time | None = None
    conventions: Conventions = Conventions()
    boundary: dict[str, Boundary] = Field(default_factory=dict)

    @property
    def title(self) -> str:
        """The title in the file's [scene] section."""
        return self.scene.title

    @property
    def dimension(self) -> int:
        """2 (plane strain) or 3."""
        return self.scene.dimension

    @property
    def fluid_density(self) -> float:
        """Density that turns volume flows into mass flows, kg/m^3."""
        if self.pores is not None:
            return self.pores.fluid_density
        return (self.film and self.film.fluid_density) or 1000.0

    def resolved(self) -> dict[str, Any]:
        """Return every key with its value, defaults included, as a scene file has them."""
        return resolved(self)

    def digest(self) -> str:
        """Return a hash of everything that changes the answer (not of the title)."""
        return digest(self)

    @model_validator(mode="before")
    @classmethod
    def _entering_follows_base(cls, data: Any) -> Any:
        """A bonded layer is undisturbed far away: what enters is fresh unless asked otherwise."""
        if not isinstance(data, dict):
            return data
        solid, conventions = data.get("solid"), data.get("conventions", {})
        bonded = isinstance(solid, dict) and solid.get("base") == "bonded"
        if bonded and isinstance(conventions, dict) and "entering" not in conventions:
            return {**data, "conventions": {**conventions, "entering": "fresh"}}
        return data

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        sentences = list(violations(self))
        if sentences:
            raise broken(*sentences)
        return self
