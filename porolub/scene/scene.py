"""A scene: all a user asks for in one run. Its attributes are the sections of the file."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from porolub.scene.accuracy import Accuracy
from porolub.scene.base import Section, Whole, broken
from porolub.scene.conditions import Boundary, Conventions
from porolub.scene.discretisation import Mesh
from porolub.scene.follows import with_what_follows
from porolub.scene.geometry import Geometry
from porolub.scene.history import History
from porolub.scene.material import Film, Pores, Solid
from porolub.scene.operation import Contact, Load, Motion
from porolub.scene.resolved import digest, resolved
from porolub.scene.rules import violations
from porolub.scene.schedule import common_period, histories, kinks, varying
from porolub.scene.solver import Solver
from porolub.scene.transient import Time


class Header(Section):
    """Title and dimension (2: plane strain, or 3)."""

    title: str = "untitled scene"
    dimension: Annotated[Literal[2, 3], Whole] = 2


class Scene(Section):
    """A checked scene; quantities are floats in SI units. An absent section is None.

    ``motion`` and ``load`` may change with time: ask ``at(t)``; so may values of a ``boundary``:
    ask ``value_at(value, t)``. A steady run uses t = 0.
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
    accuracy: Accuracy | None = None
    conventions: Conventions = Conventions()
    solver: Solver = Solver()
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

    def histories(self) -> dict[str, float | History]:
        """Return all values that may change with time, by their keys in the file."""
        return histories(self)

    @property
    def varies(self) -> bool:
        """Whether load, motion or any boundary value changes with time."""
        return bool(varying(self))

    @property
    def period(self) -> float | None:
        """The time after which all that changes repeats, s.

        None if nothing changes, if something never repeats, or if the periods do not fit together.
        """
        return common_period(varying(self).values())

    def kinks(self, start: float, end: float) -> list[float]:
        """Return the times strictly between ``start`` and ``end`` (s) where a slope jumps.

        Ascending; a time step should end at each of them.
        """
        return kinks(self, start, end)

    def resolved(self) -> dict[str, Any]:
        """Return every key with its value, defaults included, as a scene file has them."""
        return resolved(self)

    def digest(self) -> str:
        """Return a hash of everything that changes the answer (title and length of run do not)."""
        return digest(self)

    @model_validator(mode="before")
    @classmethod
    def _with_what_follows(cls, data: Any) -> Any:
        return with_what_follows(data) if isinstance(data, dict) else data

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        sentences = list(violations(self))
        if sentences:
            raise broken(*sentences)
        return self
