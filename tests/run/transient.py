"""Small transient scenes, how their histories are compared, ways to stop a run at a chosen place.

A run is a deterministic sequence of steps: whatever the ranks and wherever it is stopped and
resumed, the steps must be the same ones.
"""

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from porolub.errors import Interrupted
from porolub.io.history import HistoryWriter, read_history
from porolub.run import run_scene
from porolub.scene import Scene, load_scene
from porolub.solve.newton import Newton
from tests.run.output import JOBS, Output

CASE2 = JOBS / "case2.toml"
SMALL = ["mesh.along=20", "mesh.across=2", "time.end=60 ms", "time.frames=100"]
"""Some twenty steps in half a second, with nodes that come into contact; a picture every 10 ms."""
KINKS = 'load={force={times=["0 s","20 ms","50 ms"],values=["1.5 kN/m","1.6 kN/m","1.55 kN/m"]}}'
"""In place of Case 2's harmonic: the slope of the load jumps twice."""

# How far two histories may be apart, relative to the largest value of a column. Measured: 3e-11 on
# other ranks and 3e-11 after a restart (2e-9 in tiny steps from rest). Rounding in a factorisation,
# times the condition of the matrix, decides; a step that is not the same one differs by far more.
SAME = 1e-7
# Balance errors are rounding themselves, so only their size counts.
BALANCES = {"mass_balance_error", "load_balance_error"}
BALANCED = 1e-6
COUNTED = {"order", "newton_iterations", "rejected_steps"}


def options(*overrides: str) -> list[str]:
    """Overrides as words of a command line."""
    return [word for override in (*SMALL, *overrides) for word in ("--set", override)]


def small(*overrides: str) -> Scene:
    """Case 2 on a small mesh for a short time."""
    return load_scene(CASE2, [*SMALL, *overrides])


def same_history(one: Path, other: Path) -> None:
    """Assert that two runs have taken the same steps to the same values."""
    a, b = (read_history(path / "history.csv") for path in (one, other))
    assert len(a["time"]) == len(b["time"]), f"{a['time']} and {b['time']}"
    assert list(a) == list(b)
    for name in a:
        if name in COUNTED:
            np.testing.assert_array_equal(b[name], a[name], err_msg=name)
        elif name in BALANCES:
            assert max(a[name].max(), b[name].max()) < BALANCED, name
        else:
            size = np.nanmax(np.abs(a[name]), initial=0.0)
            np.testing.assert_allclose(b[name], a[name], rtol=0, atol=SAME * size, err_msg=name)


def same_frames(one: Path, other: Path) -> None:
    """Assert that two runs have kept the same pictures."""
    names = [sorted(p.name for p in (path / "frames").iterdir()) for path in (one, other)]
    assert names[0] == names[1]


def no_remains(directory: Path) -> None:
    """Assert that nothing is left of files that were being written."""
    assert not list(directory.rglob(".*"))


def run(directory: Path, scene: Scene, petsc: str = "") -> Output:
    """Run a scene in this process, without a word."""
    assert run_scene(scene, directory, petsc, quiet=True) == 0
    return Output(directory, scene)


@contextmanager
def signalled(method: tuple[Any, str], count: int, number: int) -> Iterator[None]:
    """Send this process a signal when a method has returned for the ``count``-th time."""
    owner, name = method
    original, calls = getattr(owner, name), 0

    def counting(*arguments: Any) -> Any:
        nonlocal calls
        result = original(*arguments)
        calls += 1
        if calls == count:
            os.kill(os.getpid(), number)
        return result

    setattr(owner, name, counting)
    try:
        yield
    finally:
        setattr(owner, name, original)


ROW = (HistoryWriter, "write")
ITERATION = (Newton, "jacobian")


def stopped(directory: Path, scene: Scene, method: tuple[Any, str], count: int, petsc: str = "",
            number: int = signal.SIGTERM) -> None:
    """Run a scene until a signal stops it after so many rows or Newton iterations."""
    with signalled(method, count, number), pytest.raises(Interrupted) as caught:
        run_scene(scene, directory, petsc, quiet=True)
    assert str(caught.value).endswith(f"porolub restart {directory} goes on from there.")
