"""The table of a sweep as figures need it: columns without failed cases, lines, slices."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from porolub.io.words import Unit
from porolub.solve.report import Array
from porolub.study.figures.draw_quantities import FLUID_SHARE, Quantity, plain, suited
from porolub.study.work.label import axis_text
from porolub.study.work.table import Table, TableAxis

_LARGEST = 1e100  # what is larger, or one over it, drawing cannot count with

Mask = NDArray[np.bool_]
Rows = NDArray[np.intp]


@dataclass(frozen=True)
class Line:
    """Cases along one axis, the others fixed.

    ``rows``: of the view, (n,), by ascending value on the axis; ``name``: what is fixed, in words,
    "" where nothing is; ``fixed``: position on each of the other axes that vary.
    """

    rows: Rows
    name: str
    fixed: dict[int, int]


@dataclass(frozen=True)
class View:
    """Some of the rows of a table; all unless ``rows`` tells. Arrays are over those, (n,)."""

    table: Table
    rows: Rows
    name: str = ""
    """What the rows have in common, in words; "" for all."""

    @classmethod
    def of(cls, table: Table) -> View:
        """All of the table."""
        return cls(table, np.arange(len(table.columns["case"])))

    @property
    def axes(self) -> Sequence[TableAxis]:
        """The axes of the sweep."""
        return self.table.axes

    @property
    def title(self) -> str:
        """Title of the sweep and what the rows have in common."""
        return f"{self.table.title}, {self.name}" if self.name else self.table.title

    @cached_property
    def converged(self) -> Mask:
        """Which cases have results."""
        found: Mask = self._texts("status") == "converged"
        return found

    @cached_property
    def regime(self) -> NDArray[np.str_]:
        """Regime of each case, "" where it has none."""
        return np.where(self.converged, self._texts("regime"), "")

    @cached_property
    def sommerfeld(self) -> Array:
        """Sommerfeld number of each case; NaN where it has none."""
        values = self._numbers("sommerfeld_number")
        return np.where(values > 0, values, np.nan)

    def values(self, quantity: Quantity) -> Array:
        """Values of a quantity, SI; NaN of failed cases and where it is not defined."""
        columns = [self._numbers(column) for column in quantity.columns]
        if quantity is FLUID_SHARE:
            part, whole = columns
            return part / np.where(whole != 0, whole, np.nan)
        total: Array = np.sum(columns, axis=0)
        return total

    def unit(self, *quantities: Quantity, logarithmic: bool = False) -> Unit:
        """The unit that suits the values of quantities of one kind."""
        first = quantities[0]
        unit = "" if first is FLUID_SHARE else self.table.units.get(first.columns[0], "")
        return suited(unit, *map(self.values, quantities), logarithmic=logarithmic)

    @cached_property
    def positions(self) -> NDArray[np.intp]:
        """(n, axes) position of each case on the axes; the last axis is the fastest."""
        lengths = [length(axis) for axis in self.axes]
        cases = self.table.columns["case"][self.rows].astype(np.intp)
        return np.stack(np.unravel_index(cases, lengths), axis=-1)

    @cached_property
    def varied(self) -> list[int]:
        """The axes along which there are several cases."""
        return [k for k in range(len(self.axes)) if len(np.unique(self.positions[:, k])) > 1]

    @cached_property
    def numeric(self) -> list[int]:
        """Those of them that have numbers."""
        return [k for k in self.varied if self.axes[k].numbers is not None]

    def along(self, k: int) -> Array:
        """Value of each case on axis ``k``, SI; its position there where it has no numbers."""
        axis, places = self.axes[k], self.positions[:, k]
        if axis.numbers is None:
            return places.astype(float)
        values: Array = np.asarray(axis.numbers, float)[places]
        return values

    def lines(self, k: int) -> Iterator[Line]:
        """The cases along axis ``k``, one line for each combination of the others."""
        others = [j for j in self.varied if j != k]
        for where in sorted({tuple(row) for row in self.positions[:, others].tolist()}):
            found = np.flatnonzero((self.positions[:, others] == where).all(axis=1))
            found = found[np.argsort(self.along(k)[found], kind="stable")]
            fixed = dict(zip(others, where, strict=True))
            yield Line(found, self.words(fixed), fixed)

    def words(self, fixed: dict[int, int]) -> str:
        """Return what positions on some axes are called: ``speed = 1 rad/s, base = bonded``."""
        return ", ".join(self.value_on(k, place) for k, place in fixed.items())

    def axis_name(self, k: int) -> str:
        """Return what axis ``k`` is called in figures."""
        return plain(self.axes[k].name.replace("_", " "))

    def value_on(self, k: int, place: int) -> str:
        """Return what a position on axis ``k`` is called."""
        axis = self.axes[k]
        value = axis.texts[place] if axis.numbers is None else float(axis.numbers[place])
        return f"{self.axis_name(k)} = {plain(axis_text(value, axis.unit))}"

    def slices(self, kept: list[int]) -> list[View]:
        """One view for each combination of positions on the axes that are not ``kept``."""
        others = [j for j in self.varied if j not in kept]
        if not others:
            return [self]
        parts = []
        for where in sorted({tuple(row) for row in self.positions[:, others].tolist()}):
            mine = (self.positions[:, others] == where).all(axis=1)
            name = self.words(dict(zip(others, where, strict=True)))
            parts.append(View(self.table, self.rows[mine], name))
        return parts

    def _numbers(self, column: str) -> Array:
        """A column; NaN where there is none, or what is there is not finite or beyond sense."""
        found = self.table.columns.get(column)
        if found is None or found.dtype.kind not in "fiub":
            return np.full(len(self.rows), np.nan)
        values = found[self.rows].astype(float)
        values = np.where(np.abs(values) < 1 / _LARGEST, 0.0, values)
        return np.where(self.converged & (np.abs(values) < _LARGEST), values, np.nan)

    def _texts(self, column: str) -> NDArray[np.str_]:
        found = self.table.columns.get(column)
        if found is None:
            return np.full(len(self.rows), "", dtype="<U1")
        return np.asarray([str(value) for value in found[self.rows]], dtype=np.str_)


def length(axis: TableAxis) -> int:
    """Return the number of positions on an axis."""
    return len(axis.texts if axis.numbers is None else axis.numbers)
