"""MatSetPreallocationCOO / MatSetValuesCOO, which petsc4py 3.18 does not wrap, through ctypes."""

from __future__ import annotations

import ctypes
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.errors import SolveError


@lru_cache(maxsize=1)
def _petsc() -> ctypes.CDLL:
    """The PETSc library this process already uses."""
    with open("/proc/self/maps", encoding="utf-8") as maps:
        paths = {line.split()[-1] for line in maps if "libpetsc" in line}
    if not paths:
        raise SolveError("PETSc's shared library is not loaded: is petsc4py installed?")
    lib = ctypes.CDLL(sorted(paths)[0])
    lib.MatSetPreallocationCOO.argtypes = [ctypes.c_void_p, ctypes.c_ssize_t, ctypes.c_void_p,
                                           ctypes.c_void_p]
    lib.MatSetValuesCOO.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int]
    return lib


def preallocate(mat: PETSc.Mat, rows: NDArray[np.int32], cols: NDArray[np.int32]) -> None:
    """Fix the pattern; entries with a negative row or column are ignored from then on."""
    rows = np.ascontiguousarray(rows, dtype=PETSc.IntType)
    cols = np.ascontiguousarray(cols, dtype=PETSc.IntType)
    error = _petsc().MatSetPreallocationCOO(mat.handle, len(rows), rows.ctypes.data,
                                            cols.ctypes.data)
    if error:
        raise PETSc.Error(error)


def insert(mat: PETSc.Mat, values: NDArray[np.float64]) -> None:
    """Set all values, in the order of the pattern; repeated entries are summed."""
    values = np.ascontiguousarray(values, dtype=np.float64)
    error = _petsc().MatSetValuesCOO(mat.handle, values.ctypes.data, int(PETSc.InsertMode.INSERT))
    if error:
        raise PETSc.Error(error)
