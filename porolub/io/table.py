"""The results of a run as a tribologist reads them, and beside the printed ones."""

from collections.abc import Iterator, Mapping
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from porolub.io.printed import Printed
from porolub.io.summary import number
from porolub.io.words import (
    FIELDS,
    KILOPASCAL,
    MEGABYTE,
    MICROMETRE,
    MILLIMETRE,
    SQUARE_MILLIMETRE,
    Unit,
    digits,
    load_unit,
    mass_flow_unit,
    seconds,
)
from porolub.scene import Scene
from porolub.scene.derived import surface_speed
from porolub.solve.doubts import VACUUM

Row = tuple[str, str, str]
Summary = dict[str, Any]


ESTIMATED = {
    "friction_coefficient": "friction",
    "load_fluid": "load by the fluid",
    "load_total": "load",
    "approach": "approach",
    "contact_length": "contact length",
    "pressure_max": "highest fluid pressure",
}
"""Numbers whose estimated errors are shown, and what they are called there."""
ROUNDING = 1e-9
"""Relative; what is prescribed has no more error than that."""


def print_results(console: Console, summary: Summary, scene: Scene) -> None:
    """Print the summary of a run (SI) in the units of the trade; what it lacks is left out."""
    console.print(results_table(summary, scene))


def results_table(summary: Summary, scene: Scene) -> Table:
    """Return the table print_results prints: quantity, value, remark."""
    title = Text(scene.title, style="bold")
    if summary.get("message"):
        title.append(f"\n{summary['message']}", style="not bold")
    for warning in summary.get("warnings") or ():
        title.append(f"\n{warning}", style="not bold yellow")
    table = Table(
        title=title,
        title_justify="left",
        title_style="",
        box=box.SIMPLE_HEAD,
        show_header=False,
        pad_edge=False,
    )
    table.add_column("quantity")
    table.add_column("value", justify="right", no_wrap=True)
    table.add_column("remark", style="dim", overflow="fold")
    sections = (
        ("Load", _load(summary, scene.dimension)),
        ("Contact", _contact(summary)),
        ("Fluid exchange", _exchange(summary, scene.dimension)),
        ("Layer", _layer(summary)),
        ("Checks", _checks(summary)),
        ("Cost", _cost(summary)),
    )
    for name, rows in sections:
        shown = list(rows)
        if not shown:
            continue
        if table.row_count:
            table.add_section()
        table.add_row(f"[bold]{name}[/]", "", "")
        for label, value, remark in shown:
            table.add_row(f"  {label}", value, Text(remark))
    return table


def _simple(
    summary: Summary, unit: Unit, rows: Mapping[str, str], remark: str = ""
) -> Iterator[Row]:
    """Rows of those keys that have a number, all in one unit."""
    for key, label in rows.items():
        value = number(summary, key)
        if value is not None:
            yield label, unit.text(value), remark


def _load(summary: Summary, dimension: int) -> Iterator[Row]:
    unit = load_unit(dimension)
    total = number(summary, "load_total")
    for key, label in (("load_solid", "by the solid"), ("load_fluid", "by the fluid")):
        value = number(summary, key)
        if value is not None:
            share = f"{100 * value / total:.1f} % of the load" if total else ""
            yield label, unit.text(value), share
    yield from _simple(summary, unit, {"load_total": "total"})
    yield from _simple(summary, Unit("", 1.0), {"load_ratio": "fluid to solid"})
    friction, fluid = number(summary, "friction_coefficient"), number(summary, "friction_fluid")
    if friction is not None:
        remark = "" if fluid is None else f"{digits(fluid)} from the film"
        yield "friction coefficient", digits(friction), remark


def _contact(summary: Summary) -> Iterator[Row]:
    approach = number(summary, "approach")
    if approach is not None:
        remark = "the plane is pressed in" if approach > 0 else "the plane stands off"
        yield "approach", MICROMETRE.text(approach), remark if approach else ""
    yield from _simple(summary, SQUARE_MILLIMETRE, {"contact_area": "contact area"})
    length = number(summary, "contact_length")
    if length is not None:
        left, right = number(summary, "contact_left"), number(summary, "contact_right")
        known = length > 0 and left is not None and right is not None
        ends = f"from {MILLIMETRE.digits(left)} to {MILLIMETRE.text(right)}" if known else ""
        yield "contact length", MILLIMETRE.text(length), ends if length else "no contact"
    yield from _simple(summary, MILLIMETRE, {"contact_width": "contact width"}, "along z")
    yield from _simple(
        summary, MILLIMETRE, {"penetration_length": "penetration length"}, "from the geometry alone"
    )
    yield from _simple(summary, MICROMETRE, {"film_min": "thinnest film"})


def _exchange(summary: Summary, dimension: int) -> Iterator[Row]:
    unit = mass_flow_unit(dimension)
    for key, label in (("inflow", "into the layer"), ("outflow", "out of the layer")):
        left, right = number(summary, f"{key}_left"), number(summary, f"{key}_right")
        if left is not None and right is not None:
            remark = f"left {unit.digits(left)}, right {unit.digits(right)}"
            yield label, unit.text(left + right), remark


