"""Small sweeps that are really computed, in this process or others, and what they left on disk."""

import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from typer.testing import CliRunner, Result

from porolub.cli import app
from porolub.study.work.table import Table, comparable, read_table
from tests.run.output import JOBS
from tests.study.sweeps import Tables, linear, log

SMALL = ["mesh.along=24", "mesh.across=3"]
"""Case 1 in less than 0.1 s."""
SPEEDS = log("motion.speed", "0.1 rad/s", "1 rad/s", 2)
FORCES = log("load.force", "300 N/m", "2 kN/m", 3)
CLI = "from porolub.cli import main; main()"
PLOTS = "porolub.study.sweep.plot_sweep"


def sweep_file(directory: Path, *axes: Tables, job: str = "case1", **header: Any) -> Path:
    """Write a sweep of a shipped scene; speeds times forces unless told otherwise: 6 cases."""
    path = directory / "sweep.toml"
    tables = {"sweep": {"scene": str(JOBS / f"{job}.toml"), "set": SMALL} | header,
              "axis": list(axes or (SPEEDS, FORCES))}  # fmt: skip
    path.write_text(tomli_w.dumps(tables))
    return path


def forces(count: int) -> Tables:
    """One axis only."""
    return linear("load.force", "300 N/m", "1.5 kN/m", count)


def sweep(file: Path, out: Path, *words: str, quiet: bool = True) -> Result:
    """`porolub sweep` in this process."""
    words = ("sweep", str(file), "--out", str(out), *words, *(["--quiet"] if quiet else []))
    return CliRunner().invoke(app, [*words])


def computed(file: Path, out: Path) -> Table:
    """The table of an uninterrupted sweep."""
    result = sweep(file, out)
    assert (result.exit_code, result.output) == (0, "")
    return read_table(out)


def started(script: Path, *words: object, cwd: Path) -> "subprocess.Popen[str]":
    """A script in a process of its own; use as a context."""
    return subprocess.Popen(
        [sys.executable, str(script), *map(str, words)], cwd=cwd, text=True,
        env={**os.environ, "PYTHONPATH": str(JOBS.parent)},
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip


def journal(directory: Path) -> list[dict[str, Any]]:
    """The whole lines of a journal, in order of time; none where there is no journal."""
    path = directory / "journal.jsonl"
    lines = path.read_text().split("\n")[:-1] if path.exists() else []
    return [json.loads(line) for line in lines]


def computed_once(*directories: Path) -> None:
    """Assert that no case has more than one row, in any journal."""
    found = Counter(row["key"] for directory in directories for row in journal(directory))
    assert max(found.values()) == 1, found


def same_table(found: Table, expected: Table, but: tuple[str, ...] = ()) -> None:
    """Assert that two tables are the same to the last bit, clock and machine aside."""
    a, b = (comparable(table) for table in (found, expected))
    assert list(a) == list(b)
    for name in [name for name in b if name not in but]:
        np.testing.assert_array_equal(a[name], b[name], err_msg=name)


def no_remains(directory: Path) -> None:
    """Assert that nothing is left of files that were being written, nor start states."""
    assert {path.name for path in directory.rglob(".*")} <= {".lock", ".case"}
    assert not (directory / "states").exists()
