"""An axis of a sweep whose positions are called by names of their own."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from porolub.study.plan.axis import Axis


@dataclass(frozen=True, eq=False)
class NamedAxis(Axis):
    """Categories: ``names`` instead of the texts of their values, one a position."""

    names: tuple[str, ...] = ()

    def label(self, position: int) -> float | str:
        """Return the name of a position."""
        return self.names[position]


def named_axis(name: str, values: Mapping[str, Mapping[str, Any]]) -> NamedAxis:
    """Return the axis whose positions have these values, by name of the position and by key.

    All positions have the same keys.
    """
    positions: Sequence[Mapping[str, Any]] = list(values.values())
    keys = tuple(positions[0])
    texts = tuple(tuple(position[key] for key in keys) for position in positions)
    return NamedAxis(name, keys, texts, names=tuple(values))
