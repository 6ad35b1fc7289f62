"""The solver that ``porolub check`` announces is the one a run takes."""

import pytest

from porolub.scene.cost import preset_used
from porolub.solve.presets import PRESETS, chosen


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("asked", ["auto", *PRESETS])
def test_check_and_run_agree(asked: str, dimension: int) -> None:
    sizes = [int(10 ** (k / 8)) for k in range(16, 72)]
    announced = [preset_used(asked, dimension, n) for n in sizes]
    assert announced == [chosen(asked, dimension, n) for n in sizes]
    assert len(set(announced)) == (2 if asked == "auto" else 1)
