"""Files are replaced as a whole or not at all."""

from pathlib import Path

import pytest

from porolub.errors import SolveError
from porolub.io.atomic import replacing, reported, write_text


def test_new_text_replaces_old(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    write_text(path, "old")
    write_text(path, "µ\nnew\n")
    assert path.read_bytes() == "µ\nnew\n".encode()
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("interruption", [OSError, KeyboardInterrupt])
def test_an_interrupted_write_leaves_the_old_files(
    tmp_path: Path, interruption: type[BaseException]
) -> None:
    data, index = tmp_path / "data", tmp_path / "index"
    data.write_text("old data")
    index.write_text("old index")

    def write() -> None:
        with replacing(data, index) as (new_data, _):
            new_data.write_text("half of the new")
            raise interruption

    with pytest.raises(interruption):
        write()
    assert data.read_text() == "old data"
    assert index.read_text() == "old index"
    assert sorted(tmp_path.iterdir()) == [data, index]


def test_a_file_that_was_never_written_is_an_error_and_changes_nothing(tmp_path: Path) -> None:
    data, index = tmp_path / "data", tmp_path / "index"
    data.write_text("old data")
    index.write_text("old index")
    with pytest.raises(FileNotFoundError), replacing(data, index) as (new_data, _):
        new_data.write_text("new data")
    assert data.read_text() == "old data"
    assert index.read_text() == "old index"


def test_old_index_and_new_data_never_stand_together(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Stopped at any of the renames, the index that is there belongs to the data."""
    rename = Path.replace
    for allowed in (0, 1, 2):
        data, index = tmp_path / "data", tmp_path / "index"
        data.write_text("old")
        index.write_text("old")
        done = []

        def stop_after(self: Path, target: Path, allowed: int = allowed, done: list = done) -> Path:
            if len(done) == allowed:
                raise KeyboardInterrupt
            done.append(target)
            return rename(self, target)

        monkeypatch.setattr(Path, "replace", stop_after)
        try:
            with replacing(data, index) as new:
                for path in new:
                    path.write_text("new")
        except KeyboardInterrupt:
            assert allowed < 2
        assert len(done) == allowed
        assert not index.exists() or index.read_text() == data.read_text()
        assert not list(tmp_path.glob(".*"))
    assert index.read_text() == "new"


def test_an_error_of_the_disk_is_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    with pytest.raises(SolveError) as caught, reported(path):
        raise OSError(28, "No space left on device")
    assert str(caught.value) == f"{path}: this file cannot be written (No space left on device)."
    with pytest.raises(SolveError) as caught, reported(path, "the results"):
        raise OSError("odd")
    assert str(caught.value) == f"{path}: the results cannot be written (odd)."
    with pytest.raises(KeyError), reported(path):
        raise KeyError
