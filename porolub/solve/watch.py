"""Who is told what while a transient run goes on, and what it adds up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from porolub.solve.report import FrameData, NewtonRecord, Resume, StepRecord


def _ignore(*_: Any) -> None:
    """What nobody watches."""


@dataclass(frozen=True)
class Watch:
    """Who is told what, on all ranks but with data on rank 0 only (None elsewhere)."""

    newton: Callable[[NewtonRecord], None] = _ignore
    stage: Callable[[str, float], None] = _ignore
    begin: Callable[[float, float], None] = _ignore  # start, end (s)
    step: Callable[[StepRecord], None] = _ignore
    rejected: Callable[[float, float, str], None] = _ignore  # time, size (s), why
    frame: Callable[[FrameData], None] = _ignore
    checkpoint: Callable[[Callable[[], Resume]], None] = _ignore  # gathers when called


@dataclass
class Totals:
    """Running sums; scaled where they are volumes."""

    time_steps: int = 0
    rejected_steps: int = 0
    newton_iterations: int = 0
    linear_iterations: int = 0  # of the start, and of runs before a restart
    through: float = 0.0  # volume that has passed the boundaries or the surface
    content_start: float = 0.0
    content_swing: float = 0.0
    load_error: float = 0.0
    periods: int = 0
