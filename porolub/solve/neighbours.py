"""Start from solutions of like scenes instead of from zero: a blend of them, carried to the mesh.

Solutions are kept in SI, for the scaled units follow the scene (a stiffer layer has a larger unit
of pressure).  Between two neighbours a blend is wrong by the square of their distance only, if
what is steep in them comes to lie at one place: where contact ends, a mean of two solutions would
be neither open nor closed.  So each is stretched along the surface until its edges are the blend's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.solve.gather import units_of
from porolub.solve.model import Model
from porolub.solve.transfer import Snapshot, restore, snapshot
from porolub.solve.zones import contact_edges, zones

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Solution:
    """A converged steady state in SI.

    length: of the lubricated surface, m; edges: arc positions (m) worth fine elements; marks: arc
    positions (m) by name of what a blend must not smear, contact's ends (if anything touches) and
    those of the pressurised zone.
    """

    data: Snapshot
    length: float
    edges: tuple[float, ...]
    marks: dict[str, float]

    @property
    def closed(self) -> bool:
        """Whether anything touches."""
        return "closed 0" in self.marks


@dataclass(frozen=True)
class Neighbour:
    """A solution to start from and its weight; those of all neighbours sum to 1."""

    solution: Solution
    weight: float


@dataclass(frozen=True)
class _Stretch:
    """Of the logical position along the surface, piecewise straight: ``old`` goes to ``new``."""

    old: Array
    new: Array

    @classmethod
    def of(cls, solution: Solution, marks: dict[str, float]) -> _Stretch:
        """Bring a solution's marks to where the blend has them (m)."""
        old, new = (np.array([0.0, *(places[k] / solution.length + 0.5 for k in marks), 1.0])
                    for places in (solution.marks, marks))
        return cls(old, new)

    def forth(self, along: Array) -> Array:
        return np.interp(along, self.old, self.new)

    def back(self, along: Array) -> Array:
        return np.interp(along, self.new, self.old)


def _resized(data: Snapshot, sizes: dict[str, float]) -> Snapshot:
    """All values times the size given for their field."""
    return replace(data, rows={k: rows * sizes[k] for k, rows in data.rows.items()},
                   scalars={k: value * sizes[k] for k, value in data.scalars.items()})


def solution_of(model: Model, x: PETSc.Vec) -> Solution:
    """Take up a state. Collective.

    ValueError for a mesh from a file: only structured ones can be carried to another.
    """
    sizes = {name: size for name, (size, _) in units_of(model).items()}
    length = model.scales.length
    marks = {f"{name} {k}": ends[k] * length for name, ends in zones(model, x) for k in range(2)}
    return Solution(_resized(snapshot(model, x), sizes), model.mesh.shape.length * length,
                    tuple(e * length for e in contact_edges(model, x)), marks)


def blended(model: Model, neighbours: Sequence[Neighbour]) -> PETSc.Vec:
    """The weighted mean of solutions on a model's mesh, its own conditions set. Collective.

    All are of one shape, on meshes of any size and grading.
    """
    sizes = {name: 1.0 / size for name, (size, _) in units_of(model).items()}
    used = alike(neighbours)
    marks = _marks(used)
    x = model.dofs.vector()
    for neighbour in used:
        solution = neighbour.solution
        data, stretch = _resized(solution.data, sizes), _Stretch.of(solution, marks)
        part = restore(model, replace(data, ticks=(stretch.forth(data.ticks[0]), *data.ticks[1:])))
        x.axpy(neighbour.weight, part)
        part.destroy()
        if "u" in model.dofs.fields and model.plane is not None:
            _add_shape(model, model.plane.toward, stretch, neighbour.weight, x)
    model.system.apply_conditions(x)
    return x


def _add_shape(model: Model, normal: Sequence[float], stretch: _Stretch, weight: float,
               x: PETSc.Vec) -> None:
    """Let the surfaces' places be averaged, not the displacements alone: x += weight times the
    height the stretched surface has above its own place, fading toward the bone.

    On a curved surface the two differ by the square of the shift over twice the radius, as much
    as a thin film is thick.
    """
    mesh, dofs = model.mesh, model.dofs
    n = np.asarray(normal)
    here = mesh.shape.logical(mesh.coordinates)
    across, here[:, 1] = here[:, 1].copy(), 1.0
    there = here.copy()
    there[:, 0] = stretch.back(here[:, 0])
    height = across * ((mesh.shape.physical(there) - mesh.shape.physical(here)) @ n)
    local = np.zeros(dofs.size_local)
    dofs.field("u", local)[...] = weight * height[dofs.nodes["u"], None] * n
    x.array[:] += model.system.stored(local)[dofs.owned]


def blended_edges(neighbours: Sequence[Neighbour]) -> tuple[float, ...]:
    """Arc positions (m) worth fine elements."""
    used = alike(neighbours)
    nearest = max(used, key=lambda n: n.weight).solution
    logical = np.array(nearest.edges) / nearest.length + 0.5
    stretch = _Stretch.of(nearest, _marks(used))
    return tuple((nearest.length * (stretch.forth(logical) - 0.5)).tolist())


def alike(neighbours: Sequence[Neighbour]) -> list[Neighbour]:
    """Those in which something touches if there are any, else all; their weights sum to 1.

    Where contact begins between two neighbours nothing lies halfway.
    """
    closed = [n for n in neighbours if n.solution.closed] or list(neighbours)
    total = sum(n.weight for n in closed)
    return [replace(n, weight=n.weight / total) for n in closed]


def _marks(used: Sequence[Neighbour]) -> dict[str, float]:
    """Where the blend's marks lie (m), in ascending order, as in all of its neighbours.

    Of two marks that coincide, or change places from one neighbour to the next, the later named is
    left out; so is one at an end of the surface: there is nothing between them to stretch.
    """
    chosen: list[str] = []
    for name in used[0].solution.marks:
        if all(name in n.solution.marks for n in used):
            trial = sorted([*chosen, name], key=lambda k: used[0].solution.marks[k])
            if all(_ascend(n.solution, trial) for n in used):
                chosen = trial
    return {k: sum(n.weight * n.solution.marks[k] for n in used) for k in chosen}


def _ascend(solution: Solution, names: Sequence[str]) -> bool:
    """Whether these marks lie one after the other between the ends of the surface."""
    end = solution.length / 2
    return all(a < b for a, b in pairwise([-end, *(solution.marks[k] for k in names), end]))
