"""The readings of the model a scene can choose, and its own boundary conditions."""

from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Tag, model_validator

from porolub.scene.base import Section, broken
from porolub.scene.units import Length, Pressure


class Conventions(Section):
    """Which of the possible readings of the model holds.

    ``surface_traction``: the skeleton carries p_c + (1 - a) p ("balanced") or p_c ("paper").
    ``frame``: grad p and Darcy flow in the deformed ("spatial") or reference frame ("material").
    ``entering``: J of the entering material is as computed, or 1 ("fresh").
    """

    surface_traction: Literal["balanced", "paper"] = "balanced"
    frame: Literal["spatial", "material"] = "spatial"
    entering: Literal["computed", "fresh"] = "computed"


class Displacement(Section):
    """Prescribed components in m; None is free. ``normal`` stands alone."""

    normal: Length | None = None
    x: Length | None = None
    y: Length | None = None
    z: Length | None = None


class Traction(Section):
    """Traction by components along the axes, Pa."""

    x: Pressure = 0.0
    y: Pressure = 0.0
    z: Pressure = 0.0


def _form(value: Any) -> str:
    return "<components>" if isinstance(value, dict | Traction) else "<normal>"


class Boundary(Section):
    """Conditions on one named boundary; they replace what the shape has there.

    ``traction`` is a normal one, compression positive, in Pa, or given by components;
    ``pressure`` in Pa, None means no flux.
    """

    displacement: Displacement | None = None
    traction: (
        Annotated[
            Annotated[Pressure, Tag("<normal>")] | Annotated[Traction, Tag("<components>")],
            Discriminator(_form),
        ]
        | None
    ) = None
    pressure: Pressure | None = None

    @model_validator(mode="after")
    def _not_twice(self) -> Self:
        fixed = self.displacement
        if fixed is None:
            return self
        if fixed.normal is not None and (fixed.x, fixed.y, fixed.z) != (None, None, None):
            raise broken("displacement is given both by normal and by x, y, z; keep one of them.")
        loaded = self.traction.model_fields_set if isinstance(self.traction, Traction) else set()
        twice = [f"displacement.{c}" for c in sorted(loaded) if getattr(fixed, c) is not None]
        if isinstance(self.traction, float) and fixed.normal is not None:
            twice = ["displacement.normal"]
        if twice:
            raise broken(f"traction and {twice[0]} are both given; keep one of them.")
        return self
