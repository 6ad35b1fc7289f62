"""What a running sweep shows: on a terminal, in a batch log, in log.txt and at the end."""

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from porolub.io.log import close_logging, setup_logging
from porolub.study.work import progress as module
from porolub.study.work.label import axis_text, case_label
from porolub.study.work.pace import SweepPace
from porolub.study.work.progress import SweepProgress
from tests.study.rows import row

UNITS = {"approach": "m"}
REASON = "No equilibrium was found at 23 % of the target: the damping fell below 0.001. " * 2


class Clock:
    """Shows the time it is told, s."""

    def __init__(self) -> None:
        self.now = 100.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(module.time, "monotonic", clock.monotonic)
    return clock


@pytest.fixture
def log(tmp_path: Path) -> Iterator[Path]:
    setup_logging(tmp_path)
    yield tmp_path / "log.txt"
    close_logging()


def console(terminal: bool = False, width: int = 80) -> Console:
    environment = {"TERM": "xterm"} if terminal else {}
    return Console(file=io.StringIO(), force_terminal=terminal, width=width, _environ=environment)


def shown(console: Console) -> str:
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


def of(case: int, status: str = "converged", **more: Any) -> dict[str, Any]:
    """A row of one axis."""
    found = row(case, status) | more
    return found | {"axes": {"approach": found["axes"]["approach"]}}


def test_a_batch_log_has_a_line_for_each_case(clock: Clock, log: Path) -> None:
    there = console()
    with SweepProgress(43, 2, 11, console=there, units=UNITS) as progress:
        progress.started("approach = 0 m", 0)
        progress.finished(of(1))
        progress.started("approach = 20 um", 0)
        progress.finished(of(4))
        progress.finished(of(2, "failed", message=REASON))
    first, second, third, *reason = shown(there).splitlines()
    assert " ".join(second.split()) == (
        "13/43 approach = 20 um converged mu 0.14286 7 Newton from cases 3, 5 1.25 s left 18.8 s"
    )
    assert "Newton from zero" in first
    assert third == "14/43  approach = 5 um   failed     1.25 s  left 18.1 s"
    assert first.index("converged") + 2 == second.index("converged")  # the label was longer
    assert " ".join(" ".join(reason).split()) == REASON.strip()
    assert all(line.startswith("       ") for line in reason)
    assert max(map(len, reason)) <= 80
    logged = log.read_text().splitlines()
    assert len(logged) == 3
    assert logged[1].endswith(second)
    assert logged[2].endswith(f"{third}: {REASON.strip()}")


def test_the_last_case_leaves_no_time(clock: Clock) -> None:
    there = console()
    progress = SweepProgress(2, 1, console=there, units=UNITS)
    progress.finished(of(0))
    progress.finished(of(1))
    first, last = shown(there).splitlines()
    assert first.endswith("1.25 s  left 1.25 s")
    assert last.endswith("  1.25 s")
    assert "left" not in last


def test_a_scene_without_friction_or_without_results_has_fewer_words(clock: Clock) -> None:
    there = console()
    progress = SweepProgress(9, 1, console=there, units=UNITS)
    progress.finished(of(0, summary={"newton_iterations": 3, "friction_coefficient": None}))
    progress.finished(of(1, summary={}))
    first, second = shown(there).splitlines()
    assert "mu" not in first
    assert "3 Newton from zero" in first
    assert second.split()[4:8] == ["m", "converged", "1.25", "s"]


def test_a_terminal_has_a_status_and_only_cases_without_result_stay(
    clock: Clock, log: Path
) -> None:
    there = console(terminal=True)
    with SweepProgress(8, 2, 1, console=there, units=UNITS) as progress:
        assert progress.mode == "live"
        progress.started("approach = 0 m", 0)
        progress.started("approach = 20 um", 1)
        clock.now += 1.25
        progress.finished(of(0))
        progress.finished(of(2, "refused", message="No such thickness."))
    text = shown(there)
    for piece in ("1/8 cases", "2 running: approach = 0 m; approach = 20 um", "2/8 cases",
                  "1 running: approach = 20 um", "1 converged, 1.25 s", "3.12 s left",
                  "1 converged, 1 refused"):  # fmt: skip
        assert piece in text
    assert "mu 0.14286" not in text
    assert "3/8  approach = 5 um  refused" in text
    assert "       No such thickness." in text
    assert text.count("\x1b[?25l") == text.count("\x1b[?25h") == 1
    assert "mu 0.14286" in log.read_text()


def test_the_status_is_not_wider_than_the_terminal(clock: Clock) -> None:
    narrow = console(terminal=True, width=60)
    progress = SweepProgress(10**5, 64, console=narrow, units=UNITS)
    for group in range(64):
        progress.started(f"approach = {group} um, speed = 0.4642 rad/s", group)
    clock.now += 2e4
    for status in ("converged", "failed", "refused"):
        progress.finished(of(0, status, wall=1e4))
    progress.close()
    still = console(width=60)
    still.print(progress.lines())
    lines = shown(still).splitlines()
    assert len(lines) == 3
    assert max(map(len, lines)) <= 60
    assert lines[2].startswith("64 running: approach = 0 um, speed")
    assert lines[2].rstrip().endswith("…")
    wide = console(width=400)
    wide.print(progress.lines())
    assert shown(wide).rstrip().endswith("approach = 3 um, speed = 0.4642 rad/s and 60 more")


