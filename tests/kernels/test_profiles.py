"""Height profiles against cutting polygons into columns."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.profiles import bare, extremes, hanging, in_a_row, raised
from tests.naive.drops import column_span, height_profile
from tests.polygons import box_of, simple_polygons
from tests.strategies import repeatable

CELLS = st.sampled_from([0.5, 1.0, 2.0, 1 / 0.35, 40.0])
# GEOS cuts wrongly at 1e-307.
LEFTS = st.floats(-20.0, 20.0).map(lambda x: round(x, 9))


@repeatable(60)
@given(polygon=simple_polygons(), cell=CELLS, left=LEFTS)
def test_extremes_are_those_of_the_polygon_cut_into_columns(polygon, cell, left):
    columns = 9
    bottoms, tops = extremes(polygon, left, cell, columns)
    for column, low, high in zip(range(columns), bottoms, tops, strict=True):
        span = column_span(polygon, left + column * cell, left + (column + 1) * cell)
        assert (low, high) == pytest.approx(span or (np.inf, -np.inf), abs=1e-8)


@repeatable(60)
@given(data=st.data(), cell=CELLS)
def test_a_profile_is_raised_where_a_polygon_is_higher(data, cell):
    at = st.tuples(st.floats(-10.0, 40.0), st.floats(0.0, 20.0))
    polygons = [
        polygon + np.array(shift) - [0.0, polygon[:, 1].min()]
        for polygon, shift in data.draw(st.lists(st.tuples(simple_polygons(), at), max_size=4))
    ]
    profile = bare(12)
    for index, polygon in enumerate(polygons):
        for part in profile:
            part.flags.writeable = False
        profile = raised(profile, polygon, index, cell)
    tops, owners = height_profile(polygons, 12, cell)
    assert profile.tops == pytest.approx(np.array(tops), abs=1e-8)
    assert profile.owners.dtype == np.int32
    assert profile.owners.tolist() == owners
    boxes = [[*polygon.min(axis=0), *polygon.max(axis=0)] for polygon in polygons]
    assert profile.boxes.tolist() == [[float(x) for x in box] for box in boxes]


@repeatable(40)
@given(polygon=simple_polygons(), cell=CELLS)
def test_a_hanging_polygon_starts_on_a_column_edge(polygon, cell):
    stone = hanging(polygon, cell)
    left, bottom = polygon.min(axis=0)
    right, top = polygon.max(axis=0)
    assert stone[2:] == (left, bottom, right, top)
    columns = (right - left) / cell
    assert len(stone.bottoms) == len(stone.tops) == max(1, np.ceil(columns - 0.25))
    if columns <= len(stone.bottoms):  # nothing is left out at the right end
        assert (stone.bottoms.min(), stone.tops.max()) == (bottom, top)
    assert np.isfinite(stone.bottoms).all()
    assert np.isfinite(stone.tops).all()
    for column in range(len(stone.bottoms)):
        x = np.linspace(left + column * cell, min(right, left + (column + 1) * cell), 7)[1:-1]
        for at in x:
            span = column_span(polygon, at - 1e-6, at + 1e-6)
            assert span is None or stone.bottoms[column] <= span[0] + 1e-8
            assert span is None or stone.tops[column] >= span[1] - 1e-8


@repeatable(20)
@given(polygons=st.lists(simple_polygons(), max_size=4))
def test_stones_in_a_row_are_those_one_after_the_other(polygons):
    stones = [hanging(polygon, 2.0) for polygon in polygons]
    row = in_a_row(stones)
    assert (row.bottoms.dtype, row.first.dtype) == (np.float64, np.int64)
    assert row.boxes.shape == (len(stones), 4)
    assert row.first[0] == 0
    assert row.first[-1] == len(row.bottoms)
    for k, stone in enumerate(stones):
        assert row.bottoms[row.first[k] : row.first[k + 1]].tolist() == stone.bottoms.tolist()
        assert tuple(row.boxes[k].tolist()) == stone[2:]


@pytest.mark.parametrize(
    ("reach", "taken"), [(0.0, [1, 2]), (1e-10, [1, 2]), (0.49, [1, 2]), (0.51, [0, 1, 2, 3])]
)
def test_a_polygon_is_not_over_columns_into_which_it_reaches_by_little(reach, taken):
    profile = raised(bare(6), box_of(2.0 - reach, 0.0, 4.0 + 2 * reach, 3.0), 0, 2.0)
    assert profile.tops.tolist() == [3.0 * (column in taken) for column in range(6)]


def test_of_equal_heights_the_first_owns_the_column():
    profile = raised(bare(2), box_of(0.0, 0.0, 4.0, 3.0), 0, 2.0)
    profile = raised(profile, box_of(2.0, 1.0, 2.0, 2.0), 1, 2.0)
    assert profile.owners.tolist() == [0, 0]
    assert raised(bare(1), box_of(0.0, -1.0, 1.0, 1.0), 0, 2.0).owners.tolist() == [-1]


def test_what_is_beside_the_columns_is_ignored():
    for left in (-1e300, -50.0, 50.0, 1e300):
        profile = raised(bare(4), box_of(left, 0.0, 3.0, 3.0), 0, 2.0)
        assert profile.tops.tolist() == [0.0] * 4
    profile = raised(bare(4), box_of(-3.0, 0.0, 20.0, 3.0), 0, 2.0)
    assert profile.tops.tolist() == [3.0] * 4
    assert profile.boxes.tolist() == [[-3.0, 0.0, 17.0, 3.0]]


@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_zeros_have_no_sign(zero):
    """Which of +0 and -0 is the smaller depends on the order."""
    standing = np.array([[0.0, zero], [2.0, -zero], [2.0, 3.0]])
    assert not np.signbit(extremes(standing, 0.0, 2.0, 1)[0]).any()
    hung = np.array([[0.0, -3.0], [2.0, zero], [0.0, -zero]])
    assert not np.signbit(extremes(hung, 0.0, 2.0, 1)[1]).any()


def test_a_polygon_needs_a_width_and_columns_too():
    with pytest.raises(ValueError, match="without width"):
        hanging(np.array([[1.0, 0.0], [1.0, 2.0], [1.0, 3.0]]), 2.0)
    for cell in (0.0, -1.0, float("nan")):
        with pytest.raises(ValueError, match="columns"):
            extremes(box_of(0.0, 0.0, 1.0, 1.0), 0.0, cell, 3)
    with pytest.raises(ValueError, match="shape"):
        extremes(np.zeros((3, 3)), 0.0, 1.0, 3)
    with pytest.raises(ValueError, match="polygon -1"):
        raised(bare(1), box_of(0.0, 0.0, 1.0, 1.0), -1, 1.0)
