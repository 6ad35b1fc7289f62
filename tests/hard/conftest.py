"""The matrix of the hard cases at the end of a pytest run."""

from typing import Any

from rich.console import Console

PROPERTY = "hard case"


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Collected from the reports, so that it does not matter which process ran a case."""
    from tests.hard.case import Verdict  # these import MPI, which a conftest must not
    from tests.hard.matrix import print_matrix

    found: dict[str, dict[str, Verdict]] = {}
    for reports in terminalreporter.stats.values():
        for report in reports:
            for name, value in getattr(report, "user_properties", ()):
                if name == PROPERTY and getattr(report, "when", "") == "call":
                    case, verdicts = value
                    found.setdefault(case, {}).update(
                        {c: Verdict(*verdict) for c, verdict in verdicts.items()})
    if found:
        terminalreporter.section("hard cases")
        console = Console(file=terminalreporter._tw._file, width=180)
        print_matrix(console, found)
