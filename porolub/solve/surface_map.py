"""The lubricated surface of a three-dimensional scene as a map: nodes, facets and what acts there.

Film flux: the flux the film's own equation transports (stabilisation included), projected from
the quadrature points onto the functions of the surface's vertices with a lumped mass, so that its
integral over the surface is kept; linear in between.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from porolub.fem.dofs import sum_at_nodes
from porolub.fem.points import GRAD, Integrand, Points
from porolub.solve.derived import Derived
from porolub.solve.report import SurfaceMap
from porolub.solve.surface_nodes import (
    columns_at_nodes,
    corners_of_facets,
    on_surface_nodes,
    to_root,
)

Array = NDArray[np.float64]
FACETS = {"hex": "quad", "tet": "triangle"}
SCALARS = ("s", "p", "p_c", "h", "V")


def surface_map(d: Derived) -> SurfaceMap | None:
    """SurfaceMap on rank 0, None elsewhere. Collective."""
    mesh, s = d.model.mesh, d.model.scales
    c = columns_at_nodes(d)
    flux = np.zeros((len(mesh.coordinates), 5))
    if d.film is not None:
        flux = on_surface_nodes(d, _film_flux(d)) * s.speed * s.length
    columns = np.hstack([mesh.coordinates * s.length, flux,
                         np.column_stack([c[name] for name in SCALARS])])
    found = to_root(mesh, d.mine, columns)
    facets = mesh.comm.gather(mesh.natural_node[mesh.facets(d.model.lubricated).nodes], root=0)
    if found is None:
        return None
    numbers, rows = found
    cells = np.searchsorted(numbers, np.vstack(facets))
    corners = np.sort(cells[:, : corners_of_facets(d)], axis=1)
    cells = cells[np.lexsort(corners.T[::-1])]  # an order that no partition changes
    return SurfaceMap(
        nodes=rows[:, :3], cells=cells, cell_type=FACETS[mesh.cell_type], degree=mesh.degree,
        Q=rows[:, 3:6], Q_s=rows[:, 6], Q_z=rows[:, 7],
        **dict(zip(SCALARS, rows[:, 8:].T, strict=True)))


def _film_flux(d: Derived) -> Array:
    """(nnode, 5) film flux at the surface's vertices: x, y, z, along s and along z (scaled)."""
    assert d.film is not None
    mesh, at = d.model.mesh, d.surface
    found = Integrand(jacobian=False)
    d.film.flow(at, found)
    Q = -found.f["p", GRAD]  # rows hold - flux . grad q
    along, aside = directions(at)
    five = np.concatenate([Q, (Q * along).sum(-1, keepdims=True),
                           (Q * aside).sum(-1, keepdims=True)], axis=-1)
    values = at.domain.tables(1).value[at.domain.variant]
    shares = np.einsum("eq,eqi,eqk->eik", at.weights, values,
                       np.concatenate([five, np.ones((*at.weights.shape, 1))], axis=-1))
    sums = np.zeros((len(mesh.coordinates), 6))
    np.add.at(sums, mesh.vertices_of_cells[at.domain.cells].ravel(), shares.reshape(-1, 6))
    total = sum_at_nodes(mesh, sums)
    out = np.zeros((len(total), 5))
    seen = total[:, 5] > 1e-12 * total[:, 5].max(initial=0.0)  # of cells' other vertices: rounding
    out[seen] = total[seen, :5] / total[seen, 5:]
    return out


def directions(at: Points) -> tuple[Array, Array]:
    """Unit vectors (ne, nq, 3) in the surface along s (no z, toward +x) and aside (toward +z).

    Where the surface looks in the direction of z they point along x and y.
    """
    n = at.normal
    along = np.cross([0.0, 0.0, 1.0], n)
    size = np.linalg.norm(along, axis=-1, keepdims=True)
    e_x = np.array([1.0, 0.0, 0.0])
    along = np.where(size > 1e-6, along / np.maximum(size, 1e-6), e_x - n[..., :1] * n)
    along = along * np.where(along[..., :1] < 0, -1.0, 1.0)
    aside = np.cross(along, n)
    towards = np.where(size > 1e-6, aside[..., 2:], aside[..., 1:2])
    return along, aside * np.where(towards < 0, -1.0, 1.0)
