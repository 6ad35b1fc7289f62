"""Means and extremes over the last period of a run."""

import numpy as np
import pytest

from porolub.solve.report import StepRecord
from porolub.study.work.over_time import over_time


def records(times: np.ndarray, **columns: np.ndarray) -> list[StepRecord]:
    return [
        StepRecord(float(t), {k: float(v[n]) for k, v in columns.items() if np.isfinite(v[n])})
        for n, t in enumerate(times)
    ]


def test_the_last_full_period_counts() -> None:
    t = np.linspace(0, 2.5, 2501)
    friction = np.where(t < 1, 100.0, 3 + np.cos(2 * np.pi * t))
    found = over_time(records(t, friction_coefficient=friction), 1.0)["friction_coefficient"]
    assert found["mean"] == pytest.approx(3, abs=1e-5)
    assert found["min"] == pytest.approx(2)
    assert found["max"] == pytest.approx(4)


def test_without_a_period_the_whole_run_counts() -> None:
    t = np.array([0, 1, 3, 4.0])
    found = over_time(records(t, approach=t), None)["approach"]
    assert found == {"mean": pytest.approx(2), "min": 0, "max": 4}


def test_steps_without_a_value_do_not_count() -> None:
    t = np.arange(5.0)
    length = np.array([np.nan, np.nan, 2, 4, 4])
    found = over_time(records(t, approach=t, contact_length=length), None)
    assert found["contact_length"] == {"mean": pytest.approx(3.5), "min": 2, "max": 4}


def test_only_quantities_are_told() -> None:
    t = np.arange(3.0)
    found = over_time(records(t, load_fluid=t, time_step=t, mass_balance_error=t, order=t), None)
    assert list(found) == ["load_fluid"]
    assert over_time([], 1.0) == {}
