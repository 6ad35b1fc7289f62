"""The readings of the model a scene can choose, and its own boundary conditions."""

from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Tag, model_validator

from porolub.scene.base import Section, broken
from porolub.scene.harmonic import Harmonic
from porolub.scene.histories import LengthHistory, PressureHistory, keys_of, nearest_form, table_of
from porolub.scene.history import period_of, values_of
from porolub.scene.samples import Samples
from porolub.scene.units import PRESSURE, Pressure, Quantity


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

    normal: LengthHistory | None = None
    x: LengthHistory | None = None
    y: LengthHistory | None = None
    z: LengthHistory | None = None


class Traction(Section):
    """Traction by components along the axes, Pa."""

    x: PressureHistory = 0.0
    y: PressureHistory = 0.0
    z: PressureHistory = 0.0


def _form(value: Any) -> str:
    if isinstance(value, Traction):
        return "<components>"
    forms = {t: keys_of(t) for t in ("<harmonic>", "<samples>")}
    return nearest_form(value, {"<components>": ("x", "y", "z")} | forms) or "<normal>"


class Boundary(Section):
    """Conditions on one named boundary; they replace what the shape has there.

    ``traction`` is a normal one, compression positive, in Pa, or given by components;
    ``pressure`` in Pa, None means no flux. All of them may change with time.
    """

    displacement: Displacement | None = None
    traction: (
        Annotated[
            Annotated[Pressure, Tag("<normal>")]
            | Annotated[Harmonic[Pressure], Tag("<harmonic>")]
            | Annotated[Samples[Pressure], table_of(Quantity(PRESSURE)), Tag("<samples>")]
            | Annotated[Traction, Tag("<components>")],
            Discriminator(_form),
        ]
        | None
    ) = None
    pressure: PressureHistory | None = None

    @property
    def varies(self) -> bool:
        """Whether any of the conditions changes with time."""
        return any(period_of(value) is not None for value in values_of(self, "").values())

    @model_validator(mode="after")
    def _not_twice(self) -> Self:
        fixed = self.displacement
        if fixed is None:
            return self
        if fixed.normal is not None and (fixed.x, fixed.y, fixed.z) != (None, None, None):
            raise broken("displacement is given both by normal and by x, y, z; keep one of them.")
        loaded = self.traction.model_fields_set if isinstance(self.traction, Traction) else set()
        twice = [f"displacement.{c}" for c in sorted(loaded) if getattr(fixed, c) is not None]
        normal_traction = self.traction is not None and not isinstance(self.traction, Traction)
        if normal_traction and fixed.normal is not None:
            twice = ["displacement.normal"]
        if twice:
            raise broken(f"traction and {twice[0]} are both given; keep one of them.")
        return self
