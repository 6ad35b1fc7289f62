"""Every hard case is stable in the sense of its statement, or ends as it says it must."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.hard.case import Case, Verdicts
from tests.hard.judge import Trial, compared, judged
from tests.hard.rows import all_cases

LONG = 900  # s, of the slow ones
Hold = Callable[[Case, Verdicts], None]


@pytest.fixture
def hold(record_property: Callable[[str, object], None]) -> Hold:
    """Puts the verdicts into the matrix and fails if one does not hold."""

    def judge(case: Case, verdicts: Verdicts) -> None:
        record_property("hard case", (case.id, {c: (v.ok, v.text) for c, v in verdicts.items()}))
        broken = [f"{criterion}: {v.text}" for criterion, v in verdicts.items() if not v.ok]
        assert not broken, f"{case.stable} But {'; '.join(broken)}"

    return judge


def marked(cases: list[Case], slow: Callable[[Case], bool]) -> list[object]:
    marks = [pytest.mark.slow, pytest.mark.timeout(LONG)]
    return [pytest.param(c, id=c.id, marks=marks if slow(c) else []) for c in cases]


@pytest.mark.parametrize("case", marked(all_cases(), lambda case: case.slow))
def test_case(case: Case, tmp_path: Path, hold: Hold) -> None:
    hold(case, judged(Trial(case, tmp_path)))


@pytest.mark.parametrize("case", marked([c for c in all_cases() if c.refined],
                                        lambda case: case.slow_reference))
def test_refined(case: Case, tmp_path: Path, hold: Hold) -> None:
    hold(case, compared(Trial(case, tmp_path)))
