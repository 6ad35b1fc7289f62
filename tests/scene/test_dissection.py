"""The counted factorisation has the limits that theory gives it."""

import pytest

from porolub.scene.dissection import factors

SCALAR = ((1, 1),)
POROUS = ((3, 2), (2, 1))


def growth(small: tuple[int, ...], large: tuple[int, ...]) -> tuple[float, float]:
    one, two = factors(small, SCALAR), factors(large, SCALAR)
    return two.entries / one.entries, two.operations / one.operations


def test_one_element_is_a_dense_matrix() -> None:
    n = 3 * 27 + 2 * 8
    assert factors((1, 1, 1), POROUS).entries == n * n
    assert factors((1, 1, 1), POROUS).operations == pytest.approx(2 / 3 * n**3)


def test_a_line_of_elements_grows_with_its_length() -> None:
    """Each front of a chain is as large as the last."""
    entries, operations = growth((256,), (1024,))
    assert entries == pytest.approx(4.0, rel=0.03)
    assert operations == pytest.approx(4.0, rel=0.03)


def test_in_the_plane_entries_grow_as_n_log_n_and_operations_as_the_side_cubed() -> None:
    entries, operations = growth((512, 512), (1024, 1024))
    assert 4.0 < entries < 4.0 * 10 / 8
    assert operations == pytest.approx(8.0, rel=0.1)


def test_in_space_they_grow_with_the_fourth_and_sixth_power_of_the_side() -> None:
    entries, operations = growth((64, 64, 64), (128, 128, 128))
    assert entries == pytest.approx(16.0, rel=0.15)
    assert operations == pytest.approx(64.0, rel=0.1)


@pytest.mark.parametrize("deep", [1, 4])
def test_a_thin_layer_is_between_plane_and_space(deep: int) -> None:
    """Long and thin: in proportion to the length; wide and thin: as in the plane."""
    entries, operations = growth((256, 4, deep), (1024, 4, deep))
    assert entries == pytest.approx(4.0, rel=0.05)
    assert operations == pytest.approx(4.0, rel=0.05)
    entries, operations = growth((256, 4, 256), (512, 4, 512))
    assert 4.0 < entries < 5.0
    assert operations == pytest.approx(8.0, rel=0.15)


def test_the_order_of_the_axes_does_not_matter() -> None:
    assert factors((7, 3, 5), POROUS) == factors((3, 5, 7), POROUS)
