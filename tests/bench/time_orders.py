"""Errors and orders of transient scenes against closed forms, as in the README.

    python -m tests.bench.time_orders

Order of BDF with fixed steps in a settled harmonic; orders in space of Terzaghi and Mandel; what a
tolerance gives with the program's own steps.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from tests.physics import consolidation as block
from tests.physics.mandel import Mandel
from tests.physics.stepped import Steps
from tests.physics.test_finite_strain_consolidation import crushed, off, time_unit
from tests.physics.test_harmonic_compression import error as harmonic_error
from tests.physics.test_mandel import run as mandel
from tests.physics.test_squeeze import ETA, LENGTH, plates
from tests.physics.test_terzaghi import errors as terzaghi_errors
from tests.physics.test_terzaghi import loaded

Array = NDArray[np.float64]
show = Console(width=110).print
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)


def with_orders(title: str, head: list[str], counts: tuple[int, ...], columns: list[Array]) -> None:
    """A row for each count: its errors, and under them the orders since the count before."""
    table = Table(title=title)
    for name in ["", *head]:
        table.add_column(name, justify="right")
    for k, n in enumerate(counts):
        cells = []
        for c in columns:
            order = f" ({np.log2(c[k - 1] / c[k]):.2f})" if k else ""
            cells.append(f"{c[k]:.2e}{order}")
        table.add_row(str(n), *cells)
    show(table)


def in_time() -> None:
    counts = (48, 96, 192)
    columns = [np.array([harmonic_error(order, n) for n in counts]) for order in (1, 2, 3)]
    with_orders("Harmonic compression, steps a period: error over amplitude (order)",
                ["BDF1", "BDF2", "BDF3"], counts, columns)


def in_space() -> None:
    counts = (4, 8, 16, 32)
    linear = np.array([terzaghi_errors(loaded(n, 0.1, 1, 3, 1e-6), 0.1) for n in counts])
    exact = Mandel(0.0).centre_pressure(0.1)[0]
    middle = [mandel(0.0, "contact", 0.1, n, 3, 1e-6).sight[-1, 0] for n in counts]
    with_orders("Q2-Q1, elements: Terzaghi (p, u) and Mandel (p in the middle) at T = 0.1",
                ["p", "u", "Mandel p"], counts,
                [linear[:, 0], linear[:, 1], np.abs(np.array(middle) / Mandel(0.0).p0 - exact)])
    quadratic = np.array([terzaghi_errors(loaded(n, 0.1, 2, 3, 1e-7), 0.1) for n in (2, 4, 8)])
    with_orders("Q2-Q2, elements: Terzaghi", ["p", "u"], (2, 4, 8), list(quadratic.T))


def terzaghi(tolerance: float, order: int) -> tuple[Steps, float]:
    run = loaded(32, 1.0, 1, order, tolerance)
    T = run["time"] / block.TAU
    off = np.abs(run.sight / block.SETTLED - block.degree_of_consolidation(T))
    return run, float(off[T > 0.01].max())


def mandel_plate(tolerance: float, order: int) -> tuple[Steps, float]:
    run = mandel(0.0, "contact", 0.5, 32, order, tolerance)
    T, p = run["time"] / Mandel(0.0).tau, run.sight[:, 0] / Mandel(0.0).p0
    return run, float(np.abs(p - Mandel(0.0).centre_pressure(T))[T > 0.01].max())


def finite(tolerance: float, order: int) -> tuple[Steps, float]:
    run = crushed(0.9, 0.5, 48, order=order, tolerance=tolerance)
    late = run["time"] > 1e-3 * time_unit(0.9)
    return run, float(off(run, 0.9, 0.5)[late].max())


def squeezed(tolerance: float, order: int) -> tuple[Steps, float]:
    run = plates({"force": "100 N/m"}, tolerance=tolerance, order=order, approach="-20 um")
    exact = 1.0 / np.sqrt(1.0 / 20e-6**2 + 200.0 * run["time"] / (ETA * LENGTH**3))
    return run, float(np.abs(-run["approach"] / exact - 1.0).max())


def by_tolerance() -> None:
    table = Table(title="Largest error over the run by time.tolerance (steps)")
    for name in ("scene", "order", *(f"{t:g}" for t in TOLERANCES)):
        table.add_column(name, justify="right")
    for name, case in (("Terzaghi, settlement", terzaghi), ("Mandel, p in the middle",
                       mandel_plate), ("crushed to 1/2, settlement", finite),
                       ("squeezed film, thickness", squeezed)):
        for order in (2, 3):
            runs = [case(tolerance, order) for tolerance in TOLERANCES]
            table.add_row(name, str(order), *(f"{e:.1e} ({r.steps})" for r, e in runs))
    show(table)


if __name__ == "__main__":
    in_time()
    in_space()
    by_tolerance()
