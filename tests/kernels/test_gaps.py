"""Gaps between polygons against shapely's distances."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.gaps import END, GROUND, crosses_any, gaps_around
from drystone.kernels.polygons import no_polygons, polygon_edges
from drystone.model.overlap import overlap_depth
from tests.naive.settling import distances, placed
from tests.polygons import moved as at
from tests.polygons import simple_polygons
from tests.strategies import repeatable

WIDTH = 60.0
SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


@st.composite
def scenes(draw):
    """A polygon among up to four others, apart or over each other, on a grid or not."""
    coarse = draw(st.booleans())

    def somewhere():
        x, y = (draw(st.integers(0, 30)) for _ in range(2))
        turn = 0.0 if coarse else draw(st.floats(-3.0, 3.0))
        shift = 0.0 if coarse else draw(st.floats(0.0, 1.0))
        return placed(draw(simple_polygons()), (15.0 + x + shift, 10.0 + y / 2.0, turn))

    others = [somewhere() for _ in range(draw(st.integers(0, 4)))]
    return np.ascontiguousarray(somewhere()), no_polygons().added(others)


def gaps(corners, others, reach, corner=0.0, beyond=0.0):
    around = no_polygons().added(list(others))
    edges = polygon_edges(corners)
    return gaps_around(corners, edges, around, WIDTH, reach, corner, beyond=beyond)


@repeatable(100)
@given(scenes())
def test_the_smallest_gap_is_the_distance_and_a_shift_along_its_normal_closes_it(scene):
    corners, around = scene
    expected, shape = distances(corners, around, WIDTH), shapely.Polygon(corners)
    found = gaps_around(corners, polygon_edges(corners), around, WIDTH, 8.0, 0.0)
    assert all(gap.gap <= 8.0 for gap in found)
    for number in range(len(around)):
        if not shape.intersects(shapely.Polygon(around.polygon(number))):
            near = min((gap.gap for gap in found if gap.other == number), default=8.0)
            assert near == pytest.approx(min(8.0, expected[number]), abs=1e-9)
    for number, own in ((GROUND, expected[-3:-2]), (END, expected[-2:])):
        near = [gap.gap for gap in found if gap.other == number]
        assert min(near, default=8.0) == pytest.approx(min(8.0, *own, math.inf), abs=1e-9)
    for gap in gaps_around(corners, polygon_edges(corners), around, WIDTH, 3.0, 0.3):
        assert math.hypot(gap.normal_x, gap.normal_y) == pytest.approx(1.0)
        assert gap.away >= gap.gap - 1e-9
        if gap.other < 0 or not gap.away == gap.gap > 1e-6:
            continue
        # The corner is the moving polygon's, or the other's: one way leads to the other one.
        own = np.hypot(*(corners - (gap.x, gap.y)).T).min() == 0.0
        other = shapely.Polygon(around.polygon(gap.other)).exterior
        target = other if own else shape.exterior
        way = -gap.gap if own else gap.gap
        end = shapely.Point(gap.x + way * gap.normal_x, gap.y + way * gap.normal_y)
        assert target.distance(end) == pytest.approx(0.0, abs=1e-9)


def test_both_ends_of_flush_faces_are_seen_from_both_sides():
    """Of bricks that lie exactly over each other no end is left to rounding."""
    found = gaps(at(SQUARE, 4.0, 3.25), [at(SQUARE, 4.0, 1.0)], 0.5)
    facing = {gap[:5] for gap in found}
    assert facing == {(0.25, 0.0, 1.0, x, y) for x in (4.0, 6.0) for y in (3.0, 3.25)}
    # What may stand out over the ends of the wall has its gaps there.
    for x, gap, normal_x in ((57.9, 0.35, -1.0), (-0.1, 0.15, 1.0)):
        found = gaps(at(SQUARE, x, 9.0), [], 0.5, beyond=0.25)
        assert [gap[:3] for gap in found] == 2 * [pytest.approx((gap, normal_x, 0.0))]


def test_no_overlap_is_missed_and_what_is_apart_does_not_cross():
    """What only touches may count either way: settled outlines keep a clearance."""
    seen = set()

    @repeatable(200)
    @given(scenes())
    def check(scene):
        corners, around = scene
        shape = shapely.Polygon(corners)
        others = [shapely.Polygon(around.polygon(i)) for i in range(len(around))]
        deep = any(overlap_depth(shape, other) > 1e-6 for other in others)
        if deep or not any(map(shape.intersects, others)):
            seen.add(deep)
            assert crosses_any(corners, around) == deep

    check()
    assert seen == {True, False}


def test_what_lies_inside_crosses_at_whatever_height():
    """Also where corners of both are at one height, as those of bricks are."""
    inside = 0

    @repeatable(100)
    @given(simple_polygons(), st.floats(0.1, 0.4))
    def check(outer, half):
        nonlocal inside
        for x, y in (outer + np.roll(outer, 1, axis=0)).tolist() + (outer * 0.5).tolist():
            inner = at((SQUARE - 1.0) * half, x / 2.0, y / 2.0)
            for level in (inner, at(inner, 0.0, outer[0, 1] - inner[0, 1])):
                shape, around = shapely.Polygon(level), shapely.Polygon(outer)
                if shapely.contains_properly(around, shape):
                    inside += 1
                    assert crosses_any(level, no_polygons().added([outer]))
                    assert crosses_any(outer, no_polygons().added([level]))
                elif around.disjoint(shape):
                    assert not crosses_any(level, no_polygons().added([outer]))

    check()
    assert inside > 100


def test_of_the_edges_around_a_corner_inside_only_the_nearest_counts():
    sliver = np.array([[0.0, 4.0], [20.0, 4.0], [20.0, 6.0], [0.0, 6.0]])
    found = gaps(np.array([[10.0, 5.7], [12.0, 9.0], [8.0, 9.0]]), [sliver], 3.5, 0.3)
    assert [(gap.gap, gap.normal_y) for gap in found if gap.gap < 0] == [(pytest.approx(-0.3), 1.0)]


@pytest.mark.parametrize(
    ("x", "normal"), [(2.99, (0.02, 0.0, 1.0)), (3.1, (0.1, 1.0, 0.0)), (-1.1, (0.1, -1.0, 0.0))]
)
def test_bricks_meet_with_the_face_that_parts_their_corners_best(x, normal):
    """On whichever side: the faces come in the order of the corners, not of merit."""
    brick, below = at(SQUARE, x + 9.0, 3.02), at(SQUARE, 10.0, 1.0)
    found = gaps(brick, [below], 0.5, 0.3)
    assert {(round(gap.gap, 9), *gap[1:3]) for gap in found} == {normal}
    if x != 2.99:  # the corners are further apart; far ones meet along what parts them
        assert {round(gap.away, 9) for gap in found} == {round(math.hypot(0.1, 0.02), 9)}
        assert all(gap.gap == gap.away for gap in gaps(brick, [below], 0.5, 0.05))


@pytest.mark.parametrize("tilted", [-1.0, 1.0])
def test_a_face_that_an_edge_at_the_corner_runs_through_parts_nothing(tilted):
    """A stone on its corner beside that of a brick lies over it: its own slope parts them best."""
    x = 12.1 if tilted > 0.0 else 9.9
    on_end = at(np.array([[0.0, 0.0], [2.0, 0.2], [0.0, 4.0], [-2.0, 0.2]]), x, 3.02)
    found = gaps(on_end, [at(SQUARE, 10.0, 1.0)], 0.3, 0.3)
    expected = np.array([0.06, tilted * 0.2, 2.0]) / math.hypot(0.2, 2.0)
    assert min(found)[:3] == pytest.approx(tuple(expected))
    assert all(abs(gap.normal_x) < 0.5 for gap in found)


def test_edges_without_length_change_nothing():
    doubled = np.repeat(SQUARE, [1, 2, 1, 3], axis=0)
    for shift in ((0.5, 3.1), (3.2, 3.3), (2.9, 3.05), (-1.0, 0.8), (0.5, 2.9)):
        with np.errstate(invalid="ignore"):
            found = gaps(SQUARE + shift, [doubled + 1.0], 1.0, 0.3)
        assert set(found) == set(gaps(SQUARE + shift, [SQUARE + 1.0], 1.0, 0.3))


def test_a_corner_on_an_edge_touches_it():
    # Rounding may put it on either side.
    corners = np.array([[1.0, 0.0], [0.1, 0.7], [-0.2, -0.4]])
    for share in np.linspace(0.01, 0.99, 99):
        touch = corners[0] + share * (corners[1] - corners[0])
        body = touch + np.array([[0.0, 0.0], [2.0, 1.3], [1.4, 1.9]])
        found = gaps(body + 5.0, [corners + 5.0], 0.5)
        assert min(gap.gap for gap in found) == pytest.approx(0.0, abs=1e-12)


def test_a_notch_has_no_region_behind_it_and_corners_in_one_point_meet():
    bent = np.array([[-9.0, 0.0], [0.0, -4.0], [9.0, 0.0], [9.0, 1.0], [0.0, -3.0], [-9.0, 1.0]])
    below = np.array([[0.0, -4.5], [-4.0, -9.0], [4.0, -9.0]])
    found = gaps(at(below, 20.0, 20.0), [at(bent, 20.0, 20.0)], 3.0)
    # Both outer corners see each other; the apex below is seen from the notch, too.
    assert sorted(gap.gap for gap in found) == [0.5, 0.5, 1.5]
    assert {gap[1:5] for gap in found} == {(0.0, -1.0, 20.0, 15.5)}
    # Corners in one point meet along the line between their edges.
    found = gaps(SQUARE + 7.0 + 1e-12, [SQUARE + 5.0], 1.0)
    half = math.sqrt(0.5)
    assert [gap[:3] for gap in found] == 2 * [pytest.approx((0.0, half, half))]
