"""Files that many ranks write together: the bytes of one rank, and one sentence on a full disk."""

import re
from pathlib import Path

import h5py
import numpy as np
import pytest

from porolub.io.fields import read_fields
from porolub.io.frames import read_frames
from tests.io.body import body, body_surface

SCRIPT = Path(__file__).with_name("ranks_write.py")


def contents(directory: Path) -> dict[str, bytes]:
    return {str(p.relative_to(directory)): p.read_bytes()
            for p in sorted(directory.rglob("*")) if p.is_file()}  # fmt: skip


@pytest.mark.mpi
def test_any_number_of_ranks_writes_the_same_bytes(run_mpi, tmp_path: Path) -> None:
    found = {}
    for ranks in (1, 2, 3, 4):
        out = tmp_path / str(ranks)
        out.mkdir()
        assert "rank" not in run_mpi(ranks, SCRIPT, out)
        found[ranks] = contents(out)
    frames = {"frames/mesh.h5", "frames/frame_0000.h5", "frames/frame_0001.h5", "series.xdmf",
              "surface_series.xdmf"}  # fmt: skip
    assert set(found[1]) == {"fields.h5", "fields.xdmf", "checkpoint.h5",
                             *(f"{kind}/{name}" for kind in ("packed", "large")
                               for name in frames)}  # fmt: skip
    for ranks in (2, 3, 4):
        assert found[ranks].keys() == found[1].keys()
        for name, data in found[1].items():
            assert found[ranks][name] == data, f"{name} of {ranks} ranks"
    expected = body()
    again = read_fields(tmp_path / "4")
    for name in ("nodes", "cells", "displacement", "pressure", "jacobian", "von_mises", "flux"):
        np.testing.assert_array_equal(getattr(again, name), getattr(expected, name))
    for kind in ("packed", "large"):
        frame = read_frames(tmp_path / "4" / kind).load(1)
        np.testing.assert_array_equal(frame.fields.pressure, expected.pressure.astype("f4"))
        np.testing.assert_array_equal(frame.surface.p, body_surface().p)
        with h5py.File(tmp_path / "4" / kind / "frames" / "frame_0001.h5") as file:
            assert (file["u"].compression is None) == (kind == "large")


@pytest.mark.mpi
@pytest.mark.parametrize("limit", [2_000, 20_000, 1_000_000])
def test_a_disk_full_on_one_rank_is_known_to_all(run_mpi, tmp_path: Path, limit: int) -> None:
    """The last rank finds none; which file it is depends on how far it gets."""
    said = run_mpi(3, SCRIPT, tmp_path, limit)
    found = re.findall(r"rank (\d): \w+: (.*?\(File too large\)|.*?File too large)", said)
    assert sorted(rank for rank, _ in found) == ["0", "1", "2"]
    assert len({sentence for _, sentence in found}) == 1
    assert not list(tmp_path.rglob(".*"))
