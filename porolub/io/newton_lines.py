"""Newton iterations as aligned columns of text."""

from porolub.io.words import FIELDS, seconds
from porolub.solve.report import NewtonRecord

_WIDTH = 8  # with four fields a line fits into 80 columns


class NewtonLines:
    """Formats the iterations of a stage below one header; residuals are scaled norms."""

    def __init__(self) -> None:
        self._fields: tuple[str, ...] | None = None
        self._widths: list[int] = []

    def restart(self) -> None:
        """The next iteration needs a header again."""
        self._fields = None

    def header(self, record: NewtonRecord) -> str | None:
        """Return the header where one is due: at the start and when the fields change."""
        fields = tuple(record.residuals)
        if fields == self._fields:
            return None
        self._fields = fields
        names = [_heading(field) for field in fields]
        self._widths = [max(_WIDTH, len(name)) for name in names]
        cells = [f"{name:>{width}}" for name, width in zip(names, self._widths, strict=True)]
        tail = f"{'damping':>7}  {'load':>8}  {'elapsed':>10}"
        return "  ".join([f"{'it':>4}", *cells, tail])

    def row(self, record: NewtonRecord) -> str:
        """Return the line of an iteration; ``header`` has been asked for it before."""
        values = record.residuals.values()
        cells = [f"{v:>{width}.1e}" for v, width in zip(values, self._widths, strict=True)]
        load = "-" if record.load != record.load else f"{100 * record.load:.2f} %"
        tail = f"{record.damping:>7.3g}  {load:>8}  {seconds(record.elapsed):>10}"
        return "  ".join([f"{record.iteration:>4}", *cells, tail])

    def updates(self, record: NewtonRecord) -> str:
        """Return the updates by field, for the log."""
        parts = [f"{field} {value:.2e}" for field, value in record.updates.items()]
        return f"  updates: {', '.join(parts)}" if parts else ""


def _heading(field: str) -> str:
    """Short name of a field's residual."""
    short = {
        "displacement": "solid",
        "fluid pressure": "fluid",
        "pore pressure": "fluid",
        "volume change": "volume",
        "film pressure": "film",
        "contact pressure": "contact",
        "approach": "balance",
    }
    return short.get(FIELDS.get(field, field), field)
