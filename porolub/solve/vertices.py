"""From quadratic to linear displacements: the coarse space of the first multigrid level.

A displacement that is linear between the vertices of the cells is one that is quadratic, so the
interpolation is exact and its Galerkin product is the matrix of linear elements: an eighth of
the unknowns in 3D, with a quarter of the couplings each.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.sparse import bsr_array, csr_array, identity, kron

from porolub.solve.model import Model

Array = NDArray[np.float64]


def node_weights(model: Model) -> csr_array:
    """(nnode, nvertices) weights of the vertices in each node's place, of the rank's mesh."""
    mesh = model.mesh
    row, col, value = [np.arange(mesh.nvertices)], [np.arange(mesh.nvertices)], [
        np.ones(mesh.nvertices)]
    column = mesh.cell.vertices
    for parents in mesh.cell.parents():
        nodes = mesh.cells[:, column:column + len(parents)]
        column += len(parents)
        distinct, first = np.unique(nodes, return_index=True)
        corners = mesh.cells[:, parents].reshape(-1, parents.shape[1])[first]
        row.append(np.repeat(distinct, corners.shape[1]))
        col.append(corners.ravel())
        value.append(np.full(corners.size, 1.0 / corners.shape[1]))
    shape = (len(mesh.coordinates), mesh.nvertices)
    return csr_array((np.concatenate(value), (np.concatenate(row), np.concatenate(col))), shape)


class VertexSpace:
    """Interpolation of displacements from the vertices; ``held`` may change between solves.

    count: displacements of this rank's own vertices, the first of its own displacements.
    """

    def __init__(self, model: Model) -> None:
        dofs, mesh = model.dofs, model.mesh
        dim = mesh.dim
        self.dofs = dofs
        constraints = model.system.constraints
        weights = kron(node_weights(model), identity(dim), format="csr")
        size = dim * mesh.nvertices
        if len(constraints.rotated):
            count = len(mesh.coordinates)
            frames = np.tile(np.eye(dim), (count, 1, 1))
            frames[constraints.rotated] = constraints.frame
            turn = bsr_array((frames, np.arange(count), np.arange(count + 1))).tocsr()
            weights = turn.T @ weights @ turn[:size, :size]
        self._weights = csr_array(weights)
        # local dof of each row, node by node; the vertices come first, here and among the owned
        self._fine = (dofs.base["u"][:, None] + np.arange(dim)).ravel()
        self._coarse = self._fine[:size]
        self._own_rows = np.flatnonzero(dofs.owned[self._fine])
        own = dofs.owned[self._coarse]
        self.count = int(own.sum())
        start = mesh.comm.scan(self.count) - self.count
        numbers = np.zeros(dofs.size_local)
        numbers[self._coarse[own]] = start + np.arange(self.count)
        self._numbers = self._known_to_all(numbers)[self._coarse].astype(PETSc.IntType)
        self._sizes = (len(self._own_rows), PETSc.DETERMINE), (self.count, PETSc.DETERMINE)

    def _known_to_all(self, local: Array) -> Array:
        """Values per local dof with those of other ranks' dofs as their owners have them."""
        x = self.dofs.vector()
        x.array[:] = local[self.dofs.owned]
        known = self.dofs.to_local(x)
        x.destroy()
        return known

    def interpolation(self, held: NDArray[np.bool_]) -> PETSc.Mat:
        """Matrix from vertex to node displacements, both in the frames they are stored in.

        ``held`` (owned displacement dofs): those that are given, each its own coarse unknown.
        Collective.
        """
        dofs = self.dofs
        local = np.zeros(dofs.size_local)
        where = dofs.range["u"]
        local[where][dofs.owned[where]] = held
        local = self._known_to_all(local)
        P = self._weights[self._own_rows]
        fine, coarse = local[self._fine[self._own_rows]] > 0, local[self._coarse] > 0
        row = np.repeat(np.arange(P.shape[0]), np.diff(P.indptr))
        itself = self._fine[self._own_rows][row] == self._coarse[P.indices]
        keep = np.where(fine[row], itself, ~coarse[P.indices]) & (P.data != 0)
        indptr = np.concatenate([[0], np.cumsum(np.bincount(row[keep], minlength=P.shape[0]))])
        return PETSc.Mat().createAIJ(self._sizes, csr=(indptr.astype(PETSc.IntType),
                                                      self._numbers[P.indices[keep]],
                                                      P.data[keep]), comm=dofs.mesh.comm)
