"""A journal keeps what was noted, whatever happens to the process or the disk."""

import errno
import json
import math
import os
import resource
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from porolub.errors import SceneError, SolveError
from porolub.study.work.journal import Journal, read_rows, rows_of


def row(key: str, **more: Any) -> dict[str, Any]:
    return {"key": key, "status": "converged"} | more


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "journal.jsonl"


def test_the_newest_row_of_a_key_counts(path: Path) -> None:
    journal = Journal(path)
    for name, wall in (("a", 1.0), ("b", 2.0), ("a", 3.0)):
        journal.append(row(name, wall=wall))
    assert {key: r["wall"] for key, r in read_rows(path).items()} == {"a": 3.0, "b": 2.0}
    assert len(path.read_text().splitlines()) == 3


def test_a_sweep_that_has_not_begun_has_no_rows(path: Path) -> None:
    assert read_rows(path) == {}
    assert rows_of(path.parent) == {}


def test_numbers_survive(path: Path) -> None:
    values = {
        "nan": math.nan,
        "inf": np.float64(-math.inf),
        "none": None,
        "single": np.float32(0.25),
        "whole": np.int64(7),
        "array": np.array([1.5, math.inf]),
        "pair": (1, 2),
        "awkward": 1 / 3,
        "text": 'µm "quoted"\nsecond line \udcff',
    }
    Journal(path).append(row("a", summary=values))
    found = read_rows(path)["a"]["summary"]
    assert math.isnan(found.pop("nan"))
    assert found == {
        "inf": -math.inf,
        "none": None,
        "single": 0.25,
        "whole": 7,
        "array": [1.5, math.inf],
        "pair": [1, 2],
        "awkward": 1 / 3,
        "text": values["text"],
    }
    with pytest.raises(TypeError, match="a journal has no place for set"):
        Journal(path).append(row("b", found={1}))
    assert list(read_rows(path)) == ["a"]


def test_a_torn_last_line_is_passed_over_and_cut_off(path: Path) -> None:
    """Wherever the write was cut short, down to nothing or up to the line's end."""
    journal = Journal(path)
    journal.append(row("a"))
    kept = path.read_bytes()
    journal.append(row("b", message="is torn"))
    whole = path.read_bytes()
    for length in range(len(kept), len(whole)):
        path.write_bytes(whole[:length])
        assert list(read_rows(path)) == ["a"]
        Journal(path).append(row("c"))
        assert path.read_bytes().startswith(kept + b'{"key": "c"')
        assert list(read_rows(path)) == ["a", "c"]


@pytest.mark.parametrize("rest", [b"\0" * 40, b"\0" * 40 + b"\n", b"\xff{\n", b"[]\n"])
def test_what_a_loss_of_power_leaves_is_cut_off(path: Path, rest: bytes) -> None:
    Journal(path).append(row("a"))
    kept = path.read_bytes()
    path.write_bytes(kept + rest)
    assert list(read_rows(path)) == ["a"]
    Journal(path).append(row("b"))
    assert path.read_bytes() == kept + json.dumps(row("b")).encode() + b"\n"


def test_nothing_but_a_torn_line_is_an_empty_journal(path: Path) -> None:
    path.write_bytes(b'{"key": "a", ')
    assert read_rows(path) == {}
    Journal(path).append(row("b"))
    assert list(read_rows(path)) == ["b"]


@pytest.mark.parametrize("line", ["garbage", '{"status": "failed"}', "[1, 2]", ""])
def test_a_damaged_line_in_the_middle_is_named(path: Path, line: str) -> None:
    good = json.dumps(row("a"))
    path.write_text(f"{good}\n{line}\n{good}\n")
    with pytest.raises(SceneError, match=r"journal\.jsonl, line 2: this is no row of a sweep"):
        read_rows(path)


def test_a_journal_that_cannot_be_read_is_a_sentence(path: Path) -> None:
    path.mkdir()
    with pytest.raises(SceneError, match=r"journal\.jsonl: this file cannot be read"):
        read_rows(path)


@contextmanager
def room_for(size: int) -> Iterator[None]:
    """Let no file of this process grow beyond ``size`` bytes: the kernel cuts writes short."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.parametrize("room", [0, 20])
def test_a_full_disk_costs_the_row_that_does_not_fit(path: Path, room: int) -> None:
    journal = Journal(path)
    journal.append(row("a"))
    kept = path.read_bytes()
    with room_for(len(kept) + room):
        for _ in range(2):
            with pytest.raises(SolveError) as caught:
                journal.append(row("b"))
            assert path.read_bytes() == kept
    assert str(caught.value).startswith(f"{path}: this case cannot be noted (")
    assert f"kept: make room in {path.parent} and run the same command" in str(caught.value)
    journal.append(row("c"))
    assert list(read_rows(path)) == ["a", "c"]


def test_a_row_that_did_not_reach_the_disk_is_taken_back(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = Journal(path)
    journal.append(row("a"))
    kept = path.read_bytes()

    def full(file: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(SolveError, match=r"\(No space left on device\)"):
            journal.append(row("b"))
    assert path.read_bytes() == kept


def test_what_could_not_be_taken_back_is_cut_off_later(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = Journal(path)
    journal.append(row("a"))
    kept = path.read_bytes()

    def failing(*_: Any) -> None:
        raise OSError(errno.EIO, "Input/output error")

    with monkeypatch.context() as patch, room_for(len(kept) + 10):
        patch.setattr(os, "ftruncate", failing)
        with pytest.raises(SolveError):
            journal.append(row("b"))
    assert len(path.read_bytes()) == len(kept) + 10
    journal.append(row("c"))
    assert list(read_rows(path)) == ["a", "c"]


APPENDS = """
import sys
from pathlib import Path
from porolub.study.work.journal import Journal

journal = Journal(Path(sys.argv[1]))
for k in range(10**6):
    journal.append({"key": str(k), "message": "x" * 5000})
    print(k, flush=True)
"""


def test_a_killed_process_loses_no_row_it_has_noted(path: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", APPENDS, str(path)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if int(line) >= 20:
                process.kill()
                break
        noted = [int(k) for k in process.stdout.read().split()]
    kept = [int(key) for key in read_rows(path)]
    assert kept == list(range(len(kept)))
    assert len(kept) > max([20, *noted])
    Journal(path).append(row("next"))
    assert list(read_rows(path))[-1] == "next"


def test_rows_of_parts_belong_to_the_sweep(tmp_path: Path) -> None:
    """A converged row goes before others, then the sweep's own before those of parts."""
    for name, rows in {
        "part-1-of-2": [row("a", wall=1), row("b", status="failed", wall=1), row("e", wall=1)],
        "part-2-of-2": [row("c", wall=2), row("d", wall=2)],
        "elsewhere": [row("f", wall=9)],
        ".": [
            row("b", wall=3),
            row("c", status="failed", wall=3),
            row("d", wall=3),
            row("g", status="failed", wall=3),
        ],
    }.items():
        (tmp_path / name).mkdir(exist_ok=True)
        journal = Journal(tmp_path / name / "journal.jsonl")
        for r in rows:
            journal.append(r)
    found = {key: (r["status"], r["wall"]) for key, r in rows_of(tmp_path).items()}
    ok = "converged"
    assert found == {
        "a": (ok, 1), "b": (ok, 3), "c": (ok, 2), "d": (ok, 3), "e": (ok, 1), "g": ("failed", 3),
    }  # fmt: skip
