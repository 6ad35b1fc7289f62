"""What a scene file may hold where a value can change with time, one alias for each quantity.

A plain quantity is a constant; the keys of a table tell which form it has. Tables of a scene file
are told apart by the form they share most keys with, so that a misspelt key is answered well.
"""

import difflib
from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Tag

from porolub.scene.gait import Gait
from porolub.scene.harmonic import Harmonic
from porolub.scene.history import History
from porolub.scene.samples import Samples
from porolub.scene.table import Table
from porolub.scene.units import (
    ANGULAR_SPEED,
    LENGTH,
    LINE_LOAD,
    PRESSURE,
    SPEED,
    AngularSpeed,
    Force,
    Length,
    LoadForce,
    Pressure,
    Quantity,
    Speed,
)

FORMS: dict[str, type[History]] = {
    "<harmonic>": Harmonic,
    "<samples>": Samples,
    "<gait>": Gait,
}
_EXTRA_KEYS = {"<samples>": ("table",)}


def form(value: Any) -> str:
    """Return the tag of the form ``value`` has, named profiles left out."""
    tag = nearest_form(value, {t: keys_of(t) for t in ("<harmonic>", "<samples>")})
    return tag or "<constant>"


def form_of_force(value: Any) -> str:
    """Return the tag of the form ``value`` has; loads know profiles too."""
    return nearest_form(value, {t: keys_of(t) for t in FORMS}) or "<constant>"


def keys_of(tag: str) -> tuple[str, ...]:
    """Return the keys a table of that form may have."""
    return (*FORMS[tag].model_fields, *_EXTRA_KEYS.get(tag, ()))


def nearest_form(value: Any, forms: dict[str, tuple[str, ...]]) -> str | None:
    """Return the tag of a history or a table of keys, the first among equals; else None."""
    for tag, model in FORMS.items():
        if isinstance(value, model):
            return tag
    if not isinstance(value, dict):
        return None

    def shared(tag: str) -> float:
        keys = forms[tag]
        near = [difflib.get_close_matches(str(key), keys, 1) for key in value]
        return sum(1.0 if key in keys else 0.5 * len(n) for key, n in zip(value, near, strict=True))

    return max(forms, key=shared)


def table_of(quantity: Quantity) -> BeforeValidator:
    """Return what lets samples stand in a CSV file."""
    return BeforeValidator(Table(quantity).read)


AngularSpeedHistory = Annotated[
    Annotated[AngularSpeed, Tag("<constant>")]
    | Annotated[Harmonic[AngularSpeed], Tag("<harmonic>")]
    | Annotated[Samples[AngularSpeed], table_of(Quantity(ANGULAR_SPEED)), Tag("<samples>")],
    Discriminator(form),
]
SpeedHistory = Annotated[
    Annotated[Speed, Tag("<constant>")]
    | Annotated[Harmonic[Speed], Tag("<harmonic>")]
    | Annotated[Samples[Speed], table_of(Quantity(SPEED)), Tag("<samples>")],
    Discriminator(form),
]
LengthHistory = Annotated[
    Annotated[Length, Tag("<constant>")]
    | Annotated[Harmonic[Length], Tag("<harmonic>")]
    | Annotated[Samples[Length], table_of(Quantity(LENGTH)), Tag("<samples>")],
    Discriminator(form),
]
PressureHistory = Annotated[
    Annotated[Pressure, Tag("<constant>")]
    | Annotated[Harmonic[Pressure], Tag("<harmonic>")]
    | Annotated[Samples[Pressure], table_of(Quantity(PRESSURE)), Tag("<samples>")],
    Discriminator(form),
]
ForceHistory = Annotated[
    Annotated[Force, Tag("<constant>")]
    | Annotated[Harmonic[Force], Tag("<harmonic>")]
    | Annotated[Samples[Force], table_of(LoadForce(LINE_LOAD)), Tag("<samples>")]
    | Annotated[Gait, Tag("<gait>")],
    Discriminator(form_of_force),
]
