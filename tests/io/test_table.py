"""The tables have the right numbers in the units of the trade."""

import io
import math
from typing import Any

import pytest
from rich.console import Console
from rich.table import Table
from rich.text import Text

from porolub.io.printed import APPENDIX_A, CASE_1, printed_for
from porolub.io.table import comparison_table, print_comparison, print_results, results_table
from porolub.io.words import digits, seconds
from porolub.scene import Scene, scene_from_dict


def cells(table: Table) -> dict[str, list[str]]:
    """Rows by their first cell, as plain text."""
    rows = zip(*([str(cell) for cell in column.cells] for column in table.columns), strict=True)
    return {first.strip(): rest for first, *rest in rows}


def printed(width: int, *, function: Any, arguments: tuple[Any, ...]) -> str:
    stream = io.StringIO()
    function(Console(file=stream, width=width), *arguments)
    return stream.getvalue()


def test_a_body_has_an_area_and_a_width_of_contact(summary: dict[str, Any], scene: Scene) -> None:
    rows = cells(results_table(summary, scene))
    assert not {"contact area", "contact width"} & set(rows)
    rows = cells(results_table(
        summary | {"contact_area": 4.125e-5, "contact_width": 6.4e-3}, scene))
    assert rows["contact area"] == ["41.25 mm^2", ""]
    assert rows["contact width"] == ["6.400 mm", "along z"]
    three = [name for name in rows if name.startswith("contact ")]
    assert three == ["contact area", "contact length", "contact width"]


def test_numbers_are_converted(summary: dict[str, Any], scene: Scene) -> None:
    rows = cells(results_table(summary, scene))
    expected = {
        "by the solid": ["0.5625 kN/m", "37.5 % of the load"],
        "by the fluid": ["0.9375 kN/m", "62.5 % of the load"],
        "total": ["1.500 kN/m", ""],
        "fluid to solid": ["1.667", ""],
        "friction coefficient": ["0.1686", "3.200e-04 from the film"],
        "approach": ["95.00 um", "the plane is pressed in"],
        "contact length": ["8.125 mm", "from -4.125 to 4.000 mm"],
        "penetration length": ["8.718 mm", "from the geometry alone"],
        "thinnest film": ["0 um", ""],
        "into the layer": ["0.1750 (g/m)/s", "left 0.1500, right 0.02500"],
        "out of the layer": ["0.07000 (g/m)/s", "left 0.005000, right 0.06500"],
        "highest fluid pressure": ["165.7 kPa", "lowest -20.00 kPa"],
        "highest contact pressure": ["110.0 kPa", ""],
        "highest von Mises stress": ["240.0 kPa", ""],
        "lowest volume ratio J": ["0.9512", ""],
        "load balance error": ["1.2e-13", "relative"],
        "fluid mass balance error": ["3.0e-12", "relative"],
        "error, estimated": ["unknown", "no solution on coarser meshes to compare with"],
        "unknowns": [
            "165",
            "displacement 130, fluid pressure 21, contact pressure 13, approach 1",
        ],
        "Newton iterations": ["14", "15 linear iterations"],
        "wall time": [
            "76.3 s",
            "setup 1.20 s, assembly 2.31 s, linear solve 71.9 s, output 0.90 s",
        ],
        "peak memory": ["650 MB", "2 ranks"],
    }
    assert {name: rows[name] for name in expected} == expected
    headings = {name for name, rest in rows.items() if not any(rest)}
    assert set(rows) == set(expected) | headings
    assert len(headings) == 6


def test_what_the_scene_lacks_is_left_out(dry_scene: Scene) -> None:
    numbers = {"load_total": 300.0, "load_solid": 300.0, "approach": None, "film_min": math.nan}
    rows = cells(results_table(numbers, dry_scene))
    assert list(rows) == ["[bold]Load[/]", "by the solid", "total"]


def test_warnings_stand_under_the_message(summary: dict[str, Any], scene: Scene) -> None:
    told = ["The mesh does not resolve this state.", "The fluid would cavitate."]
    title = results_table(summary | {"warnings": told}, scene).title
    assert isinstance(title, Text)
    assert title.plain.splitlines()[-2:] == told


def test_touching_nowhere_is_said(summary: dict[str, Any], scene: Scene) -> None:
    apart = {"contact_length": 0.0, "contact_left": None, "contact_right": None, "approach": -2e-6}
    rows = cells(results_table(summary | apart, scene))
    assert rows["contact length"] == ["0 mm", "no contact"]
    assert rows["approach"] == ["-2.000 um", "the plane stands off"]


