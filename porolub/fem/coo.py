"""Matrix values without copies: MatSetValuesCOO and MatSeqAIJGetArray through ctypes.

petsc4py 3.18 wraps neither.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.errors import SolveError

Array = NDArray[np.float64]


@lru_cache(maxsize=1)
def petsc_library() -> ctypes.CDLL:
    """The PETSc library this process already uses."""
    with open("/proc/self/maps", encoding="utf-8") as maps:
        paths = {line.split()[-1] for line in maps if "libpetsc" in line}
    if not paths:
        raise SolveError("PETSc's shared library is not loaded: is petsc4py installed?")
    lib = ctypes.CDLL(sorted(paths)[0])
    pointer = ctypes.c_void_p
    lib.MatSetPreallocationCOO.argtypes = [pointer, ctypes.c_ssize_t, pointer, pointer]
    lib.MatSetValuesCOO.argtypes = [pointer, pointer, ctypes.c_int]
    lib.MatSeqAIJGetArray.argtypes = [pointer, pointer]
    lib.MatSeqAIJRestoreArray.argtypes = [pointer, pointer]
    return lib


def _check(error: int) -> None:
    if error:
        raise PETSc.Error(error)


def preallocate(mat: PETSc.Mat, rows: NDArray[np.int32], cols: NDArray[np.int32]) -> None:
    """Fix the pattern; entries with a negative row or column are ignored from then on."""
    rows = np.ascontiguousarray(rows, dtype=PETSc.IntType)
    cols = np.ascontiguousarray(cols, dtype=PETSc.IntType)
    _check(petsc_library().MatSetPreallocationCOO(mat.handle, len(rows), rows.ctypes.data,
                                                  cols.ctypes.data))


def insert(mat: PETSc.Mat, values: Array) -> None:
    """Set all values, in the order of the pattern; repeated entries are summed."""
    values = np.ascontiguousarray(values, dtype=np.float64)
    _check(petsc_library().MatSetValuesCOO(mat.handle, values.ctypes.data,
                                           int(PETSc.InsertMode.INSERT)))


@contextmanager
def values_of(mat: PETSc.Mat, count: int) -> Iterator[Array]:
    """The stored values (count,) of a sequential AIJ matrix, row by row, to be written."""
    pointer = ctypes.POINTER(ctypes.c_double)()
    _check(petsc_library().MatSeqAIJGetArray(mat.handle, ctypes.byref(pointer)))
    try:
        yield np.ctypeslib.as_array(pointer, (count,))
    finally:
        _check(petsc_library().MatSeqAIJRestoreArray(mat.handle, ctypes.byref(pointer)))
