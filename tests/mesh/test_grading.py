"""Grading of a line: exact count, monotone, bounded ratio, small at the edges."""

import logging

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.mesh.grading import MAX_RATIO, graded_ticks, uniform_ticks


@given(
    length=st.floats(0.1, 100.0),
    count=st.integers(1, 500),
    places=st.lists(st.floats(-0.6, 0.6), min_size=1, max_size=3),
    fineness=st.floats(1e-4, 1.0),
    band=st.floats(0.0, 0.1),
)
def test_any_request_gives_a_sound_line(length, count, places, fineness, band):
    size = fineness * length / count
    edges = [place * length for place in places]
    ticks = graded_ticks(length, count, edges, size, band * length)
    steps = np.diff(ticks)
    assert len(ticks) == count + 1
    assert ticks[0] == -length / 2
    assert ticks[-1] == length / 2
    assert (steps > 0).all()
    ratio = steps[1:] / steps[:-1]
    assert np.maximum(ratio, 1 / ratio).max(initial=1.0) <= MAX_RATIO * (1 + 1e-6)
    assert steps.min() >= size * (1 - 1e-6)


@pytest.mark.parametrize("edges", [(-5.0, 5.0), (1.0,), (-8.7, 8.7), (0.0, 0.3)])
@pytest.mark.parametrize("band", [0.0, 0.05])
def test_smallest_elements_lie_at_the_edges(edges, band):
    ticks = graded_ticks(17.45, 300, edges, 0.01, band)
    middle, steps = (ticks[1:] + ticks[:-1]) / 2, np.diff(ticks)
    for edge in edges:
        at = np.abs(middle - edge).argmin()
        # one element of growth at most between the size field's minimum and the element
        assert 0.01 * (1 - 1e-6) <= steps[at] <= 0.01 * MAX_RATIO
    inside = (np.abs(middle[:, None] - edges).min(axis=1)) < band - 0.01
    np.testing.assert_allclose(steps[inside], 0.01, rtol=1e-6)
    far = np.abs(middle[:, None] - edges).min(axis=1).argmax()
    assert steps[far] == pytest.approx(steps.max(), rel=0.2)
    assert steps.max() > 5 * steps.min()


def test_symmetric_edges_give_a_symmetric_line():
    ticks = graded_ticks(17.45, 301, (-5.0, 5.0), 0.01)
    np.testing.assert_allclose(ticks, -ticks[::-1], atol=1e-11)


def test_too_few_elements_raise_the_edge_size_and_say_so(caplog):
    with caplog.at_level(logging.WARNING):
        ticks = graded_ticks(17.45, 20, (-5.0, 5.0), 1e-3)
    assert np.diff(ticks).min() > 1e-3
    assert "mesh.along = 20 is too small for an edge size of 0.001" in caplog.text


def test_enough_elements_everywhere_need_no_grading():
    ticks = graded_ticks(10.0, 100, (2.0,), 0.2)
    np.testing.assert_allclose(np.diff(ticks), 0.1)


@pytest.mark.parametrize("ratio", [0.2, 1.0, 3.0])
def test_geometric_line(ratio):
    steps = np.diff(uniform_ticks(7, ratio))
    assert steps.sum() == pytest.approx(1.0, abs=1e-15)
    assert steps[-1] / steps[0] == pytest.approx(ratio)
    np.testing.assert_allclose(steps[1:] / steps[:-1], ratio ** (1 / 6))
