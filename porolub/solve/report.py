"""What a solve hands to the outside: plain arrays and numbers in SI.

Whatever grows with the volume (fields, states) lies on the ranks in blocks: each holds the rows of
a contiguous range of partition-independent numbers (porolub.solve.natural), one after the other;
on one rank that is all of it.  Surfaces and scalars are on rank 0.

No PETSc here, so writers and plots can be built and tested on these alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FieldData:
    """Fields on all nodes in partition-independent order, this rank's block of them (SI).

    nodes: (n, dim) reference positions, m; cells: (nc, nn) node numbers, VTK order, this rank's
    block of the cells;
    cell_type: quad | triangle | hex | tet, degree 1 or 2 (degree 2: quad9, triangle6, hex27, tet10)
    displacement: (n, dim) m; pressure: (n,) Pa or None; jacobian, von_mises: (n,);
    flux: (n, dim) Darcy flux in m/s or None.  A dry scene has no pressure and no flux; a rigid
    one has zero displacement and no von Mises stress.
    """

    nodes: Array
    cells: NDArray[np.int64]
    cell_type: str
    degree: int
    displacement: Array
    pressure: Array | None
    jacobian: Array
    von_mises: Array
    flux: Array | None


@dataclass(frozen=True)
class SurfaceData:
    """Profiles along the lubricated surface, sorted by arc position s (rank 0; SI).

    s from the middle (m), x (m), p pore pressure (Pa), p_c contact pressure (Pa), h film
    thickness (m), Q film flux per width (m^2/s), V flow out of the layer (m/s), at the
    displacement nodes; arrays of zeros where the scene lacks the effect.
    """

    s: Array
    x: Array
    p: Array
    p_c: Array
    h: Array
    Q: Array
    V: Array


@dataclass(frozen=True)
class SurfaceMap:
    """The lubricated surface of a three-dimensional scene (rank 0; SI), nodes in natural order.

    nodes: (n, 3) reference positions, m; cells: (nf, nn) facets by rows of ``nodes``, VTK order;
    cell_type: quad | triangle, degree 1 or 2; s: (n,) arc position from the middle, m; p, p_c, h,
    V: as in SurfaceData; Q: (n, 3) film flux per width, m^2/s; Q_s, Q_z: (n,) its components in
    the surface, along s and along z (or what of it is tangential).
    """

    nodes: Array
    cells: NDArray[np.int64]
    cell_type: str
    degree: int
    s: Array
    p: Array
    p_c: Array
    h: Array
    Q: Array
    Q_s: Array
    Q_z: Array
    V: Array

    @property
    def x(self) -> Array:
        return self.nodes[:, 0]

    @property
    def y(self) -> Array:
        return self.nodes[:, 1]

    @property
    def z(self) -> Array:
        return self.nodes[:, 2]


@dataclass(frozen=True)
class StepRecord:
    """One accepted step of the history (SI): time (s; 0 in a steady run) and by name

    - every scalar of the summary that makes sense per step,
    - in a transient run also ``time_step`` (s, that led here), ``order`` (of the BDF),
      ``newton_iterations`` and ``rejected_steps`` (of this step), ``speed`` (rad/s, or m/s of a
      sliding plane), ``load_applied`` (N/m or N), ``fluid_content`` (kg/m or kg: fluid in pores
      and film beyond what they held at the start) and ``fluid_gained`` (kg/m or kg: what entered
      through all boundaries since the start, summed as the time scheme sums).
    """

    time: float
    values: dict[str, float]


@dataclass(frozen=True)
class NewtonRecord:
    """One Newton iteration as shown to the user.

    stage: name of the continuation stage; fraction: of the target reached by this stage;
    residuals, updates: scaled norm by field; damping: accepted step length; load: current total
    load / target; elapsed: s since the start
    """

    stage: str
    fraction: float
    iteration: int
    residuals: dict[str, float]
    updates: dict[str, float]
    damping: float
    load: float
    elapsed: float


@dataclass(frozen=True)
class StateData:
    """The unknowns, partition independent, this rank's block of them (SI).

    fields: name -> (natural numbers of the nodes that carry it, ascending over the ranks, values
    (k, components)); scalars have no nodes and one row, on every rank; units: name -> unit;
    mesh_nodes: (n, dim) positions of the mesh's nodes, m, the block of ``natural.bounds``.
    """

    time: float
    fields: dict[str, tuple[NDArray[np.int64], Array]]
    units: dict[str, str]
    mesh_nodes: Array


@dataclass(frozen=True)
class Resume:
    """All a transient run needs to go on from where it stands (on every rank; SI).

    states: accepted states, newest first: as many as the time scheme looks back on, so that a
    resumed run continues with the same order and the same steps; orders: BDF order each of them
    was computed with; step: the next time step to try, s; frame: number of the next frame;
    edges: arc positions (m) the mesh was refined toward; totals: running sums by name
    (``time_steps``, ``newton_iterations``, ``wall_time``, balances, ...).
    """

    states: tuple[StateData, ...]
    orders: tuple[int, ...]
    step: float
    frame: int = 0
    edges: tuple[float, ...] = ()
    totals: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class FrameData:
    """What is kept of one moment of a transient run for pictures and animations (SI).

    fields are blocks on the ranks; surface is on rank 0, None elsewhere or where there is none.
    """

    number: int
    time: float
    fields: FieldData
    surface: SurfaceData | SurfaceMap | None


@dataclass(frozen=True)
class Report:
    """All results of a run.

    summary: the keys of summary.json (contract); surface is on rank 0 and None without a
    lubricated surface; fields and state are blocks on the ranks;
    newton: every iteration of the solve; history: accepted steps; state: the unknowns.
    """

    summary: dict[str, Any]
    fields: FieldData
    surface: SurfaceData | SurfaceMap | None
    newton: list[NewtonRecord] = field(default_factory=list)
    history: list[StepRecord] = field(default_factory=list)
    state: StateData | None = None
