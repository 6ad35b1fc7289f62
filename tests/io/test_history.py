"""history.csv grows by a row per step, goes on where a run was cut off, and reads back."""

import math
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from porolub.errors import SceneError, SolveError
from porolub.io.history import HistoryWriter, read_history, read_records, write_history
from porolub.solve.report import StepRecord

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "history.csv"


def steps(*times: float) -> list[StepRecord]:
    return [StepRecord(t, {"time_step": t / 3, "load_total": 1500.0 + t}) for t in times]


def test_rows_are_there_as_soon_as_they_are_written(path: Path) -> None:
    writer = HistoryWriter(path)
    assert not path.exists()
    for k, step in enumerate(steps(0.0, 0.5, 1.5), start=1):
        writer.write(step)
        assert len(path.read_text().splitlines()) == k + 1
    assert path.read_text() == (
        "time,load_total,time_step\n"
        "0.0,1500.0,0.0\n"
        "0.5,1500.5,0.16666666666666666\n"
        "1.5,1501.5,0.5\n"
    )


def test_a_row_is_one_call(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """So that who reads along never meets half a line but the very last."""
    writer = HistoryWriter(path)
    writer.write(steps(0.0)[0])
    calls = []
    write = os.write

    def note(file: int, data: bytes) -> int:
        calls.append(data)
        return write(file, data)

    monkeypatch.setattr(os, "write", note)
    writer.write(steps(3.0)[0])
    assert calls == [b"3.0,1503.0,1.0\n"]


def test_the_same_as_written_at_once(path: Path) -> None:
    records = [
        StepRecord(0.1, {"fraction": 0.3, "approach": 1e-5, "load_total": np.float64(1 / 3)}),
        StepRecord(0.2, {"approach": math.nan, "load_total": math.inf, "fraction": 1.0}),
        StepRecord(0.3, {"fraction": -0.0}),
    ]
    write_history(path, records)
    at_once = path.read_text()
    writer = HistoryWriter(path)
    for record in records:
        writer.write(record)
    assert path.read_text() == at_once


def test_columns_read_back_to_the_same_floats(path: Path) -> None:
    writer = HistoryWriter(path)
    times = np.cumsum(np.random.default_rng(0).random(50)) / 7
    for t in times:
        writer.write(StepRecord(t, {"load_total": t / 3 if t > 0.5 else math.nan}))
    history = read_history(path)
    assert list(history) == ["time", "load_total"]
    np.testing.assert_array_equal(history["time"], times)
    np.testing.assert_array_equal(history["load_total"], np.where(times > 0.5, times / 3, np.nan))
    assert {values.dtype for values in history.values()} == {np.dtype(float)}


def test_what_only_a_later_step_has_gets_a_column_behind(path: Path) -> None:
    writer = HistoryWriter(path)
    for step in steps(0.0, 1.0):
        writer.write(step)
    writer.write(StepRecord(2.0, {"contact_left": -4e-3, "load_total": 1.0, "other": 7.0}))
    writer.write(StepRecord(3.0, {"load_total": 2.0}))
    assert path.read_text() == (
        "time,load_total,time_step,contact_left,other\n"
        "0.0,1500.0,0.0,,\n"
        "1.0,1501.0,0.3333333333333333,,\n"
        "2.0,1.0,,-0.004,7.0\n"
        "3.0,2.0,,,\n"
    )
    np.testing.assert_array_equal(
        read_history(path)["contact_left"], [np.nan, np.nan, -4e-3, np.nan]
    )
    assert read_records(path)[2:] == [
        StepRecord(2.0, {"load_total": 1.0, "contact_left": -4e-3, "other": 7.0}),
        StepRecord(3.0, {"load_total": 2.0}),
    ]


def test_a_new_run_begins_a_new_file_with_its_first_row(path: Path) -> None:
    path.write_text("an old one")
    writer = HistoryWriter(path)
    assert path.read_text() == "an old one"
    writer.write(StepRecord(0.0, {"approach": 1.0}))
    assert path.read_text() == "time,approach\n0.0,1.0\n"


def test_resuming_takes_later_rows_away_and_goes_on(path: Path) -> None:
    writer = HistoryWriter(path)
    whole = steps(0.0, 0.1, 0.3, 0.6, 1.0)
    for step in whole:
        writer.write(step)
    uninterrupted = path.read_text()
    path.write_text(uninterrupted + "1.5,15")  # killed while it wrote
    again = HistoryWriter(path, resume_at=0.3 * (1 + 1e-15))
    assert read_records(path) == whole[:3]
    for step in whole[3:]:
        again.write(step)
    assert path.read_text() == uninterrupted


@pytest.mark.parametrize(("resume_at", "left"), [(0.0, 1), (-1.0, 0), (0.6, 3), (9.0, 3)])
def test_resuming_before_and_after_all_rows(path: Path, resume_at: float, left: int) -> None:
    write_history(path, steps(0.0, 0.3, 0.6))
    HistoryWriter(path, resume_at)
    assert len(read_records(path)) == left


def test_rounding_of_the_time_does_not_count(path: Path) -> None:
    write_history(path, steps(0.3, 0.3 * (1 + 1e-11)))
    HistoryWriter(path, 0.3 * (1 - 1e-13))
    assert len(read_records(path)) == 1


def test_resuming_without_a_file_begins_one(path: Path) -> None:
    HistoryWriter(path, resume_at=0.5).write(steps(0.6)[0])
    assert read_history(path)["time"].tolist() == [0.6]


def test_a_file_of_another_run_is_refused(path: Path) -> None:
    path.write_text("time,mine,yours\n0.0,1.0,2.0\n")
    writer = HistoryWriter(path, resume_at=1.0)
    with pytest.raises(SceneError, match=r"has none of the columns time_step, load_total; it bel"):
        writer.write(steps(2.0)[0])
    assert path.read_text() == "time,mine,yours\n0.0,1.0,2.0\n"


def test_a_missing_file_is_refused(path: Path) -> None:
    with pytest.raises(SceneError, match=r"history\.csv: there is no history of a run here\."):
        read_history(path)


@pytest.mark.parametrize("end", ["1.", "1.0,7.0", "1.0,7.0,", "\0\0\0", "1.0\n", "\0\0\0\n", "\n"])
def test_an_unfinished_last_line_is_left_out(path: Path, end: str) -> None:
    """Also where it can be read: 7.0 may be what is left of 7.0e-3."""
    path.write_text("time,load_total,approach\n0.0,1.0,\n0.5,2.0,3e-4\n" + end)
    assert read_history(path)["time"].tolist() == [0.0, 0.5]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "time,load_total",
        "load_total,time\n1.0,0.0\n",
        "time,a,a\n0.0,1.0,1.0\n",
        "time,a\n0.0,1.0,2.0\n1.0,1.0\n",
        "time,a\n0.0,much\n1.0,1.0\n",
        "time,a\n,1.0\n1.0,1.0\n",
        "\n",
        "\xff\n",
    ],
)
def test_a_damaged_file_is_refused(path: Path, text: str) -> None:
    path.write_text(text, encoding="latin-1")
    for read in (read_history, read_records, lambda path: HistoryWriter(path, resume_at=1.0)):
        with pytest.raises(SceneError, match=r"history\.csv: this file is damaged"):
            read(path)


