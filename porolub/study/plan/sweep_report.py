"""What ``porolub check`` shows of a sweep: its axes, its cases, and what they will cost."""

from collections.abc import Mapping, Sequence
from textwrap import wrap

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from porolub.scene.cost_table import duration, size
from porolub.scene.describe import toml_value
from porolub.study.plan.amounts import amount
from porolub.study.plan.axis import Axis
from porolub.study.plan.cases import Case
from porolub.study.plan.definition import Sweep
from porolub.study.plan.sweep_cost import SweepCost, sweep_cost
from porolub.study.work.label import axis_text, case_label

FIRST = 3  # values shown of an axis before the dots, and refused cases named
WIDTH = 25  # of the column of values
HARD_SPACE = "\N{NO-BREAK SPACE}"  # holds number and unit together while lines are broken
_KEPT = {"rows": "a row of the table a case", "results": "an output directory a case, cases/NNNN"}


def report_sweep(sweep: Sweep, cases: Sequence[Case]) -> RenderableType:
    """Return the report on a sweep and its cases, to be printed with rich.

    Raises SceneError if a mesh file cannot be read.
    """
    units = {axis.name: axis.unit for axis in sweep.axes}
    parts: list[RenderableType] = [Text(sweep.title, style="bold")]
    parts += [Text(f"{name}: {value}") for name, value in _origin(sweep)]
    parts += ["", _axes_table(sweep.axes), "", *map(Text, _cases(cases, units))]
    cost = sweep_cost(cases, sweep.ranks_per_case)
    if cost is not None:
        parts += ["", _cost_table(cost, sweep)]
        parts.append(Text(_accuracy(cost)))
    return Group(*parts)


def _origin(sweep: Sweep) -> list[tuple[str, str]]:
    """Return base scene, changes to it and what is kept, each with its name."""
    found = [("base scene", str(sweep.scene))] if sweep.scene is not None else []
    changes = [("changed by", change) for change in sweep.set]
    return [*found, *changes, ("kept", _KEPT[sweep.keep])]


def _axes_table(axes: Sequence[Axis]) -> Table:
    table = Table(title="Axes", title_justify="left")
    table.add_column("axis")
    table.add_column("keys")
    table.add_column("positions")
    table.add_column("values")
    for axis in axes:
        spacing = "categories" if axis.numbers is None else axis.scale
        positions = f"{len(axis)}, {spacing}"
        if all(len(set(map(repr, values))) == 1 for values in axis.texts):
            table.add_row(axis.name, "\n".join(axis.keys), positions, _values(axis, 0))
            continue
        for column, key in enumerate(axis.keys):
            first = (axis.name, key, positions) if column == 0 else ("", key, "")
            table.add_row(*first, _values(axis, column))
    return table


def _values(axis: Axis, column: int) -> str:
    """Write the first values of one of the keys and the last one."""
    texts = [_plain(values[column]) for values in axis.texts]
    short = texts if len(texts) <= FIRST + 2 else [*texts[:FIRST], "...", texts[-1]]
    return "\n".join(wrap(", ".join(short), WIDTH)).replace(HARD_SPACE, " ")


def _plain(value: object) -> str:
    """Write a value shortly; where no line may break stands a hard space."""
    found = amount(value)
    if found is not None:
        return axis_text(found.number, found.kind.unit).replace(" ", HARD_SPACE)
    return value if isinstance(value, str) and value else toml_value(value)


def _cases(cases: Sequence[Case], units: Mapping[str, str]) -> list[str]:
    """Say how many cases there are, where they start from and which of them are refused."""
    refused = [case for case in cases if case.scene is None]
    warm = sum(bool(case.parents) for case in cases)
    cold = len(cases) - len(refused) - warm
    lines = [f"{_count(len(cases))}: {cold} from zero, {warm} from neighbours' results."]
    if refused:
        lines.append(f"Refused, each a row of the table with its message: {len(refused)}.")
    for case in refused[:FIRST]:
        where = case_label(case.axes, units)
        lines.append(f"  case {case.index}, {where}: {case.refusal.splitlines()[0]}")
    if len(refused) > FIRST:
        lines.append(f"  ... and {len(refused) - FIRST} more.")
    return lines


def _count(cases: int) -> str:
    return f"{cases:,} cases" if cases != 1 else "1 case"


def _cost_table(cost: SweepCost, sweep: Sweep) -> Table:
    ranks = sweep.ranks_per_case
    table = Table(title="Expected cost", title_justify="left", show_header=False)
    table.add_row("unknowns of a case", _range(*(f"{n:,}" for n in cost.unknowns)))
    table.add_row("linear solver", ", ".join(cost.presets))
    table.add_row("Newton step on 1 rank", _range(*map(duration, cost.step)))
    table.add_row("ranks per case", str(ranks))
    table.add_row("memory of a rank", size(cost.memory))
    for groups, times in cost.wall.items():
        label = f"all cases, {groups * ranks:,} rank" + ("s" if groups * ranks > 1 else "")
        table.add_row(label, _range(*map(duration, times)))
    return table


def _range(low: str, high: str) -> str:
    return low if low == high else f"{low} to {high}"


def _accuracy(cost: SweepCost) -> str:
    if not cost.wall:
        return "All within a factor of 2. Cases run through time: nobody can count their steps."
    return "All within a factor of 2; ranks that share a case make it faster than counted here."