def _layer(summary: Summary) -> Iterator[Row]:
    lowest, highest = number(summary, "pressure_min"), number(summary, "pressure_max")
    if highest is not None:
        remark = "" if lowest is None else f"lowest {KILOPASCAL.text(lowest)}"
        if lowest is not None and lowest < VACUUM:
            remark += ": below vacuum"
        yield "highest fluid pressure", KILOPASCAL.text(highest), remark
    yield from _simple(
        summary,
        KILOPASCAL,
        {
            "contact_pressure_max": "highest contact pressure",
            "von_mises_max": "highest von Mises stress",
        },
    )
    volume = number(summary, "jacobian_min")
    if volume is not None:
        yield "lowest volume ratio J", f"{volume:.4f}", ""


def _checks(summary: Summary) -> Iterator[Row]:
    for key, label in (("load_balance_error", "load"), ("mass_balance_error", "fluid mass")):
        value = number(summary, key)
        if value is not None:
            yield f"{label} balance error", f"{value:.1e}", "relative"
    yield from _estimated(summary)


def _estimated(summary: Summary) -> Iterator[Row]:
    """Estimated errors of the main numbers, largest first; those a scene prescribes have none."""
    errors = summary.get("error_estimate") or {}
    found = {}
    for key, label in ESTIMATED.items():
        value, error = number(summary, key), number(errors, key)
        if value and error is not None and error > ROUNDING * abs(value):
            found[label] = error / abs(value)
    largest_first = sorted(found, key=lambda label: -found[label])
    shown = [f"{label} {_percent(found[label])} %" for label in largest_first]
    if shown:
        first, _, size = shown[0].rpartition(" ")[0].rpartition(" ")
        yield "error, estimated", f"{size} %", ", ".join([first, *shown[1:]])
    elif summary.get("status") == "converged" and not errors:
        yield "error, estimated", "unknown", "no solution on coarser meshes to compare with"


def _percent(share: float) -> str:
    return f"{100 * share:.2g}" if share < 1.0 else f"{100 * share:.0f}"


def _cost(summary: Summary) -> Iterator[Row]:
    dofs = summary.get("dofs") or {}
    if dofs:
        parts = [f"{FIELDS.get(key, key)} {n:,}" for key, n in dofs.items() if key != "total"]
        total = dofs.get("total", sum(dofs.values()))
        yield "unknowns", f"{total:,}", ", ".join(parts)
    newton, linear = number(summary, "newton_iterations"), number(summary, "linear_iterations")
    if newton is not None:
        remark = "" if linear is None else f"{linear:,.0f} linear iterations"
        yield "Newton iterations", f"{newton:,.0f}", remark
    times = summary.get("wall_time") or {}
    total = number(times, "total")
    if total is not None:
        parts = [
            f"{key.replace('_', ' ')} {seconds(value)}"
            for key in times
            if key != "total" and (value := number(times, key)) is not None
        ]
        yield "wall time", seconds(total), ", ".join(parts)
    memory, ranks = number(summary, "peak_memory"), number(summary, "ranks")
    if memory is not None:
        remark = f"{ranks:.0f} rank{'s' if ranks > 1 else ''}" if ranks else ""
        yield "peak memory", f"{memory / MEGABYTE.size:,.0f} MB", remark


def print_comparison(
    console: Console, summary: Summary, reference: Mapping[str, Printed], scene: Scene
) -> None:
    """Print ours beside the printed numbers (see porolub.io.printed) with the difference in %."""
    console.print(comparison_table(summary, reference, scene))


def comparison_table(summary: Summary, reference: Mapping[str, Printed], scene: Scene) -> Table:
    """Return the table print_comparison prints; a dash where the run has no such number."""
    known = summary | {"sommerfeld": _sommerfeld(summary, scene)}
    table = Table(
        title=Text("Beside the reference paper", style="bold"),
        title_justify="left",
        title_style="",
        box=box.SIMPLE_HEAD,
        pad_edge=False,
    )
    table.add_column("quantity", no_wrap=True)
    table.add_column("unit")
    for name in ("porolub", "printed", "difference"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("printed in", style="dim")
    for symbol, entry in reference.items():
        parts = [number(known, key) for key in entry.keys]
        ours = None if None in parts else sum(part for part in parts if part is not None)
        difference = "-" if ours is None else f"{100 * (ours / entry.value - 1):+z.1f} %"
        table.add_row(
            f"{entry.label} {symbol}",
            entry.unit.name,
            entry.unit.digits(ours),
            f"{entry.value / entry.unit.size:g}",
            difference,
            entry.source,
        )
    return table


def _sommerfeld(summary: Summary, scene: Scene) -> float | None:
    """eta U / L with the viscosity of the film, U at t = 0 and the load that was reached."""
    speed, load = surface_speed(scene), number(summary, "load_total")
    if scene.film is None or speed is None or not load:
        return None
    return scene.film.viscosity * speed / load
