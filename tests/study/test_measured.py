"""Errors against one limit, and the cheapest setting within a target."""

from typing import Any

import numpy as np
import pytest

from porolub.study.accuracy.measured import Trial, measured, trial
from porolub.study.accuracy.recommend import advise
from porolub.study.accuracy.strategies import Setting

LIMIT = 5.0
SIZES = (1.0, 0.5, 0.25, 0.125)


def trials(wall: float = 1.0, **errors: tuple[float | None, ...]) -> list[Trial]:
    """Made-up runs, by strategy the relative errors of their levels; None: the run failed."""
    found = []
    for strategy, sequence in errors.items():
        for size, error in zip(SIZES, sequence, strict=False):
            setting = Setting(strategy, f"h {size}", size, {})
            if error is None:
                found.append(Trial(setting, "failed", "no"))
            else:
                found.append(Trial(setting, "converged", wall=wall / size, unknowns=10 / size,
                                   summary={"load_fluid": LIMIT * (1 + error)}))  # fmt: skip
        wall *= 1.5
    return found


def powers(first: float, order: float) -> tuple[float, ...]:
    return tuple(first * size**order for size in SIZES)


def test_errors_are_against_the_limit_of_the_surest_strategy() -> None:
    rough, fine = powers(0.2, 1.0), powers(-0.1, 2.0)
    found = measured("load_fluid", trials(rough=rough, fine=fine))
    assert found is not None
    assert (found.source, found.relative) == ("fine", True)
    assert found.limit == pytest.approx(LIMIT)
    np.testing.assert_allclose(found.errors, np.abs([*rough, *fine]), atol=1e-9)
    np.testing.assert_allclose(found.orders, [np.nan, np.nan, 1, 1, np.nan, np.nan, 2, 2])
    assert found.apart == 0


def test_values_that_agree_by_accident_are_no_limit() -> None:
    stalls = (0.11, 0.03, 0.0015, 0.0001)  # toward a place beside the limit
    found = measured("load_fluid", trials(stalls=np.add(stalls, 0.01), fine=powers(-0.1, 2.0)))
    assert found is not None
    assert found.source == "fine"


def test_strategies_that_do_not_agree_are_told() -> None:
    one, other = powers(0.1, 2.0), tuple(np.add(powers(0.1, 2.0), 0.01))
    found = measured("load_fluid", trials(one=one, other=other))
    assert found is not None
    assert found.apart == pytest.approx(0.01, rel=0.2)


def test_a_limit_of_zero_has_absolute_errors() -> None:
    runs = [Trial(Setting("s", str(h), h, {}), "converged", summary={"approach": v})
            for h, v in ((1, 1e-6), (0.5, -1e-6), (0.25, 0.0))]  # fmt: skip
    found = measured("approach", runs)
    assert found is not None
    assert not found.relative
    np.testing.assert_allclose(found.errors, [1e-6, 1e-6, 0])
    assert [a.trial for a in advise(runs, [found])] == [None, None, None]


def test_failed_runs_have_no_error_and_the_rest_counts() -> None:
    errors = powers(0.1, 2.0)
    runs = trials(fine=(errors[0], None, errors[2], errors[3]))
    found = measured("load_fluid", runs)
    assert found is not None
    assert np.isnan(found.errors[1])
    assert found.limit == pytest.approx(LIMIT)
    assert measured("load_fluid", trials(bad=(None, None))) is None


def test_a_row_becomes_a_trial() -> None:
    setting = Setting("s", "l", 1.0, {})
    summary: dict[str, Any] = {
        "load_fluid": 5.0, "dofs": {"total": 9}, "wall_time": {"total": 2.0}, "time_steps": 7,
        "newton_iterations": 3, "error_estimate": {"load_fluid": 0.5},
    }  # fmt: skip
    row = {"status": "converged", "message": "", "summary": summary, "wall": 9.0}
    found = trial(setting, row)
    assert (found.wall, found.unknowns, found.steps, found.newton) == (2, 9, 7, 3)
    of_load = measured("load_fluid", [found])
    assert of_load is not None
    assert of_load.estimates.tolist() == [0.1]
    failed = trial(setting, {"status": "failed", "message": "it diverged", "summary": {}})
    assert (failed.converged, failed.message) == (False, "it diverged")
    assert trial(setting, None).status == "refused"


def advised(runs: list[Trial]) -> list[int | None]:
    found = measured("load_fluid", runs)
    assert found is not None
    return [a.trial for a in advise(runs, [found])]


def test_the_cheapest_setting_within_the_target_is_advised() -> None:
    runs = trials(quick=powers(0.2, 1.0), good=powers(-0.05, 2.0))
    # errors of good are 5, 1.25, 0.31 and 0.08 %; quick is cheaper but never within 1 %
    assert advised(runs) == [4, 6, 7]
    assert advised(trials(quick=powers(0.09, 1.0), good=powers(-0.05, 2.0)))[0] == 0
    assert advised(trials(good=powers(-0.1, 2.0))) == [1, 2, None]


def test_a_value_that_passes_the_limit_is_not_advised() -> None:
    runs = trials(passes=(0.02, 0.0, -0.03, 0.02), good=powers(-0.4, 2.0))
    assert advised(runs)[0] == 0
    assert advised(runs)[1] == 4 + 3


def test_all_quantities_must_be_within_the_target() -> None:
    runs = [Trial(t.setting, t.status, wall=t.wall,
                  summary=dict(t.summary) | {"approach": 1 + 10 * t.setting.size**2})
            for t in trials(good=powers(-0.05, 2.0))]  # fmt: skip
    both = [m for q in ("load_fluid", "approach") if (m := measured(q, runs)) is not None]
    assert [a.trial for a in advise(runs, both[:1])][:2] == [0, 2]
    ten, one, _ = advise(runs, both)
    assert (ten.trial, one.trial) == (None, None)
    assert ten.error == pytest.approx(10 * SIZES[-1] ** 2, rel=0.2)
