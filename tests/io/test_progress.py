"""What a running solve shows on a terminal, in a batch log and in log.txt."""

import io
import logging
import math
from pathlib import Path

import pytest
from rich.console import Console

from porolub.io.log import close_logging, setup_logging
from porolub.io.progress import Mode, Progress
from porolub.solve.report import NewtonRecord


def record(iteration: int, damping: float = 1.0, load: float = 0.98, **more: float) -> NewtonRecord:
    residuals = {"u": 1.23e-3, "p": 4.5e-6, "l": 0.0, "v0": 7.8e-9} | more
    return NewtonRecord("full speed", 0.4, iteration, residuals, {"u": 2e-4}, damping, load, 12.34)


def shown(mode: Mode, terminal: bool = False) -> str:
    """Everything a short solve shows on a console 60 columns wide."""
    stream = io.StringIO()
    console = Console(
        file=stream, width=60, force_terminal=terminal, color_system="standard", _environ={}
    )
    with Progress(mode, console) as progress:
        progress.stage("full speed", 0.4)
        progress.newton(record(0))
        progress.newton(record(1, damping=0.25))
        progress.note("step taken back")
    return stream.getvalue()


def test_lines_are_aligned_plain_and_not_wrapped() -> None:
    stage, header, first, second, note = shown("lines").splitlines()
    assert stage == "full speed: 40 % of the target"
    assert note == "step taken back"
    assert " ".join(header.split()) == "it solid fluid contact balance damping load elapsed"
    assert " ".join(first.split()) == "0 1.2e-03 4.5e-06 0.0e+00 7.8e-09 1 98.00 % 12.3 s"
    assert second.split()[5] == "0.25"
    assert len(header) == len(first) == len(second) <= 80
    for word, number in (("solid", "1.2e-03"), ("balance", "7.8e-09"), ("load", "98.00 %")):
        assert header.index(word) + len(word) == first.index(number) + len(number)


def test_auto_is_live_on_a_terminal_and_lines_elsewhere() -> None:
    assert Progress("auto", Console(file=io.StringIO())).mode == "lines"
    terminal = Console(file=io.StringIO(), force_terminal=True, _environ={"TERM": "xterm"})
    assert Progress("auto", terminal).mode == "live"


def test_live_shows_the_lines_and_takes_the_status_away() -> None:
    text = shown("live", terminal=True)
    for piece in ("1.2e-03", "0.25", "step taken back", "iteration 1", "40 %"):
        assert piece in text
    hide, show, erase_line = "\x1b[?25l", "\x1b[?25h", "\x1b[2K"
    assert text.count(hide) == text.count(show) == 1
    assert text.index(hide) < text.index(show)
    assert text.rindex(erase_line) > text.rindex("iteration 1")


def test_an_exception_gives_the_cursor_back() -> None:
    stream = io.StringIO()
    console = Console(file=stream, force_terminal=True, _environ={"TERM": "xterm"})

    def solve() -> None:
        with Progress("live", console) as progress:
            progress.stage("full speed", 1.0)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        solve()
    assert "\x1b[?25h" in stream.getvalue()


def test_quiet_shows_nothing_but_the_log_has_it(tmp_path: Path) -> None:
    setup_logging(tmp_path)
    try:
        assert shown("quiet") == ""
    finally:
        close_logging()
    log = (tmp_path / "log.txt").read_text().splitlines()
    assert len(log) == 5
    assert "full speed: 40 % of the target" in log[0]
    assert "1.2e-03" in log[2]
    assert log[2].endswith("updates: u 2.00e-04")


def test_quiet_without_a_log_formats_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """The ranks that show nothing pay nothing."""
    setup_logging(None)
    try:
        progress = Progress("quiet")
        monkeypatch.setattr(progress._lines, "header", lambda _: pytest.fail("formatted"))
        progress.newton(record(0))
        assert not logging.getLogger("porolub.progress").isEnabledFor(logging.INFO)
    finally:
        close_logging()


def test_other_fields_get_a_new_header(capsys: pytest.CaptureFixture[str]) -> None:
    progress = Progress("lines", Console(force_terminal=False))
    progress.newton(record(0))
    progress.newton(record(1))
    progress.newton(record(2, a_field_with_a_long_name=1.0))
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["it", "0", "1", "it", "2"]
    assert "a_field_with_a_long_name" in lines[3]
    assert len(lines[3]) == len(lines[4])


def test_a_prescribed_approach_has_no_load_to_reach(capsys: pytest.CaptureFixture[str]) -> None:
    Progress("lines", Console(force_terminal=False)).newton(record(0, load=math.nan))
    assert capsys.readouterr().out.splitlines()[1].split()[6] == "-"
