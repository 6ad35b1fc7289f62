"""The history of a transient run as a table: at the end, and min, mean and max of a period."""

from collections.abc import Iterator

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from porolub.io.period import History, Span, choose, cut, full_periods, mean
from porolub.io.words import (
    KILOPASCAL,
    MICROMETRE,
    MILLIMETRE,
    ONE,
    Unit,
    digits,
    load_unit,
    mass_flow_unit,
    short_time,
)
from porolub.scene import Scene
from porolub.solve.periodic import difference_of_periods
from porolub.solve.report import Array, StepRecord

_PERCENT = Unit("%", 0.01)
_ROUNDING = 1e-10


def print_history_table(console: Console, history: History, scene: Scene) -> None:
    """Print what the columns of history.csv (SI, by name; ``time`` in s) come to.

    The last full period counts, or the whole run where nothing is periodic; means are over time.
    What the run does not have is left out.
    """
    console.print(history_table(history, scene))
    console.print()
    for line in _remarks(history, scene):
        console.print(Text(line), soft_wrap=True)
    console.print()


def history_table(history: History, scene: Scene) -> Table:
    """Return the table print_history_table prints."""
    span = choose(history, scene.period)
    table = Table(
        title=Text(_heading(span), style="bold"),
        title_justify="left",
        title_style="",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        padding=(0, 1, 0, 0),  # 80 columns hold the longest names and numbers
    )
    table.add_column("quantity", no_wrap=True)
    table.add_column("unit", style="dim", no_wrap=True)
    for name in ("at the end", "min", "mean", "max"):
        table.add_column(name, justify="right", no_wrap=True)
    data = cut(history, span)
    for label, unit, values in _quantities(data, scene.dimension):
        known = values[np.isfinite(values)]
        if not len(known):
            continue
        end = values[-1] if np.isfinite(values[-1]) else None
        cells = (end, known.min(), mean(data["time"], values), known.max())
        nothing = _ROUNDING * np.abs(known).max()
        table.add_row(label, unit.name, *(unit.digits(_clean(cell, nothing)) for cell in cells))
    return table


def _clean(value: float | None, nothing: float) -> float | None:
    """What is rounding beside the largest value is zero."""
    return 0.0 if value is not None and abs(value) < nothing else value


def _heading(span: Span) -> str:
    stretch = "the whole run" if span.period is None else f"period {span.period}"
    return f"Over {stretch}, {short_time(span.start)} to {short_time(span.end)}"


def _quantities(data: History, dimension: int) -> Iterator[tuple[str, Unit, Array]]:
    """Label, unit and values of what a row is made for, as far as the history has it."""
    load, flow = load_unit(dimension), mass_flow_unit(dimension)
    yield from _known(data, ONE, {"friction_coefficient": "friction coefficient"})
    rows = {"load_solid": "load by the solid", "load_fluid": "load by the fluid"}
    yield from _known(data, load, rows | {"load_total": "total load"})
    if "load_fluid" in data and "load_total" in data:
        total = np.where(data["load_total"] == 0, np.nan, data["load_total"])
        yield "fluid share", _PERCENT, data["load_fluid"] / total
    lengths = {"contact_length": "contact length", "penetration_length": "penetration length"}
    yield from _known(data, MILLIMETRE, lengths)
    yield from _known(data, MICROMETRE, {"approach": "approach", "film_min": "thinnest film"})
    yield from _known(
        data,
        flow,
        {
            "inflow_left": "inflow, left",
            "inflow_right": "inflow, right",
            "outflow_left": "outflow, left",
            "outflow_right": "outflow, right",
        },
    )
    yield from _known(
        data,
        KILOPASCAL,
        {
            "pressure_max": "peak fluid pressure",
            "pressure_min": "lowest fluid pressure",
            "contact_pressure_max": "peak contact pressure",
        },
    )


def _known(data: History, unit: Unit, rows: dict[str, str]) -> Iterator[tuple[str, Unit, Array]]:
    for key, label in rows.items():
        if key in data:
            yield label, unit, data[key]


def _remarks(history: History, scene: Scene) -> Iterator[str]:
    """Sentences on steps and periods."""
    steps = history.get("time_step", np.zeros(1))
    taken = np.nan_to_num(steps) > 0
    if taken.any():
        rejected = int(np.nansum(history.get("rejected_steps", np.zeros(1))))
        share = 100 * rejected / (taken.sum() + rejected)
        yield f"{taken.sum():,} steps accepted, {rejected:,} rejected ({share:.1f} %)"
        shortest, longest = short_time(steps[taken].min()), short_time(steps[taken].max())
        newton = np.nansum(history.get("newton_iterations", 0 * steps)[taken]) / taken.sum()
        per_step = f"{newton:.2f} Newton iterations a step, " if newton else ""
        yield f"{per_step}steps of {shortest} to {longest}"
    periods = full_periods(history, scene.period)
    if scene.period is None:
        return
    yield f"{len(periods)} full periods of {digits(scene.period)} s"
    if len(periods) > 1 and scene.time is not None:
        change = _change_of_last_period(history, scene.period, periods[-1] * scene.period)
        within = scene.time.repeats_within
        verdict = "it repeats" if change <= within else "it does not repeat yet"
        yield (
            f"the last period differs from the one before by {_percent(change)}: "
            f"{verdict} (to {_percent(within)})"
        )


def _percent(value: float) -> str:
    return f"{100 * value:.2g} %" if value < 0.995 else f"{100 * value:.0f} %"


def _change_of_last_period(history: History, period: float, end: float) -> float:
    """Relative difference of the two periods before ``end`` (s), as the run itself measures it."""
    data = cut(history, Span(float(history["time"][0]), end))
    complete = {name: values.tolist() for name, values in data.items() if np.isfinite(values).all()}
    times = complete.pop("time")
    records = [
        StepRecord(time, {name: values[i] for name, values in complete.items()})
        for i, time in enumerate(times)
    ]
    return difference_of_periods(records, period)
