"""The package's C libraries, called through ctypes on NumPy arrays."""

from __future__ import annotations

import ctypes
import importlib.util
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porolub.errors import SolveError


def load(module: str) -> ctypes.CDLL:
    """The library that was built as this module. Raises SolveError if it was not."""
    spec = importlib.util.find_spec(module)
    if spec is None or spec.origin is None:
        raise SolveError(f"The compiled module {module} is missing: run 'pip install -e .' in the "
                         "checkout (it needs a C compiler).")
    return ctypes.CDLL(spec.origin)


def ptr(a: Any) -> Any:
    """Address of a C-contiguous array. Raises TypeError or ValueError for any other."""
    if a.flags.writeable and a.size:  # the buffer protocol is the quickest way to it
        return ctypes.byref(ctypes.c_char.from_buffer(a))
    if not a.flags.c_contiguous:
        raise ValueError("compiled functions take C-contiguous arrays")
    return ctypes.c_void_p(a.ctypes.data)


def contiguous(a: NDArray[np.float64]) -> NDArray[np.float64]:
    """The array itself, or a C-contiguous copy."""
    return a if a.flags.c_contiguous else np.ascontiguousarray(a)
