"""The free space under a polygon, against upright lines and shapely."""

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from drystone.kernels.crevice import between, crevice
from drystone.kernels.polygons import no_polygons
from tests.naive.crevice import gap_at
from tests.polygons import box, moved
from tests.settle.piles import piles

CLEARANCE = 0.01


def extent(polygon):
    return float(polygon[:, 0].min()), float(polygon[:, 0].max())


def bodies(around):
    others = [shapely.Polygon(around.polygon(i)) for i in range(len(around))]
    return shapely.union_all([shapely.box(-100.0, -50.0, 200.0, 0.0), *others])


@given(piles(), st.lists(st.floats(0.001, 0.999), min_size=4, max_size=4))
def test_boundaries_are_what_upright_lines_meet(pile, shares):
    stone, around = pile
    space = crevice(stone, around, 0.0)
    left, right = extent(stone)
    for share in shares:
        x = left + share * (right - left)
        assume(np.abs(np.concatenate([stone, around.corners])[:, 0] - x).min() > 1e-6)
        floor, lid = gap_at(stone, around, x)
        found = [np.interp(x, *chain.T) for chain in (space.floor, space.lid)]
        assert found == pytest.approx([floor, lid], abs=1e-9)


@given(piles(), st.floats(0.0, 0.9), st.floats(0.02, 1.0), st.integers(0, 2**32 - 1))
def test_keeps_its_distance_and_gives_nothing_away(pile, start, run, seed):
    stone, around = pile
    left, right = extent(stone)
    x = left + start * (right - left)
    ends = x, min(x + run * (right - left), right)
    piece = between(crevice(stone, around, CLEARANCE), *ends)
    if piece is None:
        return
    shape = shapely.Polygon(piece)
    assert shape.is_valid
    assert shapely.LinearRing(piece).is_ccw
    assert extent(piece) == ends
    for body in (shapely.Polygon(stone), bodies(around)):
        assert shape.distance(body) >= 0.9999 * CLEARANCE
    # What is a little further from both, all around, belongs to it.
    rng = np.random.default_rng(seed)
    reach = 1.4143 * CLEARANCE
    around_it = reach * np.array([[np.cos(a), np.sin(a)] for a in np.arange(8) * np.pi / 4])
    inside = ends[0] + 2 * reach, ends[1] - 2 * reach
    for x in rng.uniform(*inside, 4) if inside[0] < inside[1] else ():
        floor, lid = gap_at(stone, around, x)
        point = np.array([x, rng.uniform(floor, lid)])
        gaps = [(p, gap_at(stone, around, p[0])) for p in point + around_it]
        if all(low < p[1] < high for p, (low, high) in gaps):
            assert shape.intersects(shapely.Point(point).buffer(1e-9))


def test_an_acute_corner_is_cut_off():
    """The tip of a stone below, 26.6 degrees: moved edges would meet 4.2 clearances from it."""
    spike = np.array([[3.0, 0.0], [5.0, 0.0], [4.0, 2.0]])
    space = crevice(box(0, 5, 8, 8), no_polygons().added([spike]), 0.1)
    top = space.floor[space.floor[:, 1] > 2.0]
    assert len(top) == 2
    assert shapely.distance(shapely.Polygon(spike), shapely.points(top)).max() < 0.1415
    assert shapely.distance(shapely.Polygon(spike), shapely.LineString(top)) >= 0.1


def test_only_what_is_met_first_counts():
    """A shelf hides what is below it; what is above the stone or in a hollow of it is not below."""
    shelf, lid, hidden = box(0, 3, 4, 4), box(0, 20, 9, 21), box(1, 0, 3, 2)
    arch = np.array([[0, 6], [2, 6], [2, 9], [6, 9], [6, 6], [8, 6], [8, 12], [0, 12]], float)
    in_it = box(3, 7, 5, 8)
    scene = no_polygons().added([shelf, lid, hidden, in_it])
    space = crevice(arch, scene, 0.0)
    assert space.floor.tolist() == [[0, 4], [3, 4], [3, 8], [5, 8], [5, 0], [8, 0]]
    assert space.lid.tolist() == [[0, 6], [2, 6], [2, 9], [6, 9], [6, 6], [8, 6]]


def test_no_piece_where_the_space_closes():
    stone = np.array([[0.0, 2.0], [3.0, 0.5], [6.0, 2.0], [6.0, 5.0], [0.0, 5.0]])
    # A stone that stands in another has no space there, though there is some further down.
    table = np.array([[0, 3], [6, 3], [6, 5], [0, 5]], float)
    # At one x the floor rises to the height down to which the lid falls.
    step = np.array([[0, 2], [3, 2], [3, 5], [6, 5], [6, 9], [0, 9]], float)
    for outline, others, right, clearance, there in (
        (stone, [], 5.5, 0.1, True),
        (stone, [], 5.5, 0.3, False),
        (stone, [], 2.0, 0.3, True),
        (moved(stone, 0.0, -0.6), [], 5.5, 0.0, False),
        (box(0.2, 4, 5, 7), [table], 4.0, 0.0, False),
        (box(0.2, 6, 5, 7), [table], 4.0, 0.0, True),
        (step, [box(3, 0, 7, 2)], 5.0, 0.0, False),
        (step, [box(3, 0, 7, 1.9)], 5.0, 0.0, True),
    ):
        space = crevice(outline, no_polygons().added(others), clearance)
        assert (between(space, 0.5, right) is not None) == there


def test_what_stands_just_beside_a_line_keeps_its_distance():
    """A post whose face is half a clearance left of the piece, and one beside the stone's end."""
    posts = no_polygons().added([box(0, 0, 2, 3), box(8.05, 0, 9, 3)])
    piece = between(crevice(box(0, 4, 8, 6), posts, 0.1), 2.05, 8.0)
    assert piece is not None
    assert shapely.Polygon(piece).distance(bodies(posts)) == pytest.approx(0.1)
