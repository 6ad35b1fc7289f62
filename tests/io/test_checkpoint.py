"""checkpoint.h5 gives back what was put in, or says in one sentence why it cannot."""

import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from porolub.errors import SceneError, SolveError
from porolub.io.checkpoint import VERSION, read_checkpoint, read_digest, write_checkpoint
from porolub.solve.report import Resume, StateData
from tests.io.resume import made_up

TOML = '[scene]\ntitle = "µ"\n\n[load]\nforce = "1500.0 N/m"\n'
TABLES = {"scene": {"title": "µ"}, "load": {"force": "1500.0 N/m"}}
DIGEST = "0123" * 16
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def resume() -> Resume:
    """Four states of a small layer."""
    return made_up(nodes=60, states=4)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "checkpoint.h5"


def same(one: Resume, other: Resume) -> bool:
    """Equal to the last bit."""

    def plain(resume: Resume) -> object:
        return replace(resume, states=()), [
            (state.time, state.units, state.mesh_nodes.tobytes(), state.mesh_nodes.shape)
            for state in resume.states
        ]

    def arrays(state: StateData) -> object:
        return {
            name: (nodes.tolist(), values.shape, values.tobytes())
            for name, (nodes, values) in state.fields.items()
        }

    pairs = zip(one.states, other.states, strict=True)
    return plain(one) == plain(other) and all(arrays(a) == arrays(b) for a, b in pairs)


def test_every_bit_comes_back(path: Path, resume: Resume) -> None:
    write_checkpoint(path, resume, TOML, DIGEST)
    again, tables = read_checkpoint(path)
    assert same(again, resume)
    assert tables == TABLES
    assert read_digest(path) == DIGEST
    assert [p.name for p in path.parent.iterdir()] == ["checkpoint.h5"]


def test_a_single_steady_state_is_a_checkpoint_too(path: Path) -> None:
    resume = Resume(made_up(nodes=9, states=1).states, orders=(0,), step=0.0)
    write_checkpoint(path, resume, TOML, DIGEST)
    assert same(read_checkpoint(path)[0], resume)


def test_a_scene_may_be_long(path: Path, resume: Resume) -> None:
    """A table of a load over time, say; an attribute of HDF5 ends at 64 kB."""
    values = [f"{k / 7} N/m" for k in range(10_000)]
    write_checkpoint(path, resume, f"[load.force]\nvalues = {values}\n", DIGEST)
    assert read_checkpoint(path)[1] == {"load": {"force": {"values": values}}}


def test_what_is_common_to_all_states_is_stored_once(path: Path, resume: Resume) -> None:
    """And others can read it: it is an HDF5 file with units."""
    write_checkpoint(path, resume, TOML, DIGEST)
    with h5py.File(path) as file:
        group = file["fields/u"]
        assert group["nodes"].shape == (60,)
        assert group["values"].shape == (4, 60, 2)
        assert group["values"].attrs["unit"] == "m"
        assert file["mesh_nodes"].shape == (60, 2)
        assert file["scene"][()].tobytes().decode() == TOML


@pytest.mark.parametrize("what", ["mesh", "field", "nodes", "orders"])
def test_states_that_do_not_belong_together_are_refused(
    path: Path, resume: Resume, what: str
) -> None:
    first, second, *others = resume.states
    nodes, values = second.fields["u"]
    changed = {
        "mesh": replace(second, mesh_nodes=second.mesh_nodes * 1.1),
        "field": replace(second, fields={"u": second.fields["u"]}),
        "nodes": replace(second, fields={**second.fields, "u": (nodes[::-1], values)}),
    }.get(what, second)
    wrong = replace(resume, states=(first, changed, *others))
    if what == "orders":
        wrong = replace(resume, orders=(2,))
    with pytest.raises(ValueError, match="the states of a checkpoint differ"):
        write_checkpoint(path, wrong, TOML, DIGEST)
    assert not path.exists()


def test_a_missing_file_is_refused(path: Path) -> None:
    for read in (read_checkpoint, read_digest):
        with pytest.raises(SceneError, match=r"checkpoint\.h5: there is no checkpoint here\."):
            read(path)


def test_another_version_is_refused_by_its_number(path: Path, resume: Resume) -> None:
    write_checkpoint(path, resume, TOML, DIGEST)
    path.write_bytes(path.read_bytes().replace(b"checkpoint 3", b"checkpoint 7", 1))
    with pytest.raises(SceneError, match=f"is of version 7; this porolub reads {VERSION}"):
        read_checkpoint(path)