def test_an_error_gives_the_cursor_back(clock: Clock) -> None:
    there = console(terminal=True)

    def sweep() -> None:
        with SweepProgress(3, 1, console=there) as progress:
            progress.refresh()
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep()
    assert "waiting" in shown(there)
    assert shown(there).count("\x1b[?25h") == 1


def test_groups_are_known_by_the_case_or_by_number(clock: Clock) -> None:
    progress = SweepProgress(9, 2, quiet=True, console=console(), units=UNITS)
    for group in (0, 1, 2):
        progress.started(progress.label(of(2 * group)["axes"]), group)
    progress.finished(of(2))
    progress.finished(of(0), group=0)
    assert progress._running == {2: "approach = 20 um"}
    assert progress.done == 2


def test_quiet_shows_nothing_but_the_log_has_it(clock: Clock, log: Path) -> None:
    there = console(terminal=True)
    with SweepProgress(2, 1, quiet=True, console=there, units=UNITS) as progress:
        progress.note("2 cases")
        progress.started("approach = 0 m", 0)
        progress.finished(of(0))
        progress.summary([of(0)], Path("results/x"))
    assert shown(there) == ""
    lines = log.read_text().splitlines()
    assert lines[0].endswith("porolub.sweep: 2 cases")
    assert any(line.endswith("results/x/table.csv") for line in lines)


def test_the_summary_counts_all_cases(clock: Clock, log: Path) -> None:
    there = console()
    progress = SweepProgress(43, 2, 11, console=there, units=UNITS)
    clock.now += 65.0
    rows = [of(0), of(1), of(3, "failed", message=REASON), of(2, "refused", message="Bad\nunit.")]
    progress.summary(rows, Path("results/stribeck"))
    assert shown(there).splitlines()[:9] == [
        "",
        "converged          2 of 4 cases",
        "failed             1 of 4 cases",
        "refused            1 of 4 cases",
        "Newton iterations  14, 7.0 a case",
        "wall time          65.0 s; all cases together 5.00 s",
        "table              results/stribeck/table.csv",
        "case 2  approach = 5 um  refused",
        "       Bad unit.",
    ]
    assert shown(there).splitlines()[9] == "case 3  approach = 5 um  failed"
    assert f"case 3  approach = 5 um  failed: {REASON.strip()}" in log.read_text()


@pytest.mark.parametrize(
    ("failed", "last"), [(10, "       why 9"), (15, "and 5 more, see table.csv")]
)
def test_of_many_failures_ten_are_named(clock: Clock, failed: int, last: str) -> None:
    there = console()
    rows = [of(0, "failed", message=f"why {k}") | {"case": k} for k in range(failed)]
    SweepProgress(20, 1, console=there, units=UNITS).summary(rows)
    lines = shown(there).splitlines()
    assert sum(line.startswith("case ") for line in lines) == 10
    assert lines[-1] == last
    assert "Newton iterations  0" in lines


def test_the_time_left_counts_groups_and_what_they_have_done_so_far() -> None:
    pace = SweepPace(todo=10, groups=2)
    pace.started(0, now=0.0)
    pace.started(1, now=0.0)
    assert pace.left(4.0) is None
    pace.finished(0, 4.0)
    assert pace.left(4.0) == pytest.approx((8 * 4.0 + 0.0) / 2)
    pace.started(0, now=4.0)
    assert pace.left(6.0) == pytest.approx((7 * 4.0 + 2.0 + 0.0) / 2)
    pace.finished(1, 8.0)  # the mean is 6 now
    assert pace.left(8.0) == pytest.approx((7 * 6.0 + 2.0) / 2)
    pace.finished(None, None)  # refused: nothing was computed
    assert pace.left(8.0) == pytest.approx((6 * 6.0 + 2.0) / 2)


def test_the_last_case_is_not_shared_by_idle_groups() -> None:
    pace = SweepPace(todo=2, groups=8)
    pace.started(0, now=0.0)
    pace.finished(0, 10.0)
    pace.started(1, now=10.0)
    assert pace.left(13.0) == pytest.approx(7.0)
    pace.finished(1, 10.0)
    assert pace.left(20.0) == 0.0


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (2e-5, "m", "20 um"),
        (-1e-5, "m", "-10 um"),
        (0.0, "m", "0 m"),
        (1234.5, "N/m", "1.234 kN/m"),
        (1e-3, "Pa*s", "1 mPa*s"),
        (1e-3, "rad/s", "0.001 rad/s"),
        (0.0872664625997, "rad", "5 deg"),
        (1e-9, "m^2", "1e-09 m^2"),
        (2.08e-9, "1/Pa", "2.08e-09 1/Pa"),
        (1000.0, "kg/m^3", "1000 kg/m^3"),
        (300.0, "", "300"),
        ("bonded", "", "bonded"),
        (True, "", "True"),
    ],
)
def test_values_of_axes_are_written_in_units_of_handy_size(
    value: Any, unit: str, text: str
) -> None:
    assert axis_text(value, unit) == text


def test_a_case_is_called_by_all_its_axes() -> None:
    assert case_label({"approach": 2e-5, "base": "bonded"}, UNITS) == (
        "approach = 20 um, base = bonded"
    )
