"""An axis of a sweep: which keys it changes, to what, and where its values lie as numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from porolub.errors import SceneError
from porolub.scene.describe import toml_value
from porolub.study.plan.amounts import Amount, amount
from porolub.study.plan.scene_keys import is_whole, parts_worlds
from porolub.study.plan.spacing import Scale, values_between
from porolub.study.plan.sweep_schema import AxisTable, Piece

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Axis:
    """``texts``: at each of n positions the values of the ``keys``, as a scene file has them.

    ``numbers``: the positions in the SI unit ``unit`` ("" for plain numbers), shape (n,), all
    different, in the order of the file; None if the axis is categorical. With several keys they
    are those of the first key that tells all positions apart. ``scale`` says how they are spaced.
    """

    name: str
    keys: tuple[str, ...]
    texts: tuple[tuple[Any, ...], ...]
    numbers: Floats | None = None
    unit: str = ""
    scale: Scale = "linear"

    def __len__(self) -> int:
        return len(self.texts)

    def values(self, position: int) -> dict[str, Any]:
        """Return the values at a position, by key."""
        return dict(zip(self.keys, self.texts[position], strict=True))

    def label(self, position: int) -> float | str:
        """Return the number at a position, SI, or the text of a category."""
        if self.numbers is not None:
            return float(self.numbers[position])
        return ", ".join(v if isinstance(v, str) else toml_value(v) for v in self.texts[position])

    @cached_property
    def coordinates(self) -> Floats | None:
        """Where the positions lie for their neighbours: numbers, or logarithms on a log scale.

        None if there are no neighbours along this axis.
        """
        if self.numbers is None or any(map(parts_worlds, self.keys)):
            return None
        return np.log(self.numbers) if self.scale == "log" else self.numbers


def axis_of(table: AxisTable) -> Axis:
    """Return the axis that a table of the sweep file describes.

    Raises SceneError, whose sentence leaves it to the caller to say which axis.
    """
    kind: Literal["linear", "log", "values"] = (
        "linear" if table.linear else "log" if table.log else "values"
    )
    if kind == "values":
        texts = tuple(_item(item, table.key) for item in table.values)
    else:
        whole = any(map(is_whole, table.key))
        pieces = table.linear or table.log
        texts = tuple((v,) * len(table.key) for v in _joined(pieces, kind, whole))
    _refuse_twice(texts)
    measured = _measured(texts)
    if measured is None:
        if table.scale is not None:
            raise SceneError(f"scale = {toml_value(table.scale)}: the values are no numbers")
        return Axis(table.called, table.key, texts)
    numbers, unit = measured
    scale = table.scale or (_scale_of(numbers) if kind == "values" else kind)
    if scale == "log" and numbers.min() <= 0:
        raise SceneError('scale = "log": all values must be greater than 0')
    return Axis(table.called, table.key, texts, numbers, unit, scale)


def _item(item: Any, keys: Sequence[str]) -> tuple[Any, ...]:
    """Return one value a key; an array has one for each of several keys."""
    if len(keys) == 1:
        return (item,)
    if not isinstance(item, list | tuple):
        return (item,) * len(keys)
    if len(item) != len(keys):
        raise SceneError(f"values = [..., {toml_value(item)}, ...]: {len(keys)} keys need as many")
    return tuple(item)


def _joined(pieces: Sequence[Piece], scale: Scale, whole: bool) -> list[Any]:
    """Return the values of all pieces; where one begins as the one before ends, once."""
    joined: list[Any] = []
    for piece in pieces:
        values = values_between(piece, scale, whole)
        same = joined and _number(joined[-1]) == _number(values[0])
        joined += values[1:] if same else values
    if len({found.kind for value in joined if (found := amount(value))}) > 1:
        raise SceneError("the pieces must be quantities of one kind")
    return joined


def _number(value: Any) -> float | None:
    found = amount(value)
    return found.number if found else None


def _refuse_twice(texts: Sequence[tuple[Any, ...]]) -> None:
    seen: dict[str, tuple[Any, ...]] = {}
    for values in texts:
        same = repr([(found.number, found.kind) if (found := amount(v)) else v for v in values])
        if same in seen:
            one, other = _shown(seen[same]), _shown(values)
            twice = f"{one} stands there twice" if one == other else f"{one} and {other} are equal"
            raise SceneError(f"values must differ, but {twice}")
        seen[same] = values


def _shown(values: tuple[Any, ...]) -> str:
    return toml_value(values[0] if len(set(map(repr, values))) == 1 else values)


def _measured(texts: Sequence[tuple[Any, ...]]) -> tuple[Floats, str] | None:
    """Return the numbers and their unit by the first key that tells the positions apart."""
    for values in zip(*texts, strict=True):
        found: list[Amount] = [a for v in values if (a := amount(v)) is not None]
        if len(found) < len(values) or len({a.kind for a in found}) > 1:
            continue
        numbers = np.array([a.number for a in found])
        if len(np.unique(numbers)) == len(numbers):
            numbers.setflags(write=False)
            return numbers, found[0].kind.unit
    return None


def _scale_of(numbers: Floats) -> Scale:
    """Return "log" where ratios are nearer to equal than differences."""
    if len(numbers) < 3 or numbers.min() <= 0:
        return "linear"

    def spread(steps: Floats) -> float:
        return float(np.std(steps) / np.mean(steps))

    ascending = np.sort(numbers)
    ratios, steps = np.diff(np.log(ascending)), np.diff(ascending)
    return "log" if spread(ratios) < spread(steps) else "linear"