@pytest.mark.parametrize("content", [b"", b"nonsense", b"porolub checkpoint\n" * 40])
def test_an_alien_file_is_refused(path: Path, content: bytes) -> None:
    path.write_bytes(content)
    with pytest.raises(SceneError, match="this is no checkpoint that this porolub could read"):
        read_checkpoint(path)


def test_an_hdf5_file_of_somebody_else_is_refused(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file.attrs["version"] = 1
    with pytest.raises(SceneError, match="this is no checkpoint that this porolub could read"):
        read_checkpoint(path)


def test_no_damage_goes_unnoticed(path: Path, resume: Resume) -> None:
    """Neither a flipped bit anywhere nor a missing end; the padding of the header is no content."""
    write_checkpoint(path, resume, TOML, DIGEST)
    good = path.read_bytes()
    rng = np.random.default_rng(3)
    places = [*range(85), *rng.integers(512, len(good), 300)]
    for place in places:
        bad = bytearray(good)
        bad[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(bad)
        with pytest.raises(SceneError, match=r"checkpoint\.h5: this (checkpoint )?is "):
            read_checkpoint(path)
    for length in (0, 50, 512, 600, len(good) // 2, len(good) - 1):
        path.write_bytes(good[:length])
        with pytest.raises(SceneError, match=r"checkpoint\.h5: this (checkpoint )?is "):
            read_checkpoint(path)


def test_a_checkpoint_that_lacks_something_is_refused(
    path: Path, resume: Resume, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("porolub.io.checkpoint._put", lambda file, resume: None)
    write_checkpoint(path, resume, TOML, DIGEST)
    with pytest.raises(SceneError, match="this is no complete checkpoint"):
        read_checkpoint(path)


FULL_DISK = """
import resource, sys
from pathlib import Path
from porolub.errors import SolveError
from porolub.io.checkpoint import write_checkpoint
from tests.io.resume import made_up

resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
try:
    write_checkpoint(Path(sys.argv[1]), made_up(nodes=1000, states=2), "", "")
except SolveError as error:
    print(error)
"""


def test_a_full_disk_is_one_sentence_and_the_old_checkpoint_stays(
    path: Path, resume: Resume
) -> None:
    """In a process of its own: HDF5 writing by itself would crash it on leaving."""
    write_checkpoint(path, resume, TOML, DIGEST)
    done = subprocess.run(
        [sys.executable, "-c", FULL_DISK, path],
        cwd=ROOT, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == f"{path}: this file cannot be written (File too large).\n"
    assert done.stderr == ""
    assert same(read_checkpoint(path)[0], resume)
    assert len(list(path.parent.iterdir())) == 1


def test_a_directory_that_is_gone_is_one_sentence(path: Path, resume: Resume) -> None:
    with pytest.raises(SolveError, match=r"cannot be written \(No such file or directory\)"):
        write_checkpoint(path / "below", resume, TOML, DIGEST)


WRITE_FOR_EVER = """
import itertools, sys
from pathlib import Path
from porolub.io.checkpoint import write_checkpoint
from tests.io.resume import made_up

choice = [made_up(nodes=20_000, states=3, number=k) for k in range(2)]
for k in itertools.count():
    write_checkpoint(Path(sys.argv[1]), choice[k % 2], f"number = {k % 2}", str(k % 2))
    print(k, flush=True)
"""


def test_kill_9_at_any_moment_leaves_a_checkpoint(path: Path) -> None:
    choice = [made_up(nodes=20_000, states=3, number=k) for k in range(2)]
    rng = np.random.default_rng()
    for _ in range(8):
        with subprocess.Popen(
            [sys.executable, "-c", WRITE_FOR_EVER, path],
            cwd=ROOT, stdout=subprocess.PIPE, text=True,
        ) as writer:  # fmt: skip
            assert writer.stdout is not None
            assert writer.stdout.readline() == "0\n"  # from here on there is one
            time.sleep(rng.uniform(0.0, 0.2))
            writer.send_signal(signal.SIGKILL)
        assert writer.returncode == -signal.SIGKILL
        resume, tables = read_checkpoint(path)
        number = tables["number"]
        assert read_digest(path) == str(number)
        assert same(resume, choice[number])
    write_checkpoint(path, choice[0], TOML, DIGEST)  # what a killed write left is in nobody's way
    assert [p.name for p in path.parent.iterdir()] == ["checkpoint.h5"]
