"""What a transient run shows on a terminal, in a batch log and in log.txt."""

import io
import logging
import re
from pathlib import Path

import pytest
from rich.console import Console

from porolub.io.log import close_logging, setup_logging
from porolub.io.progress import Mode, Progress
from porolub.io.step_lines import EVERY
from porolub.io.words import clock, short_time
from porolub.solve.report import NewtonRecord, StepRecord

WHY = "Newton did not converge\nin 12 iterations"


def newton(iteration: int) -> NewtonRecord:
    residuals = {"u": 1.23e-3, "p": 4.5e-6}
    return NewtonRecord("step", 1.0, iteration, residuals, {"u": 2e-4}, 1.0, 0.98, 12.34)


def step(number: int, **more: float) -> StepRecord:
    values = {
        "time_step": 4.1e-3,
        "order": 2.0,
        "newton_iterations": 3.0,
        "rejected_steps": 1.0 if number == 2 else 0.0,
        "friction_coefficient": 0.1834,
        "load_total": 1500.0,
        "load_fluid": 900.0,
        "contact_length": 9.07e-3,
        "pressure_max": 1.6e5,
    }
    return StepRecord(4.1e-3 * number, values | more)


def shown(mode: Mode, steps: int = 3, width: int = 80) -> str:
    """Everything a short run shows: one Newton iteration of its start, then steps."""
    stream = io.StringIO()
    terminal = mode == "live"
    console = Console(file=stream, width=width, force_terminal=terminal, color_system=None,
                      _environ={})  # fmt: skip
    with Progress(mode, console) as progress:
        progress.stage("steady start", 1.0)
        progress.newton(newton(7))
        progress.begin(0.0, 5.0)
        for number in range(1, steps + 1):
            if number == 2:
                progress.rejected(4.1e-3, 8.2e-3, WHY)
            progress.stage("step", 1.0)
            progress.newton(newton(0))
            progress.newton(newton(1))
            progress.step(step(number))
        progress.note("the load has a kink here")
    return stream.getvalue()


def test_each_step_is_one_aligned_line() -> None:
    lines = shown("lines").splitlines()
    assert lines[0].startswith("steady start")
    begin, header, first, rejected, second, third, note = lines[3:]
    assert begin == "# time steps from 0 to 5 s"
    assert note == "# the load has a kink here"
    assert rejected == (
        "# rejected  t = 0.0041 s  dt = 8.200e-03 s  Newton did not converge in 12 iterations"
    )
    assert len(header) == len(first) == len(second) == len(third)
    table = dict(zip(header.split(), second.split(), strict=True))
    assert table == {
        "#step": "2",
        "t/s": "0.0082",
        "dt/s": "4.100e-03",
        "order": "2",
        "newton": "3",
        "rejected": "1",
        "mu": "0.18340",
        "fluid/%": "60.00",
        "contact/mm": "9.0700",
        "p_max/kPa": "160.00",
        "left": "-",
    }


def test_awk_reads_the_steps_alone() -> None:
    text = shown("lines", steps=2 * EVERY + 3)
    rows, begun = [], False
    for line in text.splitlines():  # awk '/^#/ { on = 1; next } on { print $2 }'
        if line.startswith("#"):
            begun = True
        elif begun:
            rows.append(line.split())
    assert [int(row[0]) for row in rows] == list(range(1, 2 * EVERY + 4))
    assert {len(row) for row in rows} == {11}
    assert float(rows[-1][1]) == pytest.approx(4.1e-3 * len(rows))
    assert text.count("#step") == 3
    assert re.fullmatch(r"\d+:\d\d:\d\d", rows[-1][-1])


