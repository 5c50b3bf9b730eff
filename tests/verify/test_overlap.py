import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import affinity

from drystone.model.placement import Placement
from drystone.model.stone import Stone
from drystone.poses import PoseBook
from drystone.verify.overlap import SPACING_PX, deepest_overlap, overlap_depth, real_outline
from tests.strategies import repeatable


def box(x: float, y: float, width: float, height: float) -> shapely.Polygon:
    return shapely.box(x, y, x + width, y + height)


@pytest.mark.parametrize(
    ("first", "second", "depth"),
    [
        (box(0, 0, 4, 2), box(0, 2, 4, 2), 0.0),
        (box(0, 0, 4, 2), box(9, 2, 4, 2), 0.0),
        (box(0, 0, 4, 2), box(4, 2, 1, 1), 0.0),
        (box(0, 0, 4, 2), box(0, 1.75, 4, 2), 0.25),
        # A tip of 1 px in a large stone.
        (shapely.Polygon([(5, 4), (3, 9), (7, 9)]), box(0, 0, 10, 5), 1.0),
        # A stone wholly in another, and one on top of its like.
        (box(0, 0, 10, 10), box(4, 4, 2, 2), 4.0),
        (box(0, 0, 10, 10), box(0, 0, 10, 10), 5.0),
    ],
)
def test_depth_of_simple_shapes(
    first: shapely.Polygon, second: shapely.Polygon, depth: float
) -> None:
    assert overlap_depth(first, second) == pytest.approx(depth, abs=SPACING_PX / 2)
    assert overlap_depth(second, first) == pytest.approx(depth, abs=SPACING_PX / 2)


def _slow_depth(first: shapely.Polygon, second: shapely.Polygon, spacing: float) -> float:
    """The slow twin: points of each rim that lie in the other area; a grid for the circle."""
    depth = 0.0
    for one, other in ((first, second), (second, first)):
        for at in np.arange(0, one.exterior.length, spacing):
            point = one.exterior.interpolate(at)
            if other.contains(point):
                depth = max(depth, other.exterior.distance(point))
    x0, y0, x1, y1 = first.bounds
    for x in np.arange(x0, x1, 4 * spacing):
        for y in np.arange(y0, y1, 4 * spacing):
            point = shapely.Point(x, y)
            if first.contains(point) and second.contains(point):
                rims = (first.exterior.distance(point), second.exterior.distance(point))
                depth = max(depth, min(rims))
    return depth


@repeatable(25)
@given(st.floats(-3, 3), st.floats(-2.5, 2.5), st.floats(0, 90))
def test_depth_is_that_of_all_points_of_the_rims(dx: float, dy: float, turn: float) -> None:
    first = box(0, 0, 4, 3)
    second = affinity.rotate(box(dx, dy, 5, 2), turn)
    depth, slow = overlap_depth(first, second), _slow_depth(first, second, 0.05)
    # Both miss the deepest point of a rim by half the spacing, the grid by half its diagonal.
    assert slow - SPACING_PX <= depth <= slow + 0.15


def test_deepest_overlap_names_the_pair_in_source_px() -> None:
    book = PoseBook(0.5)
    stones = {i: Stone(i, np.ones((8, 16), bool)) for i in (4, 2, 9)}
    at = {4: (6, 0), 2: (2, 1), 9: (6, 7)}  # rows and columns of a site of 10 working px
    placements = [Placement(book.pose(stones[i], 0.0), *at[i]) for i in (4, 2, 9)]
    outlines = [(p.stone_id, real_outline(p, 10)) for p in placements]
    depth, pair = deepest_overlap(outlines)
    assert pair == (4, 9)
    assert depth == pytest.approx(2.0, abs=SPACING_PX)
    assert deepest_overlap(outlines[:2]) == (0.0, None)
    assert deepest_overlap([]) == (0.0, None)
