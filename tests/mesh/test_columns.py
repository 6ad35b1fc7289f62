"""Numbers and owners of a tensor grid's nodes, and how evenly its columns are shared out."""

import tracemalloc
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porolub.mesh import lattice
from porolub.mesh.columns import Columns, rank_grid
from porolub.mesh.shape import Block
from porolub.mesh.structured import structured

COUNTS = st.integers(2, 3).flatmap(
    lambda dim: st.tuples(*[st.integers(1, 7 if dim == 2 else 5)] * dim)
)


def all_nodes(counts, degree):
    return lattice.nodes([0] * len(counts), [2 * n for n in counts], degree)


@given(COUNTS, st.integers(1, 2), st.data())
def test_nodes_of_any_box_are_counted_from_zero(counts, degree, data):
    low = np.array([data.draw(st.integers(0, 2 * n)) for n in counts])
    high = np.array([data.draw(st.integers(a, 2 * n)) for a, n in zip(low, counts, strict=True)])
    index = lattice.nodes(low.tolist(), high.tolist(), degree)
    np.testing.assert_array_equal(lattice.numbers(index, low, high), np.arange(len(index)))
    assert lattice.count(low, high, degree) == len(index) == len(np.unique(index, axis=0))
    full = np.zeros_like(low), 2 * np.array(counts)
    assert (np.diff(lattice.numbers(index, *full)) > 0).all()


@given(COUNTS, st.integers(1, 2))
def test_vertices_come_first_and_have_the_numbers_of_degree_one(counts, degree):
    index = all_nodes(counts, degree)
    vertices = int(np.prod(np.array(counts) + 1))
    assert (index[:vertices] % 2 == 0).all()
    np.testing.assert_array_equal(index[:vertices], all_nodes(counts, 1))
    assert len(index) == (vertices if degree == 1 else np.prod(2 * np.array(counts) + 1))


@given(COUNTS, st.integers(1, 2), st.integers(1, 9))
def test_each_node_has_one_owner_that_numbers_it_without_being_asked(counts, degree, ranks):
    columns = Columns(counts, ranks)
    index = all_nodes(counts, degree)
    owner = columns.owners(index)
    starts = columns.starts(degree)
    number = starts[owner] + lattice.numbers(index, *columns.owned(owner))
    np.testing.assert_array_equal(np.sort(number), np.arange(len(index)))
    for rank in range(ranks):
        mine = index[owner == rank]
        expected = starts[rank] + np.arange(len(mine))
        np.testing.assert_array_equal(number[owner == rank], expected)
        start, end = columns.box(rank)  # an owner has the node among those of its cells
        assert ((mine >= 2 * start) & (mine <= 2 * end)).all()


@pytest.mark.parametrize("ranks", [2, 4, 6])
@pytest.mark.parametrize(("counts", "most"), [((100, 8, 40), 1.03), ((36, 4, 24), 1.0)])
def test_ranks_have_equal_shares_of_cells_and_of_the_surface(counts, most, ranks):
    columns = Columns(counts, ranks)
    boxes = [columns.box(rank) for rank in range(ranks)]
    cells = np.array([np.prod(end - start) for start, end in boxes])
    facets = np.array([(end - start)[0] * (end - start)[2] for start, end in boxes])
    assert cells.sum() == np.prod(counts)
    assert facets.sum() == counts[0] * counts[2]
    assert cells.max() <= most * cells.mean()
    assert facets.max() <= most * facets.mean()
    owned = lattice.count(*columns.owned(np.arange(ranks)), 2)
    assert owned.max() <= 1.06 * owned.mean()


@pytest.mark.parametrize(
    ("along", "deep", "ranks", "expected"),
    [
        (100, 40, 2, (2, 1)),
        (100, 40, 6, (3, 2)),
        (100, 40, 16, (4, 4)),
        (40, 100, 6, (2, 3)),
        (64, 64, 16, (4, 4)),
        (300, 1, 8, (8, 1)),
        (4, 60, 10, (1, 10)),
    ],
)
def test_parts_are_even_and_near_square_on_the_surface(along, deep, ranks, expected):
    assert rank_grid(along, deep, ranks) == expected


def test_a_part_of_a_mesh_of_half_a_billion_nodes_costs_what_the_part_costs():
    """Rank 12345 of 100000 makes its own columns; its neighbour agrees on what they share."""
    counts, ranks, rank = (2000, 16, 2000), 100_000, 12_345
    ticks = [np.linspace(0.0, 1.0, n + 1) for n in counts]
    columns = Columns(counts, ranks)
    assert np.prod(2 * np.array(counts, dtype=float) + 1) > 5e8
    below = columns.owners(2 * columns.box(rank)[0][None])[0]
    assert below != rank

    def part(number):
        of = SimpleNamespace(rank=number, size=ranks)
        return structured(Block(20.0, 1.0, 20.0), ticks, of, 2)

    tracemalloc.start()
    mine = part(rank)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(mine.cells) == 16 * 8 * 5
    assert peak < 64e6
    other = part(below)
    shared, here, there = np.intersect1d(
        mine.natural_node, other.natural_node, return_indices=True
    )
    assert len(shared) > 0
    np.testing.assert_array_equal(mine.global_node[here], other.global_node[there])
    np.testing.assert_array_equal(mine.coordinates[here], other.coordinates[there])
    assert not (mine.owned[here] & other.owned[there]).any()
