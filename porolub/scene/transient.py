"""The [time] section: how a transient run starts, steps, ends, and what it shows on the way."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from porolub.scene.base import Section, Whole, broken
from porolub.scene.units import NUMBER, Length, PositiveTime, Quantity

Tolerance = Annotated[float, Quantity(NUMBER, above=0, below=1)]

REPEAT_LOOSER = 10.0  # by default a period repeats within so many tolerances of a step


class Time(Section):
    """A transient run from t = 0; times in s, lengths in m.

    ``end``: when it ends. ``tolerance``: relative local error of a step; ``order`` of the BDF.
    ``step_max``, ``first_step``: None leaves the longest and the first step to the program.

    ``start``: "steady", from the steady state under what acts at t = 0, or "rest", from the
    undeformed layer, which feels all that acts from t = 0 on. In a scene it is never None: left
    out, it is "steady" if the scene has [motion] and "rest" if not. A joint that moves has been
    moving; a layer that is only loaded starts undeformed and feels its load from t = 0 on.

    ``approach``: where the plane is at t = 0 when a run under load.force starts from rest, positive
    when pressed in; left out, -10 um with a film and 0 without. None in all other scenes.

    ``until``: "end", or "periodic", which stops as soon as a period repeats the one before within
    ``repeat_tolerance`` (None: ten times ``tolerance``; see ``repeats_within``).

    ``frames``: pictures kept per period, or of the whole run when nothing is periodic.
    """

    end: PositiveTime
    tolerance: Tolerance = 1e-3
    order: Annotated[Literal[1, 2, 3], Whole] = 2
    step_max: PositiveTime | None = None
    first_step: PositiveTime | None = None
    start: Literal["steady", "rest"] | None = None
    approach: Length | None = None
    until: Literal["end", "periodic"] = "end"
    repeat_tolerance: Tolerance | None = None
    frames: Annotated[int, Field(ge=0), Whole] = 40

    @property
    def repeats_within(self) -> float:
        """Relative difference of two periods below which they count as equal."""
        return self.repeat_tolerance or REPEAT_LOOSER * self.tolerance

    @model_validator(mode="after")
    def _steps_fit(self) -> Self:
        first = self.first_step
        for key in ("step_max", "end"):
            limit = getattr(self, key)
            if first is not None and limit is not None and first > limit:
                raise broken(
                    f"time.first_step = {first:g} s must not be greater than time.{key} = "
                    f"{limit:g} s."
                )
        return self
