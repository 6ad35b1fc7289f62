"""The matrix of the hard cases: case x criterion, ok or not, with the value or the reason.

    python -m tests.hard.matrix                       # all cases; --list names them
    python -m tests.hard.matrix --only permeability   # those whose group or name has the words
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from tests.hard.case import CRITERIA, Case, Verdict, Verdicts
from tests.hard.judge import Trial, compared, judged
from tests.hard.rows import all_cases

LONGEST = 60  # letters of a reason in the table; the rest is below it


def table_of(found: dict[str, Verdicts], title: str = "Hard cases") -> Table:
    """One row per case id."""
    shown = [c for c in CRITERIA if any(c in verdicts for verdicts in found.values())]
    table = Table("case", *shown, title=title)
    for name, verdicts in found.items():
        cells = (cell(verdicts[c]) if c in verdicts else Text("") for c in shown)
        table.add_row(name, *cells)
    return table


def cell(verdict: Verdict) -> Text:
    text = verdict.text
    if len(text) > LONGEST:
        text = text[:LONGEST - 3] + "..."
    return Text(text, style="" if verdict.ok else "bold red")


def print_matrix(console: Console, found: dict[str, Verdicts]) -> None:
    """The table, and below it in full whatever does not hold."""
    console.print(table_of(found))
    bad = {(case, c): v for case, verdicts in found.items() for c, v in verdicts.items()
           if not v.ok}
    held = sum(all(v.ok for v in verdicts.values()) for verdicts in found.values())
    console.print(f"{held} of {len(found)} cases hold.")
    for (case, criterion), verdict in bad.items():
        console.print(f"  {case}: {criterion}: {verdict.text}", markup=False, highlight=False)


def chosen(only: Iterable[str]) -> list[Case]:
    """Cases whose id has all the words of one of the texts; all cases without any."""
    wanted = [text.lower().split() for text in only]
    return [c for c in all_cases()
            if not wanted or any(all(w in c.id.lower() for w in words) for words in wanted)]


def run_case(case: Case, reference: bool = True) -> Verdicts:
    with tempfile.TemporaryDirectory() as place:
        trial = Trial(case, Path(place))
        verdicts = judged(trial)
        if reference and case.refined:
            verdicts |= compared(trial)
    return verdicts


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", action="append", default=[], metavar="WORDS",
                        help="cases whose group and name have all these words; may be repeated")
    parser.add_argument("--fast", action="store_true", help="without those marked slow")
    parser.add_argument("--no-reference", action="store_true", help="without the refined scenes")
    parser.add_argument("--list", action="store_true", help="names and statements only")
    asked = parser.parse_args(arguments)
    console = Console(width=None if sys.stdout.isatty() else 220)
    found: dict[str, Verdicts] = {}
    for case in chosen(asked.only):
        if asked.fast and case.slow:
            continue
        if asked.list:
            console.print(f"{case.id}: {case.stable}", markup=False, highlight=False)
            continue
        found[case.id] = run_case(case, not asked.no_reference)
        words = ", ".join(f"{c} {v.text}{'' if v.ok else ' (!)'}" for c, v in
                          found[case.id].items())
        console.print(f"{case.id}: {words}", markup=False, highlight=False)
    if found:
        print_matrix(console, found)
    return 0 if all(v.ok for verdicts in found.values() for v in verdicts.values()) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
