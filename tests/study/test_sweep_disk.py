"""A full disk ends a sweep in one sentence, whatever did not fit; with room it goes on."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from porolub.study.work.table import Table, read_table
from tests.run.output import JOBS
from tests.study import small_disk
from tests.study.drills import (
    PLOTS,
    computed,
    computed_once,
    forces,
    journal,
    no_remains,
    same_table,
    sweep_file,
)  # fmt: skip

CASES = 3
INPUT = r"disk/here: the files of a sweep cannot be written \({}\)\."
STATE = r"disk/here/states/\w+\.h5: this file cannot be written \({}\)\. \d of 3 cases are done; .*"
JOURNAL = r"disk/here/journal\.jsonl: this case cannot be noted \({}\)\. .*"
TABLE = r"disk/here: the table of the sweep cannot be written \({}\)\. \d of 3 cases are done; .*"
FIGURES = r"disk/here: the figures cannot be written \({}\)\. 3 of 3 cases are done; .*"
DISKS = {
    "tmpfs": ("No space left on device",
              {4096: INPUT, 8192: STATE, 24_576: JOURNAL, 40_960: TABLE, 163_840: FIGURES}),
    "file": ("File too large", {500: INPUT, 3000: STATE, 20_000: TABLE, 50_000: FIGURES}),
}  # fmt: skip
"""What the kernel says, and what does not fit onto a disk, or into a file, of so many bytes."""
KINDS = ["file", *(["tmpfs"] if small_disk.may_mount() else [])]


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> Table:
    directory = tmp_path_factory.mktemp("expected")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(PLOTS, lambda directory: [])
        return computed(sweep_file(directory, forces(CASES)), directory / "sweep")


@pytest.mark.parametrize("kind", KINDS)
def test_whatever_does_not_fit(tmp_path: Path, expected: Table, kind: str) -> None:
    reason, sizes = DISKS[kind]
    file = sweep_file(tmp_path, forces(CASES))
    prefix = small_disk.NAMESPACE if kind == "tmpfs" else []
    result = subprocess.run(
        [*prefix, sys.executable, small_disk.__file__, kind, str(file), *map(str, sizes)],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(JOBS.parent)},
        capture_output=True, text=True, timeout=200, check=False,
    )  # fmt: skip
    assert (result.returncode, result.stderr) == (0, "")
    for line, (size, said) in zip(result.stdout.splitlines(), sizes.items(), strict=True):
        found = json.loads(line)
        assert found["code"] == 3, (size, found)
        assert re.fullmatch(f"porolub: {said.format(reason)}\n", found["said"]), (size, found)
        assert found["said"].count("the same command") == (said is not INPUT)
        assert (found["again"], found["then"]) == (0, ""), size
        here = tmp_path / str(size)
        rows = journal(here)
        assert found["noted"] == [row["key"] for row in rows][: len(found["noted"])]  # all kept
        assert len(rows) == CASES
        computed_once(here)
        same_table(read_table(here), expected)
        no_remains(here)
        assert (here / "stribeck.png").exists() == (said is FIGURES)


FULL_DISK = """
import resource, sys
from mpi4py import MPI
from porolub.cli import main

if MPI.COMM_WORLD.rank == int(sys.argv.pop(1)):  # after MPI, whose files are larger
    resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
main()
"""


@pytest.mark.mpi
@pytest.mark.parametrize("rank", [1, pytest.param(0, marks=pytest.mark.slow)])
def test_all_ranks_stop_where_one_cannot_write(run_mpi, tmp_path: Path, rank: int) -> None:
    file = sweep_file(tmp_path)
    said = run_mpi(2, FULL_DISK, rank, "sweep", file, "--out", "here", "--quiet", code=3,
                   timeout=60)  # fmt: skip
    assert said.count("porolub: ") == said.count("cannot be written (File too large)") == 1
    assert "Traceback" not in said
    assert all(row["status"] == "converged" for row in journal(tmp_path / "here"))
