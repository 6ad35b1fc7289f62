"""Two jobs on one directory exclude each other; a dead one does not."""

import re
import signal
from pathlib import Path

import pytest

from porolub.study.work.table import read_table
from tests.study.drills import (
    PLOTS,
    computed,
    computed_once,
    forces,
    journal,
    no_remains,
    same_table,
    started,
    sweep,
    sweep_file,
)  # fmt: skip

DIES = Path(__file__).with_name("dies.py")


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PLOTS, lambda directory: [])


def test_a_second_job_is_told_who_is_at_work(tmp_path: Path) -> None:
    file, here = sweep_file(tmp_path, forces(3)), tmp_path / "here"
    words = ["halts", 15, "sweep", file, "--out", here, "--quiet"]
    with started(DIES, *words, cwd=tmp_path) as first:
        assert first.stdout is not None
        assert first.stdout.readline() == "halted\n"
        before = {path.name: path.read_bytes() for path in here.iterdir() if path.is_file()}
        for more in ([], ["--retry-failed"]):
            second = sweep(file, here, *more)
            assert (second.exit_code, second.stdout) == (2, "")
            said = (rf"porolub: .*/here: another sweep has been writing here since [-\d]+ [\d:]+ "
                    rf"\(process {first.pid} on .*\); wait for it or choose another --out\.\n")
            assert re.fullmatch(said, second.stderr)
        assert {p.name: p.read_bytes() for p in here.iterdir() if p.is_file()} == before
        first.kill()
    assert first.returncode == -signal.SIGKILL
    assert sweep(file, here).exit_code == 0
    computed_once(here)
    no_remains(here)
    same_table(read_table(here), computed(file, tmp_path / "alone"))


@pytest.mark.parametrize("file", ["table.h5", "table.csv", "sweep.resolved.toml", "log.txt"])
def test_what_can_be_made_from_the_journal_may_be_lost(tmp_path: Path, file: str) -> None:
    path, here = sweep_file(tmp_path, forces(2)), tmp_path / "here"
    expected = computed(path, here)
    (here / file).unlink()
    assert sweep(path, here).exit_code == 0
    assert (here / file).exists()
    same_table(read_table(here), expected)
    assert len(journal(here)) == 2


def test_start_states_may_be_lost_or_damaged(tmp_path: Path) -> None:
    """They save iterations, no more."""
    path, here = sweep_file(tmp_path, forces(4)), tmp_path / "here"
    words = ["in a line", 3, "sweep", path, "--out", here, "--quiet"]
    with started(DIES, *words, cwd=tmp_path) as process:
        process.communicate(timeout=60)
    first, second = sorted((here / "states").iterdir())[:2]
    first.write_bytes(first.read_bytes()[:1000])
    second.unlink()
    assert sweep(path, here).exit_code == 0
    table = read_table(here)
    assert set(table.columns["status"]) == {"converged"}
    assert table.columns["load_total"] == pytest.approx([300.0, 700.0, 1100.0, 1500.0], rel=1e-6)
    computed_once(here)


def test_a_damaged_journal_is_named(tmp_path: Path) -> None:
    path, here = sweep_file(tmp_path, forces(2)), tmp_path / "here"
    computed(path, here)
    lines = (here / "journal.jsonl").read_text().splitlines()
    (here / "journal.jsonl").write_text("\n".join(["rubbish", *lines]) + "\n")
    result = sweep(path, here)
    assert result.exit_code == 2
    assert re.fullmatch(r"porolub: .*journal\.jsonl, line 1: this is no row of a sweep, .*\n",
                        result.stderr)  # fmt: skip
