"""Confined compression under a harmonic load: amplitude and phase, and orders in time.

u_top = -(s0/M) tanh(b h)/b, b = sqrt(i omega/c).  The load begins at t = 0 with a slope, which
leaves a transient; it dies out within TAU and is known, so it need not be waited for.  Once only
the harmonic is left, fixed steps show the order of the scheme.
"""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.physics import consolidation as block
from tests.physics.stepped import Steps, fixed, stepped

Array = NDArray[np.float64]


def sine(omega: float) -> dict[str, Any]:
    frequency = omega / (2.0 * np.pi)
    return {"mean": "0 Pa", "amplitude": f"{block.LOAD} Pa", "frequency": f"{frequency!r} Hz",
            "shape": "sine"}


def response(run: Steps, omega: float, begin: float) -> complex:
    """Complex settlement from all steps after `begin`, in s, m per exp(i omega t)."""
    late = run["time"] > begin
    t, down = run["time"][late], run.sight[late]
    down = down - block.start_of_harmonic(t, omega)
    waves = np.column_stack([np.sin(omega * t), np.cos(omega * t)])
    (real, imaginary), *_ = np.linalg.lstsq(waves, down, rcond=None)
    return complex(real, imaginary)


@pytest.mark.parametrize(("scaled", "tolerance", "within"), [
    (0.3, 1e-3, 3e-3), (1.0, 1e-3, 3e-3), (10.0, 1e-3, 5e-3), (100.0, 1e-3, 1e-2),
    (10.0, 1e-2, 2e-2), pytest.param(10.0, 1e-4, 1.5e-3, marks=pytest.mark.slow)])
def test_amplitude_and_phase(scaled: float, tolerance: float, within: float) -> None:
    """``scaled``: omega TAU."""
    omega = scaled / block.TAU
    period = 2.0 * np.pi / omega
    tables = block.column(24, 3.0 * period / block.TAU, sine(omega), degree=2,
                          tolerance=tolerance)
    run = stepped(tables, block.settlement)
    ratio = response(run, omega, period) / block.harmonic_response(omega)
    assert abs(ratio) == pytest.approx(1.0, abs=within)
    assert np.angle(ratio) == pytest.approx(0.0, abs=within)
    assert run.fluid_error() < 1e-10


SCALED = 10.0  # of the orders
PERIODS = 7  # the slowest transient is then exp(-2.5 * 4.4) times 0.04 of the answer


def error(order: int, count: int) -> float:
    """Largest error in the last of some periods of ``count`` equal steps, over the amplitude."""
    omega = SCALED / block.TAU
    period = 2.0 * np.pi / omega
    tables = block.column(32, PERIODS * period / block.TAU, sine(omega), degree=2, order=order)
    run = fixed(tables, PERIODS * count, look=block.settlement)
    last = run["time"] > (PERIODS - 1) * period
    t, steady = run["time"][last], block.harmonic_response(omega)
    exact = np.imag(steady * np.exp(1j * omega * t)) + block.start_of_harmonic(t, omega)
    return float(np.abs(run.sight[last] - exact).max() / abs(steady))


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2, 3])
def test_orders_in_time(order: int) -> None:
    errors = np.array([error(order, n) for n in (48, 96, 192)])
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(np.full(2, order), abs=0.1), errors


def gentle_settlement(t: Array, omega: float) -> Array:
    """Under LOAD (1 - cos(omega t)) from rest, m."""
    rate = (block.ROOTS**2 / block.TAU)[:, None]
    held = (rate * np.sin(omega * t) - omega * np.cos(omega * t) + omega * np.exp(-rate * t))
    held *= 2.0 * omega / (block.ROOTS[:, None] ** 2 * (rate**2 + omega**2))
    return block.SETTLED * (1.0 - np.cos(omega * t) - held.sum(axis=0))


@pytest.mark.parametrize(("order", "largest"), [(1, 0.02), (2, 2e-3), (3, 2e-4)])
def test_orders_from_rest(order: int, largest: float) -> None:
    """A load that begins with no slope: the half step of order 1 at the start costs no order.

    It begins like t^2 and the settlement under the drained top like t^2.5, so the first steps
    themselves err with order 2.5; the second half of the run is looked at.
    """
    omega = SCALED / block.TAU
    gentle = sine(omega) | {"mean": f"{block.LOAD} Pa", "amplitude": f"{-block.LOAD} Pa",
                            "shape": "cosine"}
    end = 2.0 * np.pi / SCALED
    errors = []
    for count in (48, 96):
        run = fixed(block.column(32, end, gentle, degree=2, order=order), count,
                    look=block.settlement)
        off = np.abs(run.sight - gentle_settlement(run["time"], omega))
        errors.append(off[run["time"] > end * block.TAU / 2.0].max() / block.SETTLED)
    assert np.log2(errors[0] / errors[1]) > order - 0.15, errors
    assert errors[0] < largest