def test_a_body_has_forces_and_flows_not_per_depth(summary: dict[str, Any]) -> None:
    body = scene_from_dict(
        {
            "scene": {"dimension": 3},
            "geometry": {
                "shape": "block",
                "width": "10 mm",
                "thickness": "1 mm",
                "depth": "5 mm",
            },
            "mesh": {"along": 4, "across": 2, "deep": 2},
            "solid": {"law": "linear", "shear_modulus": "0.5 MPa", "bulk_modulus": "5 MPa"},
        }
    )
    rows = cells(results_table(summary, body))
    assert rows["total"][0] == "1500 N"
    assert rows["into the layer"][0] == "0.1750 g/s"


def test_the_table_fits_into_80_columns(summary: dict[str, Any], scene: Scene) -> None:
    text = printed(80, function=print_results, arguments=(summary, scene))
    assert "Case 1: steady rotation" in text
    assert "Converged in 14 Newton iterations." in text
    assert "0.1750 (g/m)/s" in text
    assert "…" not in text


def test_titles_and_messages_are_not_taken_for_markup(
    summary: dict[str, Any], dry_scene: Scene
) -> None:
    odd = summary | {"message": "no [bold]markup[/bold] and [/] nothing"}
    text = printed(100, function=print_results, arguments=(odd, dry_scene))
    assert "no [bold]markup[/bold] and [/] nothing" in text


def test_ours_stands_beside_the_print(summary: dict[str, Any], scene: Scene) -> None:
    rows = cells(comparison_table(summary, CASE_1, scene))
    assert rows["load L"] == ["kN/m", "1.500", "1.5", "+0.0 %", "Table 3"]
    assert rows["fluid share L_f"] == ["kN/m", "0.9375", "0.904", "+3.7 %", "Sec. 3.2.1"]
    assert rows["solid share L_s"] == ["kN/m", "0.5625", "0.596", "-5.6 %", "Sec. 3.2.1"]
    assert rows["ratio Gamma"][1:4] == ["1.667", "1.542", "+8.1 %"]
    assert rows["flow in M_in"][:4] == ["(g/m)/s", "0.1750", "0.185", "-5.4 %"]
    assert rows["flow out M_out"][1:4] == ["0.07000", "0.219", "-68.0 %"]
    # eta U / L = 1 mPa s x 0.1 m/s / 1500 N/m
    assert rows["Sommerfeld eta U/L"][1:4] == ["6.667e-08", "6.67e-08", "+0.0 %"]
    text = printed(80, function=print_comparison, arguments=(summary, CASE_1, scene))
    assert len(text.split("difference")[1].rstrip().splitlines()) == 2 + len(CASE_1)


def test_a_number_the_run_lacks_is_a_dash(dry_scene: Scene) -> None:
    rows = cells(comparison_table({"load_solid": 1251.0}, APPENDIX_A, dry_scene))
    assert rows["solid share L_s"][:4] == ["N/m", "1251", "1390", "-10.0 %"]
    assert rows["fluid share L_f"][1:4] == ["-", "110", "-"]
    rows = cells(comparison_table({"inflow_left": 1.0}, CASE_1, dry_scene))
    assert {row[1] for row in rows.values()} == {"-"}


def test_only_the_papers_scenes_are_compared() -> None:
    assert printed_for("Case 1: steady rotation under constant load") is CASE_1
    assert printed_for("Appendix A: the plane slides") is APPENDIX_A
    for title in ("Case 1 with the layer bonded", "Case 10: other", "my Case 1: copy", ""):
        assert printed_for(title) is None


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (1.5, "1.500"),
        (-999.96, "-1000"),
        (1234.0, "1234"),
        (0.001, "0.001000"),
        (9.5e-4, "9.500e-04"),
        (123456.0, "1.235e+05"),
    ],
)
def test_digits(value: float, text: str) -> None:
    assert digits(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.4, "0.40 s"),
        (12.34, "12.3 s"),
        (99.9, "99.9 s"),
        (99.97, "1 min 40 s"),
        (185.4, "3 min 05 s"),
        (3599.7, "1 h 00 min"),
        (7380.0, "2 h 03 min"),
    ],
)
def test_seconds(value: float, text: str) -> None:
    assert seconds(value) == text
