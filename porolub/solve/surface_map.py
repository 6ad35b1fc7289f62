"""The lubricated surface of a three-dimensional scene as a map: nodes, facets and what acts there.

Film flux: of what the film's own equation transports (stabilisation included) the mean over each
facet, which along a row of facets is the flux that is conserved, as in the profile of a plane
scene; the pointwise flux of a linear pressure in a film whose h^3 varies is not.  Nodes take the
mean of the facets around them, such that the integral over the surface is kept.
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
    to_root,
    weightless_corners,
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
        flux = _film_flux(d) * s.speed * s.length
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
    """(nnode, 5) film flux at the surface's nodes: x, y, z, along s and along z (scaled)."""
    assert d.film is not None
    mesh, at = d.model.mesh, d.surface
    found = Integrand(jacobian=False)
    d.film.flow(at, found)
    Q = -found.f["p", GRAD]  # rows hold - flux . grad q
    along, aside = directions(at)
    five = np.concatenate([Q, (Q * along).sum(-1, keepdims=True),
                           (Q * aside).sum(-1, keepdims=True)], axis=-1)
    area = at.weights.sum(axis=1)
    means = np.einsum("eq,eqk->ek", at.weights, five) / area[:, None]
    shares = _shares_of_nodes(d, area)[..., None]
    sums = np.zeros((len(mesh.coordinates), 6))
    np.add.at(sums, mesh.facets(d.model.lubricated).nodes,
              shares * np.column_stack([means, np.ones(len(means))])[:, None, :])
    total = sum_at_nodes(mesh, sums)
    return np.divide(total[:, :5], total[:, 5:], out=np.zeros((len(total), 5)),
                     where=total[:, 5:] > 0)


def _shares_of_nodes(d: Derived, area: Array) -> Array:
    """(nf, nn) integral of each facet's basis functions; of quadratic triangles, whose corners
    would get nothing, the same for all."""
    mesh, domain = d.model.mesh, d.surface.domain
    facets = mesh.facets(d.model.lubricated)
    if weightless_corners(d):
        return np.broadcast_to(area[:, None], facets.nodes.shape)
    values = domain.tables(mesh.degree).value[domain.variant]
    shares = np.einsum("eq,eqi->ei", domain.weights, values)
    own = mesh.cell.face_nodes(mesh.degree)[facets.local_face]
    taken: Array = np.take_along_axis(shares, own, axis=1)
    return taken


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