def test_a_history_without_steps_has_columns(path: Path) -> None:
    path.write_text("time,load_total\n")
    assert {name: len(values) for name, values in read_history(path).items()} == {
        "time": 0, "load_total": 0}  # fmt: skip


def test_a_full_disk_is_one_sentence_and_leaves_no_torn_line(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = HistoryWriter(path)
    writer.write(steps(0.0)[0])
    before = path.read_bytes()
    write = os.write
    monkeypatch.setattr(os, "write", lambda file, data: write(file, data[:5]))  # the rest is full
    with pytest.raises(SolveError, match=r"history\.csv: this file cannot be written \(No space"):
        writer.write(steps(1.0)[0])
    assert path.read_bytes() == before
    monkeypatch.undo()
    path.unlink()
    with pytest.raises(SolveError, match=r"cannot be written \(No such file or directory\)"):
        writer.write(steps(1.0)[0])


def test_rows_are_brought_to_the_disk_on_request(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = HistoryWriter(path)
    writer.sync()  # nothing yet
    writer.write(steps(0.0)[0])
    synced = []
    monkeypatch.setattr(os, "fsync", lambda file: synced.append(os.fstat(file).st_ino))
    writer.sync()
    assert synced == [path.stat().st_ino]


WRITE_FOR_EVER = """
import itertools, sys
from pathlib import Path
from porolub.io.history import HistoryWriter
from porolub.solve.report import StepRecord

writer = HistoryWriter(Path(sys.argv[1]))
for k in itertools.count():
    writer.write(StepRecord(float(k), {name: k / 7 for name in "abcdefghijklmnopqrst"}))
    print(k, flush=True)
"""


def test_kill_9_loses_no_row_that_was_written(path: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", WRITE_FOR_EVER, path], cwd=ROOT, stdout=subprocess.PIPE, text=True
    ) as writer:
        assert writer.stdout is not None
        while int(writer.stdout.readline()) < 500:
            pass
        writer.send_signal(signal.SIGKILL)
        last = max([500, *map(int, writer.stdout.read().split()[:-1])])
    history = read_history(path)
    count = len(history["time"])
    assert count > last
    np.testing.assert_array_equal(history["time"], np.arange(count))
    np.testing.assert_array_equal(history["t"], np.arange(count) / 7)
