"""Versions of everything a result depends on."""

import sys

import porolub


def versions() -> dict[str, str]:
    """Return the versions of Python, porolub and the libraries; ``missing`` if not importable."""

    def petsc() -> str:
        from petsc4py import PETSc

        return ".".join(str(part) for part in PETSc.Sys.getVersion())

    def module(name: str) -> str:
        return str(__import__(name).__version__)

    found = {"python": sys.version.split()[0], "porolub": porolub.__version__}
    for name in ("numpy", "petsc", "petsc4py", "mpi4py", "gmsh", "h5py", "meshio"):
        try:
            found[name] = petsc() if name == "petsc" else module(name)
        except ImportError:
            found[name] = "missing"
    return found
