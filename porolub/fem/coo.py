"""Matrix values without copies, through ctypes: petsc4py 3.18 does not wrap these functions."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.mesh import library
from porolub.mesh.library import check

Array = NDArray[np.float64]


@lru_cache(maxsize=1)
def petsc_library() -> ctypes.CDLL:
    """The PETSc library this process already uses, told what the functions below take."""
    lib = library.petsc_library()
    pointer = ctypes.c_void_p
    lib.MatMPIAIJGetSeqAIJ.argtypes = [pointer] * 4
    lib.MatSeqAIJGetArray.argtypes = [pointer, pointer]
    lib.MatSeqAIJRestoreArray.argtypes = [pointer, pointer]
    return lib


@contextmanager
def values_of(mat: PETSc.Mat, count: int) -> Iterator[Array]:
    """The stored values (count,) of a sequential AIJ matrix, row by row, to be written."""
    with _values(mat.handle, count) as values:
        yield values


@contextmanager
def values_of_rank(mat: PETSc.Mat, own: int, others: int) -> Iterator[tuple[Array, Array]]:
    """The stored values of this rank's rows of a parallel AIJ matrix, row by row, to be written:
    (own,) in columns of its own and (others,) in columns of other ranks."""
    parts = ctypes.c_void_p(), ctypes.c_void_p()
    check(petsc_library().MatMPIAIJGetSeqAIJ(mat.handle, *map(ctypes.byref, parts), None))
    with _values(parts[0].value, own) as first, _values(parts[1].value, others) as second:
        yield first, second
    mat.stateIncrease()


@contextmanager
def _values(handle: int | None, count: int) -> Iterator[Array]:
    pointer = ctypes.POINTER(ctypes.c_double)()
    check(petsc_library().MatSeqAIJGetArray(handle, ctypes.byref(pointer)))
    try:
        yield np.ctypeslib.as_array(pointer, (count,)) if count else np.empty(0)
    finally:
        check(petsc_library().MatSeqAIJRestoreArray(handle, ctypes.byref(pointer)))
