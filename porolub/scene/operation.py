"""What is done to the layer: contact with the plane, motion, load."""

from typing import Annotated, Literal, Self

from pydantic import Field, StrictBool, field_validator, model_validator

from porolub.scene.base import Section, broken, refused
from porolub.scene.directions import Direction
from porolub.scene.histories import (
    AngularSpeedHistory,
    ForceHistory,
    LengthHistory,
    SpeedHistory,
)
from porolub.scene.history import History, value_at
from porolub.scene.units import NUMBER, Length, PositiveSpeed, Quantity

Friction = Annotated[float, Quantity(NUMBER, at_least=0)]


class Contact(Section):
    """Contact with the rigid plane; ``friction`` is the coefficient of dry friction.

    ``friction_traction`` says whether friction shears the skeleton; it is reported in any case.
    A sliding velocity w that changes its sign would make the direction of friction jump. So in
    transient runs with ``friction_traction`` the direction is w / sqrt(|w|^2 + w_0^2), with
    w_0 = ``friction_speed`` in m/s: friction passes through zero with the speed, and is within
    1 % of Coulomb's where |w| > 7 w_0. It is used nowhere else.
    """

    friction: Friction = 0.0
    friction_traction: StrictBool = False
    friction_speed: PositiveSpeed = 1e-3


class Rotation(Section):
    """The body rotates about its axis; ``speed`` in rad/s, anticlockwise positive.

    v = speed ``axis`` x (X - ``centre``), with a point of the axis in m, one number for each
    dimension. Left out, the centre is that of the shape; of a mesh file that of the cylinder
    about the axis, or of the sphere, on which the vertices of the lubricated surface lie.
    """

    kind: Literal["rotation"]
    speed: AngularSpeedHistory
    axis: Direction = "z"
    centre: tuple[Length, ...] | None = None

    def at(self, t: float) -> float:
        """Return the angular speed at time ``t`` in s, rad/s."""
        return value_at(self.speed, t)


class Sliding(Section):
    """The plane slides, the body is at rest; ``speed`` in m/s along ``direction``, in the plane."""

    kind: Literal["sliding"]
    speed: SpeedHistory
    direction: Direction = "x"

    def at(self, t: float) -> float:
        """Return the speed of the plane at time ``t`` in s, m/s."""
        return value_at(self.speed, t)


Motion = Annotated[Rotation | Sliding, Field(discriminator="kind")]


class Load(Section):
    """Either the load (N/m in two dimensions, N in three) or the approach of the plane (m).

    The approach is positive when the plane is pressed in.
    """

    force: ForceHistory | None = None
    approach: LengthHistory | None = None

    @field_validator("force")
    @classmethod
    def _presses(cls, force: float | History | None) -> float | History | None:
        if isinstance(force, float) and force <= 0:
            raise refused("the value must be greater than 0")
        return force

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if (self.force is None) == (self.approach is None):
            both = "both are given" if self.force is not None else "neither is given"
            raise broken(f"exactly one of load.force and load.approach is needed; {both}.")
        return self

    def at(self, t: float) -> float:
        """Return the force (N/m or N) or the approach (m), whichever is given, at ``t`` in s."""
        history = self.force if self.force is not None else self.approach
        assert history is not None  # _one_of_two
        return value_at(history, t)
