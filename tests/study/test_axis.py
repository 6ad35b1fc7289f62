"""The values of an axis: exact as decimals, spaced as asked, placed as numbers."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.errors import SceneError
from porolub.study.plan.amounts import amount
from porolub.study.plan.axis import Axis, axis_of
from porolub.study.plan.sweep_schema import AxisTable
from tests.study.sweeps import linear, log


def axis(**table: Any) -> Axis:
    return axis_of(AxisTable.model_validate(table))


def first(a: Axis) -> list[Any]:
    return [values[0] for values in a.texts]


def test_equal_steps_are_exact_in_the_unit_of_the_user() -> None:
    a = axis(**linear("load.approach", "-10 um", "200 um", 22))
    assert first(a) == [f"{n} um" for n in range(-10, 201, 10)]
    assert (a.name, a.unit, a.scale) == ("approach", "m", "linear")
    assert a.numbers is not None
    assert a.numbers.tolist() == [float(f"{n}e-6") for n in range(-10, 201, 10)]


def test_steps_that_are_no_decimals_pass_through_zero_all_the_same() -> None:
    a = axis(**linear("load.approach", "-0.1 um", "0.2 um", 10))
    assert first(a)[:5] == ["-0.1 um", "-0.066666666667 um", "-0.033333333333 um", "0 um",
                            "0.033333333333 um"]  # fmt: skip


def test_ends_may_have_different_units() -> None:
    a = axis(**linear("load.approach", "100 um", "1 mm", 4))
    assert first(a) == ["100 um", "400 um", "700 um", "1000 um"]
    speeds = axis(**log("motion.speed", "1 rpm", "20 rad/s", 3))
    assert first(speeds)[0] == "1 rpm"
    assert speeds.numbers is not None
    assert speeds.numbers[0] == pytest.approx(np.pi / 30, rel=1e-15)
    assert speeds.numbers[-1] == 20.0  # no decimal number of rpm is 20 rad/s


@given(
    low=st.floats(1e-8, 1e8),
    ratio=st.floats(1.01, 1e6),
    count=st.integers(2, 60),
    down=st.booleans(),
)
def test_equal_ratios(low: float, ratio: float, count: int, down: bool) -> None:
    ends = (low * ratio, low) if down else (low, low * ratio)
    a = axis(**log("load.force", f"{ends[0]!r} kN/m", f"{ends[1]!r} kN/m", count))
    assert a.scale == "log"
    assert a.numbers is not None
    np.testing.assert_allclose(a.numbers, 1e3 * np.geomspace(*ends, count), rtol=1e-11)
    texts = [amount(v) for v in first(a)]
    assert [t.number for t in texts if t] == a.numbers.tolist()


@given(start=st.floats(-1e6, 1e6), span=st.floats(1e-3, 1e6), count=st.integers(2, 60))
def test_equal_steps(start: float, span: float, count: int) -> None:
    a = axis(**linear("contact.friction", start, start + span, count))
    assert a.numbers is not None
    wanted = np.linspace(start, start + span, count)
    np.testing.assert_allclose(a.numbers, wanted, rtol=0, atol=1e-11 * np.abs(wanted).max())
    assert first(a) == a.numbers.tolist()


def test_plain_numbers_stay_decimals_and_counts_stay_whole() -> None:
    assert first(axis(**linear("contact.friction", 0, 0.4, 5))) == [0.0, 0.1, 0.2, 0.3, 0.4]
    elements = first(axis(**linear("mesh.along", 10, 25, 3)))
    assert elements == [10, 18, 25]
    assert all(type(n) is int for n in elements)
    assert first(axis(**log("mesh.across", 2, 32, 5))) == [2, 4, 8, 16, 32]


def test_pieces_are_joined_with_equal_ends_once() -> None:
    pieces = [
        {"from": "-4 um", "to": "-2 um", "count": 2},
        {"from": "-2 um", "to": "2 um", "count": 3},
        {"from": "0.01 mm", "to": "0.02 mm", "count": 2},
    ]
    a = axis(key="load.approach", linear=pieces)
    assert first(a) == ["-4 um", "-2 um", "0 um", "2 um", "0.01 mm", "0.02 mm"]
    assert a.scale == "linear"


def test_several_keys_get_the_same_value_or_one_each() -> None:
    same = axis(key=["film.viscosity", "pores.viscosity"], values=["1 mPa*s", "1 Pa*s"])
    assert same.values(1) == {"film.viscosity": "1 Pa*s", "pores.viscosity": "1 Pa*s"}
    moduli = [["0.1 MPa", "1 MPa"], ["0.2 MPa", "2 MPa"], ["0.5 MPa", "5 MPa"]]
    each = axis(key=["solid.shear_modulus", "solid.bulk_modulus"], values=moduli)
    assert each.values(2) == {"solid.shear_modulus": "0.5 MPa", "solid.bulk_modulus": "5 MPa"}
    assert (each.name, each.unit, each.label(2)) == ("shear_modulus", "Pa", 5e5)


def test_the_first_key_that_tells_the_positions_apart_gives_the_numbers() -> None:
    a = axis(key=["solid.law", "pores.biot"], values=[["linear", 0.9], ["neo-hookean", 0.5]])
    assert a.numbers is not None
    assert a.numbers.tolist() == [0.9, 0.5]


@pytest.mark.parametrize(
    ("values", "scale"),
    [
        ([1.0, 2.0, 3.0], "linear"),
        ([1.0, 10.0, 100.0], "log"),
        (["1 mm", "2 mm", "5 mm", "1 cm"], "log"),
        ([100.0, 1.0, 10.0], "log"),  # in any order
        ([0.0, 1.0, 10.0], "linear"),
        ([1.0, 10.0], "linear"),
    ],
)
def test_the_scale_of_a_list_follows_from_its_values(values: list[Any], scale: str) -> None:
    assert axis(key="a.b", values=values).scale == scale


def test_a_list_may_say_its_scale() -> None:
    assert axis(key="a.b", values=[1.0, 10.0], scale="log").scale == "log"


@pytest.mark.parametrize(
    "values",
    [
        ["sliding", "bonded"],
        [True, False],
        ["1 rad/s", "1 Hz"],
        ["1 mm", 2.0],
        [1.0, float("nan")],
        ["1 mm", {"mean": "1 mm"}],
    ],
)
def test_values_without_a_common_kind_are_categories(values: list[Any]) -> None:
    a = axis(key="a.b", values=values)
    assert a.numbers is None
    assert a.coordinates is None
    assert a.unit == ""
    assert all(isinstance(a.label(i), str) for i in range(len(a)))


def test_labels_of_categories_are_texts_of_the_file() -> None:
    a = axis(key="a.b", values=["bonded", True, {"mean": "1 mm"}])
    assert [a.label(i) for i in range(3)] == ["bonded", "true", '{mean = "1 mm"}']


@pytest.mark.parametrize(
    ("key", "has"),
    [
        ("load.approach", True),
        ("solid.shear_modulus", True),
        ("boundary.inlet.pressure", True),
        ("mesh.along", False),
        ("geometry.thickness", False),
        ("time.end", False),
    ],
)
def test_what_changes_the_model_itself_makes_no_neighbours(key: str, has: bool) -> None:
    assert (axis(key=key, values=[1, 2]).coordinates is not None) is has


def test_neighbours_are_measured_on_the_scale() -> None:
    a = axis(**log("load.force", "1 N/m", "1 kN/m", 4))
    assert a.coordinates is not None
    np.testing.assert_allclose(a.coordinates, np.log([1, 10, 100, 1000]))


@pytest.mark.parametrize(
    ("table", "reason"),
    [
        (log("a.b", "0 um", "1 um", 3), "ends greater than 0"),
        (log("a.b", "1 um", "-1 um", 3), "ends greater than 0"),
        (linear("a.b", "1 um", "0.001 mm", 3), "must differ"),
        (linear("a.b", "1 um", "1 s", 3), "of one kind"),
        (linear("a.b", "1 rad/s", "2 Hz", 3), "of one kind"),
        (linear("a.b", "1 um", 2, 3), "of one kind"),
        (linear("a.b", "thin", "thick", 3), "of one kind"),
        (linear("mesh.along", 1, 3, 9), "but 1 stands there twice"),
        ({"key": "a.b", "values": ["1 mm", "1000 um"]}, '"1 mm" and "1000 um" are equal'),
        ({"key": "a.b", "values": ["x", "y", "x"]}, '"x" stands there twice'),
        ({"key": ["a.b", "a.c"], "values": [[1, 2], [1, 2, 3]]}, "2 keys need as many"),
        ({"key": "a.b", "values": ["x", "y"], "scale": "log"}, "no numbers"),
        ({"key": "a.b", "values": [-1, 1], "scale": "log"}, "greater than 0"),
        (
            {
                "key": "a.b",
                "linear": [
                    {"from": "1 m", "to": "2 m", "count": 2},
                    {"from": "2 s", "to": "3 s", "count": 2},
                ],
            },
            "of one kind",
        ),
    ],
)
def test_impossible_axes_are_refused(table: dict[str, Any], reason: str) -> None:
    with pytest.raises(SceneError) as caught:
        axis(**table)
    assert reason in str(caught.value)


def test_equal_values_of_other_types_are_no_duplicates() -> None:
    assert len(axis(key="a.b", values=[1, True, "x"])) == 3
