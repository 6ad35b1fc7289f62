"""Friction shears a layer that slides on its base: there may be no steady state.

The layer is pushed against the ends, J departs from 1 there, and the suction this causes presses
the layer harder against the plane. Such a scene ends in a stable state or in a typed failure,
never in a state that is called converged and is not.
"""

from pathlib import Path

import pytest

from porolub.errors import SolveError
from porolub.io.summary import read_summary
from porolub.run import run_scene
from tests.hard.stable import assert_stable, scene_of, solve


@pytest.mark.parametrize(
    ("speed", "load", "mesh"),
    [
        (0.01, 3.0, (24, 3)),
        (1.0, 0.1, (40, 4)),
        (1.0, 3.0, (24, 3)),
        pytest.param(0.01, 0.1, (40, 4), marks=pytest.mark.slow),
        pytest.param(0.01, 3.0, (75, 8), marks=pytest.mark.slow),
        pytest.param(0.1, 1.5, (75, 8), marks=pytest.mark.slow),
        pytest.param(1.0, 3.0, (75, 8), marks=pytest.mark.slow),
        pytest.param(-2.0, 3.0, (75, 8), marks=pytest.mark.slow),
    ],
)
def test_it_ends_in_a_stable_state_or_says_why_not(
    speed: float, load: float, mesh: tuple[int, int]
) -> None:
    outcome = solve(scene_of("sliding", speed, load, True, *mesh))
    if outcome.converged:
        assert_stable(outcome)
    else:
        assert outcome.message.startswith("The steady solve failed: ")
        assert "friction drags a layer that slides on its base" in outcome.message


def test_a_drag_without_a_steady_state_ends_with_exit_code_3(tmp_path: Path) -> None:
    with pytest.raises(SolveError) as caught:
        run_scene(scene_of("sliding", 0.01, 3.0, True, 24, 3), tmp_path, quiet=True)
    assert caught.value.exit_code == 3
    summary = read_summary(tmp_path / "summary.json")
    assert summary["status"] == "failed"
    assert summary["message"] in str(caught.value)
    assert 'solid.base = "bonded"' in summary["message"]
    assert (tmp_path / "fields.h5").exists()
