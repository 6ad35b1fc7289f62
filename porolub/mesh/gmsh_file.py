"""Writing a mesh through gmsh, as a .msh file with named boundaries that DMPlex reads."""

import signal
from pathlib import Path

import gmsh
import numpy as np

from porolub.mesh.cell import FACET_GMSH
from porolub.mesh.raw import RawMesh


def write_msh(raw: RawMesh, path: Path) -> None:
    """Write `raw` as binary MSH; boundary i in `raw.boundaries` gets the physical tag i + 1.

    The mesh goes in as discrete entities, so gmsh keeps positions and numbering to the bit.
    """
    dim = raw.cell.dim
    started = not gmsh.isInitialized()
    if started:
        listener = signal.getsignal(signal.SIGTERM)
        gmsh.initialize(interruptible=False, readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.model.add("porolub")
    try:
        gmsh.model.addDiscreteEntity(dim, 1)
        points = np.zeros((len(raw.points), 3))
        points[:, :dim] = raw.points
        gmsh.model.mesh.addNodes(dim, 1, np.arange(1, len(points) + 1), points.ravel())
        gmsh.model.mesh.addElementsByType(1, raw.cell.gmsh, [], raw.cells.ravel() + 1)
        gmsh.model.addPhysicalGroup(dim, [1], 1, "layer")
        for tag, (name, facets) in enumerate(raw.boundaries.items(), start=1):
            gmsh.model.addDiscreteEntity(dim - 1, tag)
            kind = FACET_GMSH[raw.cell.name]
            gmsh.model.mesh.addElementsByType(tag, kind, [], facets.ravel() + 1)
            gmsh.model.addPhysicalGroup(dim - 1, [tag], tag, name)
        gmsh.write(str(path))
    finally:
        gmsh.model.remove()
        if started:
            gmsh.finalize()
            # the PETSc inside gmsh has set it to its default: a run could not be stopped in order
            signal.signal(signal.SIGTERM, listener or signal.SIG_DFL)
