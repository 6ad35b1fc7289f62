"""PETSc's shared library, for the functions that petsc4py 3.18 does not wrap."""

import ctypes
from functools import lru_cache

from petsc4py import PETSc

from porolub.errors import SolveError


@lru_cache(maxsize=1)
def petsc_library() -> ctypes.CDLL:
    """The PETSc library this process already uses. Raises SolveError if there is none."""
    with open("/proc/self/maps", encoding="utf-8") as maps:
        paths = {line.split()[-1] for line in maps if "libpetsc" in line}
    if not paths:
        raise SolveError("PETSc's shared library is not loaded: is petsc4py installed?")
    return ctypes.CDLL(sorted(paths)[0])


def check(error: int) -> None:
    """Raise PETSc.Error unless a function of the library returned 0."""
    if error:
        raise PETSc.Error(error)
