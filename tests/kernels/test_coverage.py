"""Shares of cells against the common area with every cell."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.coverage import coverage, newly_filled, windows
from tests.naive import coverage as naive
from tests.polygons import simple_polygons
from tests.strategies import repeatable

PLACES = st.one_of(
    st.integers(-4, 4).map(float), st.floats(-30, 30), st.sampled_from([-1e-300, 1e-9, 2e5 + 0.3])
)


@repeatable(120)
@given(polygon=simple_polygons(max_size=9.0), x=PLACES, y=PLACES)
def test_shares_are_the_areas_in_common_with_each_cell(polygon, x, y):
    corners = polygon + np.array([x, y])
    shares, left, bottom = coverage(corners)
    expected, *corner = naive.coverage(corners)
    assert (left, bottom) == tuple(corner)
    # Far from the origin the corners themselves have fewer digits.
    np.testing.assert_allclose(shares, expected, rtol=0, atol=1e-12 + 1e-15 * abs(x + 1j * y))


@pytest.mark.parametrize(("x", "y"), [(0, 0), (-7, 3), (120, -45)])
def test_cells_inside_are_full_and_cells_outside_empty_to_the_last_bit(x, y):
    angle = np.arange(50) * (2.0 * np.pi / 50)
    corners = np.column_stack([18.3 * np.cos(angle) + 0.1 + x, 11.7 * np.sin(angle) + 0.7 + y])
    shares, left, bottom = coverage(corners)
    shape = shapely.Polygon(corners)
    rows, cols = np.indices(shares.shape)
    top = bottom + len(shares) - rows
    cells = shapely.box(left + cols, top - 1, left + cols + 1, top)
    assert ((shares == 1.0) == shapely.contains(shape, cells)).all()
    assert ((shares == 0.0) == (shapely.area(shapely.intersection(shape, cells)) < 1e-12)).all()


@pytest.mark.parametrize("size", [1e-3, 1e-9, 1e-160])
def test_a_speck_has_one_cell(size):
    shares, left, bottom = coverage(size * np.array([[0.1, 0.2], [0.9, 0.2], [0.5, 0.8]]))
    assert (shares.shape, left, bottom) == ((1, 1), 0, 0)
    assert shares[0, 0] == pytest.approx(0.24 * size**2, abs=1e-12)


def test_what_is_no_polygon_is_refused():
    for corners in ([[0.0, 0.0], [1.0, 0.0]], [[0.0, 0.0, 1.0]] * 3, [0.0, 1.0, 2.0]):
        with pytest.raises(ValueError, match="three corners"):
            coverage(np.array(corners))
    for wrong in (np.nan, -np.inf):
        with pytest.raises(ValueError, match="finite"):
            coverage(np.array([[0.0, 0.0], [1.0, wrong], [0.0, 1.0]]))


@st.composite
def scenes(draw):
    """Shares on a grid, sums of quarters often, and those of a block."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    shape = draw(st.tuples(st.integers(1, 9), st.integers(1, 9)))
    total, shares = rng.uniform(0.0, 1.0, (2, *shape))
    if draw(st.booleans()):
        total, shares = np.floor(4.0 * total) / 4.0, np.floor(4.0 * shares) / 4.0
    return total, shares * draw(st.sampled_from([1.0, 0.5, 0.1]))


@repeatable(200)
@given(scene=scenes())
def test_newly_filled_cells_are_those_that_turn_to_half(scene):
    expected, found = naive.newly_filled(*scene), newly_filled(*scene)
    if found is None:
        assert not expected
        return
    mask, row, col = found
    assert {(row + i, col + j) for i, j in np.argwhere(mask).tolist()} == expected
    assert mask[[0, -1]].any(axis=1).all()
    assert mask[:, [0, -1]].any(axis=0).all()


def test_half_is_filled_but_for_rounding():
    third = np.full((1, 1), 1.0 / 3.0)
    assert newly_filled(third, np.full((1, 1), 0.5 - 1.0 / 3.0 - 1e-13)) is not None


@repeatable(100)
@given(
    grid=st.tuples(st.integers(0, 6), st.integers(0, 6)),
    shape=st.tuples(st.integers(0, 6), st.integers(0, 6)),
    row=st.integers(-9, 9),
    col=st.integers(-9, 9),
)
def test_windows_are_what_both_have(grid, shape, row, col):
    cells = np.arange(grid[0] * grid[1]).reshape(grid)
    inside, part = windows(grid, shape, row, col)
    wide = np.pad(cells, 20, constant_values=-1)
    seen = wide[20 + row : 20 + row + shape[0], 20 + col : 20 + col + shape[1]]
    np.testing.assert_array_equal(cells[inside], seen[part])
    assert cells[inside].size == (seen >= 0).sum()
