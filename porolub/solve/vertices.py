"""From quadratic to linear displacements: the coarse space of the first multigrid level.

A displacement that is linear between the vertices of the cells is one that is quadratic, so the
interpolation is exact and its Galerkin product is the matrix of linear elements: an eighth of
the unknowns in 3D, with a quarter of the couplings each.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.sparse import block_diag, csr_array, identity, kron

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
    """Interpolation of displacements from the vertices; ``held`` may change between solves."""

    def __init__(self, model: Model) -> None:
        dofs, mesh = model.dofs, model.mesh
        dim = mesh.dim
        self.dofs, self.dim = dofs, dim
        constraints = model.system.constraints
        frames = np.tile(np.eye(dim), (len(mesh.coordinates), 1, 1))
        frames[constraints.rotated] = constraints.frame
        every = kron(node_weights(model), identity(dim), format="csr")
        if len(constraints.rotated):
            turn = block_diag(frames, format="csr")
            size = dim * mesh.nvertices
            every = csr_array(turn.T @ every @ turn[:size, :size])
        self._weights = csr_array(every)
        where = dofs.base["u"]
        components = np.arange(dim)
        self._fine = (where[:, None] + components).ravel()  # local dof of each row
        self._coarse = (where[:mesh.nvertices, None] + components).ravel()  # and column
        self._own_rows = np.flatnonzero(dofs.owned[self._fine])
        order = np.argsort(dofs.global_numbers[self._fine[self._own_rows]])
        self._own_rows = self._own_rows[order]
        own = dofs.owned[self._coarse]
        comm = mesh.comm
        count = int(own.sum())
        start = comm.scan(count) - count
        numbers = np.full(dofs.size_local, -1.0)
        ranked = np.argsort(dofs.global_numbers[self._coarse[own]])
        mine = np.empty(count)
        mine[ranked] = start + np.arange(count)
        numbers[self._coarse[own]] = mine
        x = dofs.vector()
        x.array[:] = numbers[dofs.owned]
        self._numbers = dofs.to_local(x)[self._coarse].astype(PETSc.IntType)
        x.destroy()
        self.rows_of_vertices = np.searchsorted(
            dofs.global_numbers[self._fine[self._own_rows]],
            np.sort(dofs.global_numbers[self._coarse[own]]))
        self._sizes = (len(self._own_rows), PETSc.DETERMINE), (count, PETSc.DETERMINE)

    def interpolation(self, held: NDArray[np.bool_]) -> PETSc.Mat:
        """Matrix from vertex to node displacements, both in the frames they are stored in.

        ``held`` (owned displacement dofs): those that are given, each its own coarse unknown.
        Collective.
        """
        dofs = self.dofs
        marks = dofs.vector()
        local = np.zeros(dofs.size_local)
        where = np.arange(dofs.range["u"].start, dofs.range["u"].stop)
        local[where[dofs.owned[where]]] = held
        marks.array[:] = local[dofs.owned]
        local = dofs.to_local(marks)
        marks.destroy()
        P = self._weights[self._own_rows]
        fine, coarse = local[self._fine[self._own_rows]] > 0, local[self._coarse] > 0
        row = np.repeat(np.arange(P.shape[0]), np.diff(P.indptr))
        itself = self._fine[self._own_rows][row] == self._coarse[P.indices]
        keep = np.where(fine[row], itself, ~coarse[P.indices]) & (P.data != 0)
        indptr = np.concatenate([[0], np.cumsum(np.bincount(row[keep], minlength=P.shape[0]))])
        return PETSc.Mat().createAIJ(self._sizes, csr=(indptr.astype(PETSc.IntType),
                                                      self._numbers[P.indices[keep]],
                                                      P.data[keep]), comm=dofs.mesh.comm)
