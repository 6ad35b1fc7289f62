"""Nodal values on the lubricated surface: interpolated to where they have none, and gathered."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porolub.fem.dofs import sum_at_nodes
from porolub.solve.derived import Derived

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def columns_at_nodes(d: Derived) -> dict[str, Array]:
    """s, p, p_c, h and V (nnode,) in SI at the nodes of the surface; 0 without the effect."""
    model, s = d.model, d.model.scales
    zero = np.zeros(len(model.mesh.coordinates))
    out = {"s": d.arc() * s.length, "p": zero, "p_c": zero, "h": d.thickness() * s.length,
           "V": zero}
    if "p" in model.dofs.fields:
        pair = np.column_stack([d.nodal("p")[:, 0], d.exchange()])
        if model.dofs.fields["p"].degree < model.mesh.degree:
            pair = on_surface_nodes(d, pair)
        elif weightless_corners(d):
            pair[:, 1:] = at_corners(d, pair[:, 1:])
        out |= {"p": pair[:, 0] * s.pressure, "V": pair[:, 1] * s.speed}
    if "l" in model.dofs.fields:
        pressure = d.contact_pressure()
        if weightless_corners(d):
            pressure = at_corners(d, pressure[:, None])[:, 0]
        out["p_c"] = pressure * s.pressure
    return out


def on_surface_nodes(d: Derived, vertex_values: Array) -> Array:
    """(nnode, k) values given at the surface's vertices, interpolated to its other nodes."""
    mesh = d.model.mesh
    nodes = mesh.facets(d.model.lubricated).nodes
    out = vertex_values.copy()
    if mesh.degree == 1:
        return out
    corners = corners_of_facets(d)
    around = nodes[:, :corners]
    for k in range(corners if mesh.dim == 3 else 1):
        pair = around[:, [k, (k + 1) % corners]]
        out[nodes[:, corners + k]] = vertex_values[pair].mean(axis=1)
    if mesh.dim == 3 and mesh.cell_type == "hex":
        out[nodes[:, 8]] = vertex_values[around].mean(axis=1)
    return _complete(d, nodes, out)


def corners_of_facets(d: Derived) -> int:
    """Vertices of a facet, which come first among its nodes."""
    mesh = d.model.mesh
    return 2 if mesh.dim == 2 else (4 if mesh.cell_type == "hex" else 3)


def weightless_corners(d: Derived) -> bool:
    """Whether facets are quadratic triangles: nodal quadrature does not see their corners."""
    return d.model.mesh.cell_type == "tet" and d.model.mesh.degree == 2


def at_corners(d: Derived, values: Array) -> Array:
    """(nnode, k) values known at the middles of the sides of quadratic triangles, with the mean
    of the sides that meet in a corner there."""
    mesh = d.model.mesh
    nodes = mesh.facets(d.model.lubricated).nodes
    k = values.shape[1]
    shares = np.zeros((len(values), k + 1))
    for corner in range(3):
        sides = nodes[:, [3 + corner, 3 + (corner + 2) % 3]]
        given = np.column_stack([values[sides].mean(axis=1), np.ones(len(nodes))])
        np.add.at(shares, nodes[:, corner], given)
    total = sum_at_nodes(mesh, shares)
    out = values.copy()
    corners = total[:, k] > 0
    out[corners] = total[corners, :k] / total[corners, k:]
    return out


def to_root(mesh: Any, mine: Index, values: Array) -> tuple[Index, Array] | None:
    """Natural numbers, ascending, and rows of nodes from the ranks that own them, on rank 0."""
    parts = mesh.comm.gather((mesh.natural_node[mine], values[mine]), root=0)
    if parts is None:
        return None
    numbers, rows = np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])
    order = np.argsort(numbers)
    return numbers[order], rows[order]


def _complete(d: Derived, nodes: Index, values: Array) -> Array:
    """Let ranks that own a surface node but none of its facets know its value."""
    mesh = d.model.mesh
    k = values.shape[1]
    known = np.zeros((len(values), k + 1))
    seen = np.unique(nodes)
    known[seen, :k], known[seen, k] = values[seen], 1.0
    total = sum_at_nodes(mesh, known)
    return total[:, :k] / np.maximum(total[:, k:], 1.0)
