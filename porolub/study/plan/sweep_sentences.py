"""Turns what is wrong with a sweep file into sentences, as porolub.scene.sentences for scenes."""

import difflib
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from porolub.scene.describe import toml_value
from porolub.scene.sentences import MOST, NEEDED, expected, one_of
from porolub.study.plan.sweep_schema import AxisTable, Header, Piece, SweepFile

Loc = tuple[int | str, ...]


def sweep_sentences(error: ValidationError) -> str:
    """Return at most five sentences, one a line, then a count of the rest."""
    details = error.errors(include_url=False)
    lines = [line for detail in details for line in _sentence(detail).split("\n")]
    more = len(lines) - MOST
    return "\n".join(lines[:MOST] + ([f"... and {more} more."] if more > 0 else []))


def place(loc: Loc) -> str:
    """Return where a value stands: ``axis 2: linear.from`` or ``sweep.scene``."""
    parts = [f"no. {p + 1}" if isinstance(p, int) else p for p in loc]
    if loc[:1] == ("axis",) and len(loc) > 1:
        rest = ".".join(parts[2:]).replace(".no.", " no.")
        return f"axis {parts[1].removeprefix('no. ')}" + (f": {rest}" if rest else "")
    return ".".join(parts) if len(parts) > 1 else f"[{parts[0]}]" if parts else "the sweep file"


def _sentence(detail: ErrorDetails) -> str:
    loc, kind, ctx = detail["loc"], detail["type"], detail.get("ctx", {})
    key, value = place(loc), detail["input"]
    given = f"{key} = {toml_value(value)}"
    if kind == "rule":
        return (f"{key}: " if loc else "") + str(ctx["text"])
    if kind == "refused":
        return f"{given}: {ctx['reason']}."
    if kind == "missing":
        return f"{key} is missing."
    if kind == "extra_forbidden":
        return _unknown_key(loc, given if len(loc) > 1 else key)
    if kind == "literal_error":
        return f"{given}: {one_of(expected(ctx['expected']), value)}."
    if kind in ("greater_than_equal", "less_than_equal"):
        bound = f"at least {ctx['ge']}" if "ge" in ctx else f"at most {ctx['le']}"
        return f"{given}: the value must be {bound}."
    return f"{given}: {NEEDED.get(kind, detail['msg'])}."


def _unknown_key(loc: Loc, shown: str) -> str:
    model = _model(loc[:-1])
    allowed = [field.alias or name for name, field in model.model_fields.items()]
    near = difflib.get_close_matches(str(loc[-1]), allowed, 1)
    hint = f"did you mean {near[0]}?" if near else f"allowed are {', '.join(allowed)}."
    return f"{shown}: there is no such {'key' if len(loc) > 1 else 'section'}; {hint}"


def _model(loc: Loc) -> Any:
    """Return the model whose keys stand at ``loc``."""
    if not loc:
        return SweepFile
    if loc[0] == "sweep":
        return Header
    return Piece if len(loc) > 2 else AxisTable
