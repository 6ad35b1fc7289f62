"""The part of ``porolub check`` that says what a scene will cost."""

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from porolub.scene.cost import Cost, Solving
from porolub.scene.describe import readable

RANKS = (1, 16, 128)
ACCURACY = "All within a factor of 2; a steady solve takes some 10 to 20 Newton steps."


def cost_table(cost: Cost, preset: str) -> RenderableType:
    """Return the table of expected costs; ``preset`` is the one that will be used."""
    table = Table(title="Expected cost", title_justify="left")
    table.add_column("linear solver")
    table.add_column("used")
    table.add_column("Newton step", justify="right")
    for ranks in RANKS:
        header = "memory, 1 rank" if ranks == 1 else f"each of {ranks} ranks"
        table.add_column(header, justify="right")
    for name, solving in (("direct", cost.direct), ("fieldsplit", cost.fieldsplit)):
        used = name == preset or (name == "fieldsplit" and preset == "nested")
        row = (preset, "[green]yes[/]") if used else (name, "no")
        table.add_row(*row, duration(solving.seconds), *_memory(solving))
    counts = f"{cost.unknowns:,} unknowns, matrix of {cost.entries:,} entries. {ACCURACY}"
    return Group(table, Text(counts))


def _memory(solving: Solving) -> list[str]:
    return [size(solving.memory_per_rank(ranks)) for ranks in RANKS]


def size(count: float) -> str:
    """Return bytes with two digits."""
    return readable(float(f"{count:.2g}"), "B")


def duration(seconds: float) -> str:
    """Return a time with two digits, in the unit that suits it."""
    seconds = float(f"{seconds:.2g}")
    if seconds < 120:
        return f"{seconds:.3g} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.3g} h"
