"""What each effect of a scene costs, as a table and as effects.csv."""

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from porolub.io.atomic import write_text
from porolub.io.summary import number
from porolub.io.words import seconds
from porolub.study.accuracy.tables import widen

CSV = "effects.csv"
_MS = 1e3
_COLUMNS = ("effects", "unknowns", "Newton", "time", "an iteration", "assembly", "linear solve")


@dataclass(frozen=True)
class Cost:
    """A scene and what it cost: times in s, NaN where it failed.

    ``wall``: from zero, files left out; ``each``: of a Newton iteration, ``assembly`` and
    ``linear_solve`` the parts of it, all means over the meshes of the sequence.
    """

    effects: str
    status: str
    unknowns: float = np.nan
    newton_iterations: float = np.nan
    wall: float = np.nan
    each: float = np.nan
    assembly: float = np.nan
    linear_solve: float = np.nan

    @property
    def converged(self) -> bool:
        """Whether there are results."""
        return self.status == "converged"


def costs(names: Sequence[str], rows: Sequence[Mapping[str, Any] | None]) -> list[Cost]:
    """Return the costs of scenes, from their names and rows of the journal; None: refused."""
    return [_cost(name, row) for name, row in zip(names, rows, strict=True)]


def _cost(name: str, row: Mapping[str, Any] | None) -> Cost:
    if row is None or row["status"] != "converged":
        return Cost(name, "refused" if row is None else row["status"])
    summary = row["summary"]
    times, newton = summary["wall_time"], number(summary, "newton_iterations") or np.nan

    def spent(key: str) -> float:
        return float(times.get(key) or 0.0)

    assembly, solve = spent("assembly") / newton, spent("linear_solve") / newton
    return Cost(name, row["status"], summary["dofs"]["total"], newton, spent("total"),
                assembly + solve, assembly, solve)  # fmt: skip


def print_effects(console: Console, found: Sequence[Cost], side_by_side: int, out: Path) -> None:
    """Print the table and what its times are."""
    widen(console)
    console.print()
    console.print(effects_table(found))
    how = "at a time" if side_by_side == 1 else "side by side"
    console.print(
        Text(
            "Wall times are of one rank each, from zero, files left out; those of an iteration are "
            f"means over the meshes of the sequence. Cases that ran {how}: {side_by_side}."
        ),
        soft_wrap=True,
    )
    console.print(Text(f"Results in {out}"), soft_wrap=True)


def effects_table(found: Sequence[Cost]) -> Table:
    """Return a table with a row for each step."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0))
    for name in _COLUMNS:
        table.add_column(name, justify="left" if name == "effects" else "right", no_wrap=True)
    for cost in found:
        if not cost.converged:
            table.add_row(cost.effects, cost.status)
            continue
        table.add_row(cost.effects, f"{cost.unknowns:,.0f}", f"{cost.newton_iterations:.0f}",
                      seconds(cost.wall), *map(_in_ms, (cost.each, cost.assembly,
                                                        cost.linear_solve)))  # fmt: skip
    return table


def _in_ms(value: float) -> str:
    return f"{_MS * value:,.3g} ms" if _MS * value < 1000 else seconds(value)


def write_effects(directory: Path, found: Sequence[Cost]) -> None:
    """Write effects.csv, times in s. Raises OSError."""
    text = io.StringIO()
    names = [field.name for field in fields(Cost)]
    writer = csv.DictWriter(text, names, lineterminator="\n")
    writer.writeheader()
    for cost in found:
        row = asdict(cost)
        writer.writerow({k: "" if v != v else v for k, v in row.items()})  # NaN: empty
    write_text(directory / CSV, text.getvalue())
