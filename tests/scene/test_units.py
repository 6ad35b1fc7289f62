"""Quantities: every unit of the field is read, everything doubtful is refused with a reason."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.scene import units
from porolub.scene.units import Kind, NotAQuantity, parse


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("1 mm", units.LENGTH, 1e-3),
        ("0.1 um", units.LENGTH, 1e-7),
        ("0.1 µm", units.LENGTH, 1e-7),
        ("-10um", units.LENGTH, -1e-5),
        ("0.5 MPa", units.PRESSURE, 5e5),
        ("0.5 N/mm^2", units.PRESSURE, 5e5),
        ("1 mPa*s", units.VISCOSITY, 1e-3),
        ("1 mPa s", units.VISCOSITY, 1e-3),
        ("1 cP", units.VISCOSITY, 1e-3),
        ("1 um^3/mm", units.PERMEABILITY, 1e-15),
        ("1e-15 m^2", units.PERMEABILITY, 1e-15),
        ("2.08 1/GPa", units.COMPRESSIBILITY, 2.08e-9),
        ("1000 kg/m^3", units.DENSITY, 1000.0),
        ("1.1 g/cm^3", units.DENSITY, 1100.0),
        ("180 deg", units.ANGLE, math.pi),
        ("1 rad/s", units.ANGULAR_SPEED, 1.0),
        ("60 rpm", units.ANGULAR_SPEED, 2 * math.pi),
        ("90 deg/s", units.ANGULAR_SPEED, math.pi / 2),
        ("0.1 m/s", units.SPEED, 0.1),
        ("2 Hz", units.FREQUENCY, 2.0),
        ("2 1/s", units.FREQUENCY, 2.0),
        ("5 min", units.TIME, 300.0),
        ("3kN/m", units.LINE_LOAD, 3000.0),
        ("3 kN", units.FORCE, 3000.0),
        ("90 %", units.NUMBER, 0.9),
        ("0.9", units.NUMBER, 0.9),
    ],
)
def test_units_of_the_field_are_read_to_the_last_digit(text: str, kind: Kind, value: float) -> None:
    assert parse(text, kind) == value


@pytest.mark.parametrize(
    ("text", "kind", "reason"),
    [
        ("0.5 mm", units.PRESSURE, 'this is a length; a pressure is needed, such as "0.5 MPa"'),
        ("5", units.ANGLE, "the unit is missing; an angle"),
        ("5 mmm", units.LENGTH, 'the unit "mmm" is not known; a length'),
        ("mm", units.LENGTH, "not a number with a unit"),
        ("thick", units.LENGTH, "not a number with a unit"),
        ("", units.LENGTH, "not a number with a unit"),
        ("nan mm", units.LENGTH, "not a number with a unit"),
        ("1e999 mm", units.LENGTH, "must be finite"),
        ("1,5 mm", units.LENGTH, "a comma cannot stand in a number"),
        ("1 2 mm", units.LENGTH, "not one number with a unit"),
        ("1 mm + 2 mm", units.LENGTH, "not"),
        ("1 mm*", units.LENGTH, "not known"),
        ("1 degC", units.LENGTH, "a length is needed"),
        ("1 Hz", units.ANGULAR_SPEED, "this is a frequency; an angular speed"),
        ("1 rad/s", units.FREQUENCY, "this is an angular speed; a frequency"),
        ("1 m/s", units.ANGULAR_SPEED, "this is a speed; an angular speed"),
        ("1e-15 m^4/(N*s)", units.PERMEABILITY, "this is a hydraulic permeability; a permeability"),
        ("3 kN", units.LINE_LOAD, "this is a force; a load per length"),
        ("1 A", units.LENGTH, "a quantity in A; a length"),
        ("50 %", units.LENGTH, "a pure number; a length"),
    ],
)
def test_what_is_not_the_wanted_quantity_is_refused_with_the_reason(
    text: str, kind: Kind, reason: str
) -> None:
    with pytest.raises(NotAQuantity) as caught:
        parse(text, kind)
    assert reason in str(caught.value)


@given(st.floats(allow_nan=False, allow_infinity=False), st.sampled_from(units.KINDS))
def test_what_is_written_in_si_reads_back_to_the_same_float(value: float, kind: Kind) -> None:
    assert parse(f"{value!r} {kind.unit}", kind) == value


@pytest.mark.parametrize("kind", [k for k in units.KINDS if k.example])
def test_the_example_in_a_message_is_itself_accepted(kind: Kind) -> None:
    assert parse(kind.example, kind) > 0
