"""Sweep files for tests: a base scene and a sweep of it, written into a directory."""

from pathlib import Path
from typing import Any

import tomli_w

from porolub.study.plan.cases import Case, cases_of
from porolub.study.plan.definition import Sweep
from porolub.study.plan.sweep_file import load_sweep
from tests.scene.scenes import ROLLING

Tables = dict[str, Any]


def write_sweep(directory: Path, *axes: Tables, base: Tables | None = None, **header: Any) -> Path:
    """Write scene.toml (ROLLING unless told otherwise) and sweep.toml; return the latter."""
    (directory / "scene.toml").write_text(tomli_w.dumps(ROLLING if base is None else base))
    path = directory / "sweep.toml"
    tables = {"sweep": {"scene": "scene.toml"} | header, "axis": list(axes)}
    path.write_text(tomli_w.dumps(tables))
    return path


def sweep_of(directory: Path, *axes: Tables, base: Tables | None = None, **header: Any) -> Sweep:
    """Return the sweep along these axes."""
    return load_sweep(write_sweep(directory, *axes, base=base, **header))


def cases_along(
    directory: Path, *axes: Tables, base: Tables | None = None, **header: Any
) -> list[Case]:
    """Return the cases along these axes."""
    return cases_of(sweep_of(directory, *axes, base=base, **header))


def linear(key: str, start: Any, to: Any, count: int) -> Tables:
    """An axis in equal steps."""
    return {"key": key, "linear": {"from": start, "to": to, "count": count}}


def log(key: str, start: Any, to: Any, count: int) -> Tables:
    """An axis in equal ratios."""
    return {"key": key, "log": {"from": start, "to": to, "count": count}}