def test_what_a_scene_lacks_is_a_dash(capsys: pytest.CaptureFixture[str]) -> None:
    progress = Progress("lines", Console(force_terminal=False))
    progress.begin(0.0, 1.0)
    progress.step(StepRecord(0.5, {"time_step": 0.5}))
    progress.step(step(2, load_total=0.0, friction_coefficient=float("nan")))
    *_, dry, unloaded = capsys.readouterr().out.splitlines()
    assert dry.split() == ["1", "0.5", "5.000e-01", *8 * ["-"]]
    assert unloaded.split()[6:8] == ["-", "-"]


def test_times_close_to_each_other_are_told_apart(capsys: pytest.CaptureFixture[str]) -> None:
    progress = Progress("lines", Console(force_terminal=False))
    progress.begin(4.0, 5.0)
    for time in (4.1234567, 4.1234568):
        progress.step(StepRecord(time, {}))
    *_, first, second = capsys.readouterr().out.splitlines()
    assert (first.split()[1], second.split()[1]) == ("4.1234567", "4.1234568")


def test_the_terminal_keeps_rejected_steps_and_notes_only() -> None:
    pieces = shown("live").split("\x1b")
    lines = [line.strip() for line in "".join(re.sub(r"^\[[?\d]*[a-zA-Z]", "", p) for p in pieces)
             .splitlines()]  # fmt: skip
    assert "rejected  t = 0.0041 s  dt = 8.200e-03 s  Newton did not converge in 12 iterations" in (
        lines
    )
    assert "the load has a kink here" in lines
    iterations = [line for line in lines if "1.2e-03" in line]
    assert len(iterations) == 1  # of the steady start
    assert iterations[0].startswith("7 ")
    assert not [line for line in lines if "4.100e-03" in line]


def test_the_status_says_where_the_run_stands() -> None:
    text = shown("live", steps=8)
    assert "t = 0.0328 of 5 s" in text
    assert re.search(r"\d s left", text)
    assert "step 1 (0 rejected)  dt 4.10 ms  Newton 3  mu 0.1834  fluid 60.0 %" in text
    assert "step 8 (1 rejected)" in text
    assert "Newton 3, now 1  mu" in text
    last = text.rindex("step 8")
    assert "\x1b[2K" in text[last:]  # taken away at the end


def test_the_status_fits_a_narrow_terminal() -> None:
    """A line that wraps would not be taken away as a whole."""
    text = shown("live", width=50)
    for line in re.sub(r"\x1b\[[?\d]*[a-zA-Z]", "", text).splitlines():
        if line.startswith("step "):
            assert len(line) <= 50


@pytest.mark.parametrize("level", [logging.INFO, logging.DEBUG])
def test_the_log_has_every_step(tmp_path: Path, level: int) -> None:
    setup_logging(tmp_path, level)
    try:
        assert shown("quiet") == ""
    finally:
        close_logging()
    log = (tmp_path / "log.txt").read_text().splitlines()
    assert sum("4.100e-03" in line for line in log) == 3
    assert sum("# rejected" in line for line in log) == 1
    iterations = [line for line in log if "1.2e-03" in line]
    assert len(iterations) == (7 if level == logging.DEBUG else 1)
    assert all("updates: u 2.00e-04" in line for line in iterations)


def test_ranks_that_show_nothing_format_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    setup_logging(None)
    try:
        progress = Progress("quiet")
        progress.begin(0.0, 1.0)
        monkeypatch.setattr(progress._step_lines, "row", lambda *_: pytest.fail("formatted"))
        progress.newton(newton(0))
        progress.step(step(1))
    finally:
        close_logging()


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0 s"),
        (12.34, "12.3 s"),
        (1.0, "1.00 s"),
        (4.1e-3, "4.10 ms"),
        (0.9999, "1.00 s"),
        (123.4e-6, "123 us"),
        (5e-9, "5 ns"),
    ],
)
def test_short_time(value: float, text: str) -> None:
    assert short_time(value) == text


def test_clock() -> None:
    assert [clock(s) for s in (0.2, 185.4, 3599.7, 36000.0)] == [
        "0:00:00",
        "0:03:05",
        "1:00:00",
        "10:00:00",
    ]
