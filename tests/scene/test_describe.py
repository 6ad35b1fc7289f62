"""Histories in words, and the report of a transient scene."""

from io import StringIO
from typing import Any

import pytest
from rich.console import Console

from porolub.scene import scene_from_dict
from porolub.scene.describe import describe, readable
from porolub.scene.report import report
from tests.scene.scenes import CUBE, ROLLING, changed

WAVE = {"mean": "1.5 kN/m", "amplitude": "0.75 kN/m", "frequency": "1 Hz"}
SWING = {"mean": "0 rad/s", "amplitude": "1 rad/s", "frequency": "2 Hz", "shape": "cosine"}
RAMP = {"times": ["0 s", "0.5 s", "2 s"], "values": ["0.1 kN/m", "1 kN/m", "0.1 kN/m"]}
GAIT = {"profile": "gait", "scale": "0.3 kN/m", "frequency": "1 Hz"}


@pytest.mark.parametrize(
    ("force", "words"),
    [
        ("1.5 kN/m", "1.5 kN/m"),
        (WAVE, "1.5 kN/m +- 0.75 kN/m sine, 1 Hz"),
        (WAVE | {"phase": "90 deg"}, "1.5 kN/m +- 0.75 kN/m sine, 1 Hz, phase 90 deg"),
        (RAMP, "3 samples over 2 s, 0.1 ... 1 kN/m"),
        (RAMP | {"repeat": True}, "3 samples over 2 s, 0.1 ... 1 kN/m, repeated"),
        (RAMP | {"interpolation": "smooth"}, "3 smooth samples over 2 s, 0.1 ... 1 kN/m"),
        (GAIT, "gait 0.3 ... 3 kN/m, 1 Hz"),
    ],
)
def test_a_load_in_words(force: Any, words: str) -> None:
    scene = scene_from_dict(changed(ROLLING, load={"force": force}))
    assert describe(scene.histories()["load.force"], "N/m") == words


def test_speeds_are_written_without_prefix() -> None:
    scene = scene_from_dict(changed(ROLLING, motion={"speed": SWING}))
    assert describe(scene.histories()["motion.speed"], "rad/s") == "+- 1 rad/s cosine, 2 Hz"
    assert readable(0.02, "rad/s") == "0.02 rad/s"
    assert readable(0.02, "m") == "20 mm"
    assert readable(0.0, "m") == "0 m"


def text(tables: dict[str, Any]) -> str:
    """The report, wide enough not to be wrapped."""
    paper = StringIO()
    Console(width=200, file=paper).print(report(scene_from_dict(tables)))
    return paper.getvalue()


def row(report: str, name: str) -> str:
    """The cells of a row after its name, joined by bars."""
    lines = [[cell.strip() for cell in line.split("│")[1:-1]] for line in report.splitlines()]
    return next(" | ".join(cells[1:]) for cells in lines if cells and cells[0] == name)


def test_a_transient_scene_says_how_it_runs() -> None:
    tables = changed(
        ROLLING,
        load={"force": GAIT},
        motion={"speed": SWING},
        contact={"friction_traction": True},
        solid={"inertia": True, "density": "1100 kg/m^3"},
        pores={"compressibility": "0.1 1/GPa", "porosity": 0.8},
        time={"end": "5 s", "until": "periodic"},
    )
    found = text(tables)
    assert row(found, "load").startswith("yes | gait 0.3 ... 3 kN/m, 1 Hz | 1 unknown")
    assert row(found, "rotation").startswith("yes | +- 1 rad/s cosine, 2 Hz")
    assert row(found, "time").startswith(
        "yes | from the steady state to 5 s, until periodic; tolerance 0.001, order 2"
    )
    assert row(found, "inertia").startswith("yes | density 1100 kg/m^3 | 73,322 unknowns")
    assert row(found, "compressibility").startswith("yes | chi 1e-10 1/Pa, porosity 0.8")
    assert row(found, "squeeze").startswith("yes")
    assert "passes zero speed within 0.001 m/s" in row(found, "friction_traction")
    assert row(found, "velocity").endswith("73,322")
    assert "All that changes with time repeats after 1 s." in found
    assert "slide past each other at 0.1 m/s at t = 0." in found


def test_a_start_from_rest_says_where_the_plane_is() -> None:
    tables = changed(ROLLING, motion=None, pores={"carry": False}, time={"end": "2 ms"})
    found = text(tables)
    assert row(found, "time").startswith("yes | from rest (plane at -10 um) to 2 ms; tolerance")
    assert "repeats" not in found
    ramped = text(changed(tables, load={"force": RAMP}))
    assert "What changes with time has no common period." in ramped


def test_a_steady_scene_says_that_it_takes_the_start() -> None:
    found = text(changed(ROLLING, load={"force": WAVE}))
    assert row(found, "time").startswith("no")
    assert "Without [time] all that changes with time is taken at t = 0." in found
    for name in ("squeeze", "inertia"):
        with pytest.raises(StopIteration):
            row(found, name)
    assert "t = 0" not in text(ROLLING)


def test_boundary_values_are_listed_where_there_are_any() -> None:
    wave = {"mean": "0 kPa", "amplitude": "2 kPa", "frequency": "1 Hz"}
    top = {"traction": wave, "displacement": {"x": "1 um"}}
    tables = changed(CUBE, boundary={"left": top})
    found = text(tables)
    assert row(found, "left") == "displacement.x | 1 um"
    assert "+- 2 kPa sine, 1 Hz" in found
    assert "Boundary values" not in text(CUBE)
