"""What came of a sweep as a whole, in words."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from porolub.io.summary import number
from porolub.io.words import seconds
from porolub.study.work.label import case_label
from porolub.study.work.table import CSV

Row = Mapping[str, Any]
NAMED = 10
"""Cases without a result that are named; there may be thousands."""


def facts(rows: Sequence[Row], elapsed: float, directory: Path | None) -> list[tuple[str, str]]:
    """Return label and value of what all cases come to; ``elapsed``: wall time of this run, s."""
    counts = Counter(str(row["status"]) for row in rows)
    statuses = ["converged", *sorted(counts.keys() - {"converged"})]
    newton = sum(number(row.get("summary") or {}, "newton_iterations") or 0.0 for row in rows)
    took = sum(row.get("wall") or 0.0 for row in rows)
    found = [(status, f"{counts[status]} of {len(rows)} cases") for status in statuses]
    each = f", {newton / counts['converged']:.1f} a case" if counts["converged"] else ""
    found.append(("Newton iterations", f"{newton:,.0f}{each}"))
    found.append(("wall time", f"{seconds(elapsed)}; all cases together {seconds(took)}"))
    return found if directory is None else [*found, ("table", str(directory / CSV))]


def troubles(rows: Sequence[Row], units: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return heading and message of the cases without a result, not more than NAMED."""
    without = [row for row in rows if row["status"] != "converged"]
    without.sort(key=lambda row: int(row["case"]))
    named = [
        (
            f"case {row['case']}  {case_label(row['axes'], units)}  {row['status']}",
            one_line(row["message"]),
        )
        for row in without[:NAMED]
    ]
    more = len(without) - NAMED
    return [*named, (f"and {more} more, see {CSV}", "")] if more > 0 else named


def one_line(message: object) -> str:
    """Return a message without line ends."""
    return " ".join(str(message).split())


def in_words(starts: Sequence[int | None]) -> str:
    """Return what a case was started from: "zero", "case 3" or "cases 3, 7"; a "?" is a case that
    the sweep has no more."""
    numbers = ", ".join("?" if number is None else str(number) for number in starts)
    return f"case{'s' * (len(starts) > 1)} {numbers}" if starts else "zero"
