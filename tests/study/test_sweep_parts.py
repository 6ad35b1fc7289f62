"""A sweep in parts, a job each, and grown sweeps: what is done is used."""

from pathlib import Path

import numpy as np
import pytest

from porolub.study.work.table import read_table
from tests.study.drills import (
    PLOTS,
    computed,
    computed_once,
    forces,
    journal,
    no_remains,
    sweep,
    sweep_file,
)  # fmt: skip
from tests.study.sweeps import log

NUMBERS = ("load_solid", "friction_coefficient", "approach", "film_min", "pressure_max")


@pytest.fixture(autouse=True)
def _no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PLOTS, lambda directory: [])


def test_the_plain_command_after_all_parts_makes_the_whole_table(tmp_path: Path) -> None:
    file = sweep_file(tmp_path)
    expected = computed(file, tmp_path / "whole")
    here = tmp_path / "here"
    parts = [here / f"part-{k}-of-2" for k in (1, 2)]
    for k, part in enumerate(parts, 1):
        assert sweep(file, here, "--part", f"{k}/2").exit_code == 0
        assert len(read_table(part)) == len(journal(part)) == 3
        no_remains(part)
    assert not (here / "table.csv").exists()
    result = sweep(file, here, quiet=False)
    assert result.exit_code == 0
    assert "6 of 6 cases need no work" in result.stdout
    assert journal(here) == []
    computed_once(*parts)
    found = read_table(here)
    assert found.columns["case"].tolist() == [0, 1, 2, 3, 4, 5]
    for name in NUMBERS:
        np.testing.assert_allclose(found.columns[name], expected.columns[name], rtol=1e-7)


def test_what_a_part_has_not_done_the_plain_command_does(tmp_path: Path) -> None:
    file = sweep_file(tmp_path)
    assert sweep(file, tmp_path / "here", "--part", "2/2").exit_code == 0
    assert sweep(file, tmp_path / "here").exit_code == 0
    assert len(journal(tmp_path / "here")) == 3
    computed_once(tmp_path / "here", tmp_path / "here" / "part-2-of-2")
    assert len(read_table(tmp_path / "here")) == 6
    # and a part looks at what the whole has
    assert sweep(file, tmp_path / "here", "--part", "1/3").exit_code == 0
    assert journal(tmp_path / "here" / "part-1-of-3") == []


def test_more_parts_than_cases_leave_some_without_work(tmp_path: Path) -> None:
    file = sweep_file(tmp_path, forces(2))
    codes = [sweep(file, tmp_path / "here", "--part", f"{k}/3").exit_code for k in (1, 2, 3)]
    assert codes == [0, 0, 0]
    assert len(list((tmp_path / "here").glob("part-*/journal.jsonl"))) == 2


@pytest.mark.parametrize("part", ["0/2", "3/2", "1", "x"])
def test_no_such_part(tmp_path: Path, part: str) -> None:
    result = sweep(sweep_file(tmp_path), tmp_path / "here", "--part", part)
    assert result.exit_code == 2
    assert result.stderr == (
        f"porolub: --part {part}: K/N is needed with 1 <= K <= N, such as 3/8.\n")
    assert not (tmp_path / "here").exists()


def test_more_points_on_an_axis_are_the_only_ones_computed(tmp_path: Path) -> None:
    here = tmp_path / "here"
    two = log("motion.speed", "0.1 rad/s", "1 rad/s", 2)
    few, more = ({"key": "load.force", "values": [f"{f} N/m" for f in given]}
                 for given in ([300, 2000], [300, 600, 1000, 2000]))  # fmt: skip
    assert sweep(sweep_file(tmp_path, two, few), here).exit_code == 0
    before = {row["key"]: row for row in journal(here)}
    result = sweep(sweep_file(tmp_path, two, more), here, quiet=False)
    assert result.exit_code == 0
    assert "4 of 8 cases need no work" in result.stdout
    computed_once(here)
    rows = journal(here)
    assert [row for row in rows if row["key"] in before] == list(before.values())
    assert {row["case"] for row in rows if row["key"] not in before} == {1, 2, 5, 6}
    table = read_table(here)
    assert table.columns["case"].tolist() == list(range(8))
    assert table.columns["force"].tolist() == [300.0, 600.0, 1000.0, 2000.0] * 2
    np.testing.assert_allclose(table.columns["load_total"], table.columns["force"], rtol=1e-6)
    # fewer again: the others are kept in the journal
    assert sweep(sweep_file(tmp_path, two, few), here).exit_code == 0
    assert journal(here) == rows
    assert read_table(here).columns["force"].tolist() == [300.0, 2000.0] * 2


def test_what_a_case_started_from_is_told_by_the_numbers_of_now(tmp_path: Path) -> None:
    def starts(*given: int) -> list[str]:
        axis = {"key": "load.force", "values": [f"{f} N/m" for f in given]}
        assert sweep(sweep_file(tmp_path, axis), tmp_path / "here").exit_code == 0
        return list(read_table(tmp_path / "here").columns["start"])

    assert starts(300, 1000, 2000) == ["zero", "cases 0, 2", "zero"]
    assert starts(200, 300, 1000, 2000)[1:] == ["zero", "cases 1, 3", "zero"]
    assert starts(1000, 2000) == ["cases ?, 1", "zero"]
