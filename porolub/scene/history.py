"""Values that may change with time: a constant, or a harmonic about a mean.

    value(t) = mean + amplitude * shape(2 pi frequency t + phase),   shape = sine | cosine

as in Eqs. 23 and 24 of the reference paper. A steady run takes the value at t = 0.
"""

import math
from typing import Annotated, Any, Generic, Literal, TypeVar

from pydantic import Discriminator, Tag

from porolub.scene.base import Section
from porolub.scene.units import Angle, AngularSpeed, Force, Frequency, Length, Speed

Q = TypeVar("Q", bound=float)


class Harmonic(Section, Generic[Q]):
    """A harmonic history; ``mean`` and ``amplitude`` in the unit of the quantity, SI.

    ``frequency`` in Hz, ``phase`` in rad.
    """

    mean: Q
    amplitude: Q
    frequency: Frequency
    shape: Literal["sine", "cosine"] = "sine"
    phase: Angle = 0.0

    def at(self, t: float) -> float:
        """Return the value at time ``t`` in s."""
        return harmonic(t, self.mean, self.amplitude, self.frequency, self.shape, self.phase)


def harmonic(
    t: float, mean: float, amplitude: float, frequency: float, shape: str, phase: float
) -> float:
    """Return mean + amplitude * shape(2 pi frequency t + phase); t in s, phase in rad."""
    angle = 2.0 * math.pi * frequency * t + phase
    return mean + amplitude * (math.cos(angle) if shape == "cosine" else math.sin(angle))


def value_at(history: float | Harmonic[float], t: float) -> float:
    """Return the value of a constant or a harmonic at time ``t`` in s."""
    return history.at(t) if isinstance(history, Harmonic) else history


def _form(value: Any) -> str:
    return "<harmonic>" if isinstance(value, dict | Harmonic) else "<constant>"


AngularSpeedHistory = Annotated[
    Annotated[AngularSpeed, Tag("<constant>")]
    | Annotated[Harmonic[AngularSpeed], Tag("<harmonic>")],
    Discriminator(_form),
]
SpeedHistory = Annotated[
    Annotated[Speed, Tag("<constant>")] | Annotated[Harmonic[Speed], Tag("<harmonic>")],
    Discriminator(_form),
]
ForceHistory = Annotated[
    Annotated[Force, Tag("<constant>")] | Annotated[Harmonic[Force], Tag("<harmonic>")],
    Discriminator(_form),
]
LengthHistory = Annotated[
    Annotated[Length, Tag("<constant>")] | Annotated[Harmonic[Length], Tag("<harmonic>")],
    Discriminator(_form),
]
