"""Positions of the nodes between vertices on straight cells."""

import numpy as np
from numpy.typing import NDArray

from porolub.mesh.cell import Cell

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def add_middles(places: Array, cells: Index, cell: Cell) -> None:
    """Fill the rows of `places` beyond the vertices with the means of the vertices they join.

    The vertices are added in the order of their numbers: the same to the last bit from
    whichever of its cells, and so on all ranks, if the numbers follow the same order there.
    """
    column = cell.vertices
    for parents in cell.parents():
        nodes = cells[:, column : column + len(parents)]
        places[nodes] = places[np.sort(cells[:, parents], axis=2)].mean(axis=2)
        column += len(parents)
