import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.polygons import Points
from drystone.model.outlines import Outlines
from drystone.model.site import Site
from drystone.verify.pieces import lies_under, swept_upwards
from tests.polygons import simple_polygons
from tests.strategies import repeatable

TOP = 40.0


def box(left: float, bottom: float, right: float, top: float) -> Points:
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


def placed(*blocks: Points) -> Outlines:
    return Outlines.empty(Site(60, 40)).added(list(enumerate(blocks, 1)), 1.0)


@repeatable(30)
@given(simple_polygons(), st.integers(0, 2**31))
def test_sweep_is_everything_above_the_lowest_points(corners: Points, seed: int) -> None:
    """The slow twin: a point is passed when the ray downwards from it meets the polygon."""
    swept, polygon = swept_upwards(corners, TOP), shapely.Polygon(corners)
    left, low, right, high = polygon.bounds
    rng = np.random.default_rng(seed)
    for x, y in rng.uniform([left - 1, low - 1], [right + 1, high + 3], (60, 2)).tolist():
        ray = shapely.LineString([(x, y), (x, low - 2)])
        near = shapely.distance(swept.boundary, shapely.Point(x, y)) < 1e-6
        assert near or swept.contains(shapely.Point(x, y)) == ray.intersects(polygon)


@pytest.mark.parametrize(
    ("earlier", "expected"),
    [
        (box(2, 12, 8, 16), True),
        (box(2, -9, 8, -0.01), False),  # it stands on it
        (box(-5, -9, 15, 0.0), False),
        (box(-5, -9, 15, 0.04), False),  # as deep in its bed as it may be
        (box(-5, -9, 15, 0.2), True),
        (box(-9, 0, -0.01, 16), False),  # beside it, and higher
        (box(-9, 12, 0.9, 16), False),  # a sliver above it
        (box(-9, 12, 1.1, 16), True),
        (box(9.1, 12, 19, 16), False),
        (box(8.9, 12, 19, 16), True),
        (box(30, 12, 40, 16), False),
        (np.array([[4.0, 20.0], [9.0, 21.0], [3.0, 25.0]]), True),
    ],
)
def test_block_is_buried_by_what_is_wide_enough_above_it(earlier: Points, expected: bool) -> None:
    block = box(0, 0, 10, 10)
    assert lies_under(block, placed(earlier), 1.0) is expected
    # Others that are in nobody's way change nothing.
    assert lies_under(block, placed(box(0, -5, 10, -0.01), earlier), 1.0) is expected


def test_hook_over_what_is_there_can_be_lowered_and_under_it_cannot() -> None:
    arch = np.array([[0, 0], [2, 0], [2, 6], [8, 6], [8, 0], [10, 0], [10, 8], [0, 8]], float)
    assert not lies_under(arch, placed(box(3, 0, 7, 5.9)), 0.5)
    clamp = np.array([[0, 0], [10, 0], [10, 2], [2, 2], [2, 6], [10, 6], [10, 8], [0, 8]], float)
    assert lies_under(clamp, placed(box(3, 2.1, 20, 5.9)), 0.5)
    assert not lies_under(clamp, placed(), 0.5)
