"""What a sweep file may hold, as pydantic models: the tables [sweep], [base] and [[axis]]."""

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from porolub.scene.base import Section, Whole, broken, refused

End = str | int | float
MOST_CASES = 100_000


def _keys(value: Any) -> Any:
    keys = (value,) if isinstance(value, str) else value
    if not isinstance(keys, list | tuple) or not keys or not all(map(_is_key, keys)):
        raise refused('a key of the scene is needed, such as "load.force", or an array of keys')
    if len(set(keys)) < len(keys):
        raise refused("each key may be named once only")
    return tuple(keys)


def _is_key(value: Any) -> bool:
    parts = value.split(".") if isinstance(value, str) else [""]
    return all(part and part == part.strip() for part in parts)


def _end(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise refused('a quantity is needed, such as "10 um", or a number')
    return value


def _pieces(value: Any) -> Any:
    if isinstance(value, dict):
        return (value,)
    if not isinstance(value, list | tuple) or not value:
        raise refused("a table {from = ..., to = ..., count = ...} is needed, or an array of such")
    return tuple(value)


def _axes(value: Any) -> Any:
    return (value,) if isinstance(value, dict) else value  # [axis] instead of [[axis]]


def _some(value: Any) -> Any:
    if not isinstance(value, list | tuple) or not value:
        raise refused("an array of values is needed, such as [1, 2, 5]")
    return tuple(value)


def _texts(value: Any) -> Any:
    if not isinstance(value, list | tuple) or not all(isinstance(v, str) for v in value):
        raise refused('an array of changes is needed, such as ["mesh.grading=contact"]')
    return tuple(value)


def _name(value: Any) -> Any:
    if not isinstance(value, str) or not value.strip() or not value.isprintable() or "/" in value:
        raise refused("a short text without / is needed")
    return value.strip()


class Piece(Section):
    """``count`` values ``from`` here ``to`` there, both included."""

    start: Annotated[Any, BeforeValidator(_end)] = Field(alias="from")
    to: Annotated[Any, BeforeValidator(_end)]
    count: Annotated[int, Field(ge=2, le=MOST_CASES), Whole]


class AxisTable(Section):
    """One [[axis]]: which keys it changes, and one of ``linear``, ``log`` and ``values``.

    ``scale`` says how ``values`` are spaced, for plots and starts: "linear" or "log"; left out,
    the values themselves tell. Several keys get the same value, or one each where an item of
    ``values`` is an array.
    """

    key: Annotated[tuple[str, ...], BeforeValidator(_keys)]
    name: Annotated[str, BeforeValidator(_name)] | None = None
    linear: Annotated[tuple[Piece, ...], BeforeValidator(_pieces)] = ()
    log: Annotated[tuple[Piece, ...], BeforeValidator(_pieces)] = ()
    values: Annotated[tuple[Any, ...], BeforeValidator(_some)] = ()
    scale: Literal["linear", "log"] | None = None

    @property
    def called(self) -> str:
        """The name, by default the last part of the first key."""
        return self.name or self.key[0].rpartition(".")[2]

    @model_validator(mode="after")
    def _one_of_three(self) -> Self:
        given = [key for key in ("linear", "log", "values") if getattr(self, key)]
        if len(given) != 1:
            got = " and ".join(given) or "none of them"
            raise broken(f"exactly one of linear, log and values is needed; given: {got}.")
        if self.scale is not None and given != ["values"]:
            raise broken(f"scale belongs to values; here it follows from {given[0]}.")
        return self


class Header(Section):
    """The table [sweep].

    ``scene``: the base scene, relative to this file; instead of it the file may have its tables
    under [base]. ``set``: changes to it, as after --set. ``start``: a case starts from its
    neighbours' results, or from zero. ``keep``: a row of the table for each case ("rows"), or a
    whole output directory ("results").
    """

    title: str = "untitled sweep"
    scene: str | None = None
    set: Annotated[tuple[str, ...], BeforeValidator(_texts)] = ()
    ranks_per_case: Annotated[int, Field(ge=1), Whole] = 1
    start: Literal["neighbour", "zero"] = "neighbour"
    keep: Literal["rows", "results"] = "rows"


class SweepFile(Section):
    """A sweep file, its form checked."""

    sweep: Header
    axis: Annotated[tuple[AxisTable, ...], BeforeValidator(_axes)] = ()
    base: dict[str, Any] | None = None

    @model_validator(mode="after")
    def _has_what_it_needs(self) -> Self:
        if (self.sweep.scene is None) == (self.base is None):
            given = "neither is given" if self.base is None else "both are given"
            raise broken(f"exactly one of sweep.scene and [base] is needed; {given}.")
        if not self.axis:
            raise broken("[[axis]] is missing: a sweep needs at least one.")
        return self
