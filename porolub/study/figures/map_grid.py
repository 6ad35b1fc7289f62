"""Results of a sweep over two axes of numbers as a grid, and finer between its points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RegularGridInterpolator
from scipy.ndimage import distance_transform_edt

from porolub.io.words import Unit
from porolub.solve.report import Array
from porolub.study.figures.draw_quantities import suited
from porolub.study.figures.view import View
from porolub.study.work.regimes import REGIMES

_FINE = 400  # points along an axis; contours look smooth
_ROOM = (60.0, 11.0)  # height and width of a map in halves of a name's height and length
_ENOUGH = 0.6  # of a name may be inside of its region


@dataclass(frozen=True)
class Side:
    """An axis of a map: its values in ``unit``, ascending."""

    name: str
    unit: Unit
    values: Array
    logarithmic: bool

    def even(self, values: Array) -> Array:
        """Return where values lie on paper: their logarithms on a logarithmic axis."""
        return np.log10(values) if self.logarithmic else values

    def between(self) -> Array:
        """Return the values and such between them, all in all evenly spaced on paper."""
        even = self.even(self.values)
        fine: Array = np.union1d(even, np.linspace(even[0], even[-1], _FINE))
        return np.power(10.0, fine) if self.logarithmic else fine


@dataclass(frozen=True)
class Grid:
    """Two axes of a view; ``order``: (n, 2) place of each case along x and y."""

    x: Side
    y: Side
    order: NDArray[np.intp]

    @classmethod
    def of(cls, view: View, k: int, m: int) -> Grid:
        """The grid of a view over its axes ``k`` (to the right) and ``m`` (upward)."""
        sides, orders = [], []
        for axis in (k, m):
            side, order = _side(view, axis)
            sides.append(side)
            orders.append(order)
        return cls(sides[0], sides[1], np.stack(orders, axis=-1))

    def on_grid(self, values: Array) -> Array:
        """Return values of the cases as (y, x); NaN where there is no case."""
        found = np.full((len(self.y.values), len(self.x.values)), np.nan)
        found[self.order[:, 1], self.order[:, 0]] = values
        return found

    def finer(self, values: Array) -> tuple[Array, Array, Array]:
        """Return x (i,), y (j,) and values (j, i) between those of the cases, linear on paper.

        Next to a case without a value there is none.
        """
        x, y = self.x.between(), self.y.between()
        given = (self.y.even(self.y.values), self.x.even(self.x.values))
        table = RegularGridInterpolator(given, self.on_grid(values), bounds_error=False,
                                        fill_value=None)  # fmt: skip
        places = np.meshgrid(self.y.even(y), self.x.even(x), indexing="ij")
        # rounding must not reach over the rim, nor NaN times zero into the next interval
        inside = [np.clip(p, g[0], g[-1]) for p, g in zip(places, given, strict=True)]
        return x, y, table(np.stack(inside, axis=-1))


def _side(view: View, k: int) -> tuple[Side, NDArray[np.intp]]:
    axis = view.axes[k]
    numbers = np.asarray(axis.numbers, float)
    unit = suited(axis.unit, numbers, logarithmic=axis.scale == "log")
    ascending = np.argsort(numbers)
    side = Side(view.axis_name(k), unit, numbers[ascending] / unit.size, axis.scale == "log")
    return side, np.argsort(ascending)[view.positions[:, k]]


def regime_numbers(view: View) -> Array:
    """Return (n,) the place of each case's regime in REGIMES; NaN where it has none."""
    places = {regime: float(n) for n, regime in enumerate(REGIMES)}
    return np.array([places.get(regime, np.nan) for regime in view.regime.tolist()])


def roomiest(mask: NDArray[np.bool_]) -> tuple[int, int] | None:
    """Return the (row, column) in ``mask`` where a name has most room; None if it has too little.

    The mask is on places evenly spaced on paper.
    """
    room = [_ROOM[0] / mask.shape[0], _ROOM[1] / mask.shape[1]]
    away = distance_transform_edt(np.pad(mask, 1), sampling=room)[1:-1, 1:-1]
    row, column = np.unravel_index(int(np.argmax(away)), mask.shape)
    return (int(row), int(column)) if away[row, column] > _ENOUGH else None
