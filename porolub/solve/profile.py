"""Profiles along the lubricated surface of a two-dimensional scene."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from porolub.solve.derived import Derived
from porolub.solve.report import SurfaceData
from porolub.solve.surface_nodes import columns_at_nodes, to_root

Array = NDArray[np.float64]


def profile(d: Derived) -> SurfaceData | None:
    """SurfaceData on rank 0, None elsewhere. Collective."""
    model, mesh, s = d.model, d.model.mesh, d.model.scales
    c = columns_at_nodes(d)
    c |= {"x": mesh.coordinates[:, 0] * s.length, "Q": np.zeros(len(mesh.coordinates))}
    if d.film is not None:
        c["Q"] = _film_rows(d) * s.volume_flow
    columns = np.column_stack([c[name] for name in ("s", "x", "p", "p_c", "h", "Q", "V")])
    carries = np.zeros((len(columns), 1))
    carries[model.dofs.nodes["p"] if "p" in model.dofs.fields else []] = 1.0
    found = to_root(mesh, d.mine, np.hstack([columns, carries]))
    if found is None:
        return None
    _, rows = found
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    if d.film is not None:
        _rows_to_flux(rows, rows[:, 7] > 0)
    return SurfaceData(*rows[:, :7].T)


def _film_rows(d: Derived) -> Array:
    """(nnode,) the film's share of the fluid mass rows, summed over ranks (scaled)."""
    model = d.model
    out = np.zeros(len(model.mesh.coordinates))
    r = model.dofs.sum_local(model.system.local_residual(d.local, {"film"}))
    nodes = np.intersect1d(d.nodes, model.dofs.nodes["p"])
    out[nodes] = r[model.dofs.base["p"][nodes]]
    return out


def _rows_to_flux(rows: Array, carries: NDArray[np.bool_]) -> None:
    """Turn column 5 of rows in the order of s from film rows into film flux, in place.

    Row i of a linear film is Q right of node i minus Q left of it, so the running sum is the
    conservative mean flux of each element: what the scheme itself transports.
    """
    flux = np.cumsum(rows[carries, 5])[:-1]  # mean flux between neighbouring pressure nodes
    s = rows[carries, 0]
    centres = (s[1:] + s[:-1]) / 2.0
    rows[:, 5] = np.interp(rows[:, 0], centres, flux)
