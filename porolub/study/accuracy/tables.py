"""What an accuracy study found, as tables for people, and what to do about it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from porolub.io.words import Unit, seconds
from porolub.study.accuracy.measured import Measured, Trial
from porolub.study.accuracy.recommend import Advice
from porolub.study.figures.draw_quantities import suited
from porolub.study.work.columns import units_of

if TYPE_CHECKING:
    from porolub.study.accuracy.study import Study

_BATCH = 110  # columns of a batch log


def print_accuracy(console: Console, study: Study, directory: Path) -> None:
    """Print a table for each quantity, then the cheapest settings."""
    widen(console)
    for found in study.found:
        console.print()
        console.print(accuracy_table(study, found))
        for line in remarks(study, found):
            console.print(Text(line), soft_wrap=True)
    console.print()
    for line in advice_lines(study):
        console.print(Text(line), soft_wrap=True)
    console.print()
    console.print(Text(f"Results in {directory}"), soft_wrap=True)


def widen(console: Console) -> None:
    """Let tables be wider than 80 columns where they do not go to a terminal."""
    if not console.is_terminal:
        console.width = max(console.width, _BATCH)


def accuracy_table(study: Study, found: Measured) -> Table:
    """Return the table of one quantity: a row a setting."""
    unit = suited(unit_of(found.quantity, study), found.values)
    stepped = any(t.steps > 0 for t in study.trials)
    estimated = bool((found.estimates >= 0).any())
    heading = found.quantity + (f" [{unit.name}]" if unit.name else "")
    table = Table(title=Text(heading, style="bold"), title_justify="left", title_style="",
                  box=box.SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0))  # fmt: skip
    table.add_column("strategy", no_wrap=True)
    names = [level_name(study.varied), "unknowns", *["steps"] * stepped, "value", "error", "order",
             *["estimate", "ratio"] * estimated, "time"]  # fmt: skip
    for name in names:
        table.add_column(name, justify="right", no_wrap=True)
    before = ""
    for n, trial in enumerate(study.trials):
        strategy = trial.setting.strategy
        if before and strategy != before:
            table.add_section()
        shown, before = ("" if strategy == before else strategy), strategy
        if not trial.converged:
            cells = [""] * (1 + stepped) + [trial.status] + [""] * (3 + 2 * estimated)
        else:
            cells = [f"{trial.unknowns:,.0f}", *[f"{trial.steps:,.0f}"] * stepped]
            cells += [*_numbers(found, n, unit, estimated), seconds(trial.wall)]
        table.add_row(shown, trial.setting.level, *cells)
    return table


def _numbers(found: Measured, n: int, unit: Unit, estimated: bool) -> list[str]:
    """Value, error, order and, where runs estimate their error, that."""
    value, order = found.values[n] / unit.size, found.orders[n]
    # enough digits to see the error
    cells = [f"{value:.6g}" if math.isfinite(value) else "-", error_text(found, n, unit),
             f"{order:.1f}" if math.isfinite(order) else ""]  # fmt: skip
    if estimated:
        estimate, error = found.estimates[n], found.errors[n]
        cells.append(_size(estimate, found, unit))
        told = math.isfinite(estimate) and error > found.uncertain
        cells.append(f"{estimate / error:.2g}" if told else "")
    return cells


def error_text(found: Measured, n: int, unit: Unit) -> str:
    """Write an error: ``0.15 %``; ``< 0.003 %`` where the limit is not known better."""
    error = found.errors[n]
    if math.isfinite(error) and error < found.uncertain:
        return f"< {_size(found.uncertain, found, unit)}"
    return _size(error, found, unit)


def _size(value: float, found: Measured, unit: Unit) -> str:
    if not math.isfinite(value):
        return "-"
    return percent(value) if found.relative else f"{value / unit.size:.2g} {unit.name}".rstrip()


def percent(value: float) -> str:
    """Write a relative error with two digits: ``12 %``, ``0.0031 %``; ``110 %``."""
    return f"{100 * value:.2g} %" if value < 0.995 else f"{100 * value:.0f} %"


def unit_of(quantity: str, study: Study) -> str:
    """Return the SI unit of a quantity; "" of a plain number."""
    name = quantity.partition(".")[0]
    in_space = any("contact_area" in t.summary for t in study.trials)
    return units_of([name, *["contact_area"] * in_space], ()).get(name, "")


def level_name(varied: Sequence[str]) -> str:
    """Return what the levels are: "mesh", "tolerance" or "mesh, tolerance"."""
    if not {"time", "tolerance"} & set(varied):
        return "mesh"
    return "mesh, tolerance" if "mesh" in varied else "tolerance"


def remarks(study: Study, found: Measured) -> Iterator[str]:
    """Yield sentences on the limit that errors are against."""
    unit = suited(unit_of(found.quantity, study), found.values)
    own = found.limits[found.source]
    how = f"order {own.order:.1f}" if own.order is not None else "no order seen, its finest level"
    limit = f"{found.limit / unit.size:.7g} {unit.name}".rstrip()
    if not math.isfinite(found.uncertain):
        yield f"errors against {limit}, the one value there is ({found.source})"
        return
    yield f"limit {limit} +- {_size(found.uncertain, found, unit)}, from {found.source} ({how})"
    if found.apart > found.uncertain:
        yield (
            f"the strategies do not agree on it: {_size(found.apart, found, unit)} lie between "
            "them beyond what they are uncertain by; more levels would tell"
        )


def advice_lines(study: Study) -> Iterator[str]:
    """Yield the cheapest settings, each as a command to copy."""
    if not study.found:
        yield "No run converged, so there is nothing to recommend."
        return
    names = [m.quantity for m in study.found if m.relative]
    yield f"Cheapest setting for {', '.join(names)}{' together' * (len(names) > 1)}:"
    for advice in study.advice:
        yield from _advice(study, advice)
    sides = study.side_by_side
    yield (
        "Times are of one rank each, from zero, files left out; "
        f"{sides} case{'s' * (sides > 1)} ran {'side by side' if sides > 1 else 'at a time'}."
    )


def _advice(study: Study, advice: Advice) -> Iterator[str]:
    target = f"{100 * advice.target:g} %"
    if advice.trial is None:
        least = "nothing is sure"
        if advice.error is not None:
            least = f"the least that is sure is {percent(advice.error)}"
        yield f"  {target:>6}: not reached; {least}"
        return
    trial: Trial = study.trials[advice.trial]
    assert advice.error is not None
    yield (
        f"  {target:>6}: {trial.setting.name}: {seconds(trial.wall)}, "
        f"error at most {percent(advice.error)}"
    )
    yield f"          {study.command(trial.setting)}"
