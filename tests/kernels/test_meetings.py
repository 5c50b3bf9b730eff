"""Contacts of a placed polygon: against what shapely measures, and by hand."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from drystone.kernels.meetings import meetings
from drystone.kernels.polygons import no_polygons, turn
from tests.polygons import box_of, simple_polygons
from tests.strategies import repeatable

TOLERANCE = 0.1

brick = box_of(0.0, 0.0)
spike = np.array([[0.0, 0.0], [5.0, 30.0], [-5.0, 30.0]])
notch = np.array([[-40.0, 5.0], [40.0, 5.0], [40.0, 80.0], [0.0, 40.0], [-40.0, 80.0]])
diamond = turn(box_of(0.0, 0.0, 20.0), 45.0)


def at(x, y):
    return np.array([x, y])


def told(corners, *others, tolerance=TOLERANCE, ndigits=6):
    """The contacts as tuples (other, points, normal), rounded."""
    found = meetings(corners, no_polygons().added(others), tolerance)
    points = [p[:n] for p, n in zip(found.points, found.counts, strict=True)]
    return [
        (other, np.round(p, ndigits).tolist(), (np.round(normal, ndigits) + 0.0).tolist())
        for other, p, normal in zip(found.others.tolist(), points, found.normals, strict=True)
    ]


@st.composite
def pairs(draw):
    """Two polygons up in the air with a gap of .001 to .12 between them."""
    other, corners = 10.0 * draw(simple_polygons()), 10.0 * draw(simple_polygons())
    angle = draw(st.sampled_from([0.0, np.pi / 2, np.pi]) | st.floats(0.0, 6.28))
    gap = draw(st.sampled_from([0.01, 0.02, 0.05]) | st.floats(0.001, 0.12))
    direction, solid = np.array([np.cos(angle), np.sin(angle)]), shapely.Polygon(other)

    def too_far(away):
        return shapely.Polygon(corners + away * direction).distance(solid) - gap

    up = np.array([draw(st.floats(-30.0, 30.0)), 600.0])
    return corners + brentq(too_far, 0.0, 1000.0) * direction + up, other + up


@given(pairs())
@repeatable(120)
def test_a_contact_is_where_the_gap_is(pair):
    corners, other = pair
    ring, solid = shapely.LinearRing(corners), shapely.Polygon(other)
    found = meetings(corners, no_polygons().added([other]), TOLERANCE)
    gap = ring.distance(solid)
    assert len(found.others) > 0 or gap > 0.99 * TOLERANCE
    assert len(found.others) == 0 or gap < 1.01 * TOLERANCE
    for count, points, normal in zip(found.counts, found.points, found.normals, strict=True):
        assert np.hypot(*normal) == pytest.approx(1.0, abs=1e-12)
        assert count == 2 or (points[0] == points[1]).all()
        for point in points[:count]:
            here = shapely.Point(point)
            assert here.distance(ring) < 1e-9
            assert here.distance(solid) < 1.01 * TOLERANCE
            nearest = shapely.get_coordinates(shapely.shortest_line(solid, here))[0]
            assert normal @ (point - nearest) > -0.051 * TOLERANCE


def test_the_ground_comes_first_then_others_in_their_order():
    # A neighbour on each side, and one that stands on top.
    found = told(
        brick + at(0.0, 0.01),
        brick + at(40.01, 0.01),
        brick + at(300.0, 0.01),
        brick + at(-10.0, 20.02),
        brick + at(-40.01, 0.01),
    )
    assert found == [
        (-1, [[0.0, 0.01], [40.0, 0.01]], [0.0, 1.0]),
        (0, [[40.0, 0.01], [40.0, 20.01]], [-1.0, 0.0]),
        (2, [[30.0, 20.01], [0.0, 20.01]], [0.0, -1.0]),
        (3, [[0.0, 20.01], [0.0, 0.01]], [1.0, 0.0]),
    ]
    # With one polygon they are in order along the placed one.
    comb = np.array([[0, 0], [90, 0], [90, 20], [60, 20], [60, 10], [30, 10], [30, 20], [0, 20.0]])
    plank = box_of(0.0, 0.0, 90.0, 5.0)
    assert [p for _, p, _ in told(comb + at(0.0, 50.0), plank + at(0.0, 70.01))] == [
        [[90.0, 70.0], [60.0, 70.0]],
        [[30.0, 70.0], [0.0, 70.0]],
    ]
    # And where the edge of the placed one is the long one, along this edge.
    assert [p for _, p, _ in told(plank + at(0.0, 70.01), comb + at(0.0, 50.0))] == [
        [[0.0, 70.01], [30.0, 70.01]],
        [[60.0, 70.01], [90.0, 70.01]],
    ]


LOW, UP = brick + at(0.0, 30.0), [0.0, 1.0]
LEFT, RIGHT = [-(0.5**0.5), 0.5**0.5], [0.5**0.5, 0.5**0.5]
TIP = np.array([[-5.0, 30.0], [5.0, 30.0], [0.0, 60.0]])
HOLLOW = np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [10.0, 0.05], [0.0, 20.0]])
PEAK = np.array([[-10.0, 10.0], [10.0, 10.0], [10.0, 30.0], [0.0, 30.3], [-10.0, 30.0]])


@pytest.mark.parametrize(
    ("corners", "others", "contacts"),
    [
        # On the ground, whichever corner is the first; and out of reach.
        *(
            (np.roll(brick, first, axis=0) + at(0.0, gap), [], [(-1, [[0, gap], [40, gap]], UP)])
            for first, gap in ((0, -0.05), (2, 0.0), (0, 0.01), (2, 0.099))
        ),
        (brick + at(0.0, 0.101), [], []),
        (brick + at(0.0, 30.0), [brick + at(0.0, 50.11), brick + at(40.11, 30.0)], []),
        # Half a brick on a brick; an overlap shorter than the tolerance is one point.
        (brick + at(20.0, 50.01), [LOW], [(0, [[20.0, 50.01], [40.0, 50.01]], UP)]),
        (brick + at(39.85, 50.01), [LOW], [(0, [[39.85, 50.01], [40.0, 50.01]], UP)]),
        (brick + at(39.95, 50.01), [LOW], [(0, [[39.95, 50.01]], UP)]),
        # Corners beside each other touch on the face that separates them most; .113 is too far.
        (brick + at(40.005, 50.02), [LOW], [(0, [[40.005, 50.02]], UP)]),
        (brick + at(40.05, 50.02), [LOW], [(0, [[40.05, 50.02]], [1.0, 0.0])]),
        (brick + at(40.08, 50.08), [LOW], []),
        # An edge that ends just beyond a spike: the point is on the edge, over the tip.
        (brick + at(-0.05, 60.01), [TIP], [(0, [[0.0, 60.01]], UP)]),
        (brick + at(-39.95, 60.01), [TIP], [(0, [[0.0, 60.01]], UP)]),
        # Corners that no face separates do not touch.
        (spike[::-1] * [1.0, -1.0] + at(40.05, 50.05), [LOW], []),
        # A spike on a face, on the ground, and a face on a spike.
        (spike + at(10.0, 50.03), [LOW], [(0, [[10.0, 50.03]], UP)]),
        (spike + at(10.0, 0.03), [], [(-1, [[10.0, 0.03]], UP)]),
        (brick + at(0.0, 10.0), [spike + at(10.0, 30.02)], [(0, [[10.0, 30.0]], [0.0, -1.0])]),
        # The bottom touches all along; the dent, .05 above it, does not.
        (HOLLOW + at(0.0, 50.01), [LOW], [(0, [[0.0, 50.01], [20.0, 50.01]], UP)]),
        # A spike in a notch touches both faces at one point.
        (
            spike + at(0.0, 40.014),
            [notch],
            [(0, [[0.0, 40.014]], LEFT), (0, [[0.0, 40.014]], RIGHT)],
        ),
        # Edges at an angle touch at the corner, however short they are.
        *(
            (turn(flat, angle) + at(0.2, 50.01), [LOW], [(0, [[0.2, 50.01]], UP)])
            for flat in (brick, brick / [80.0, 1.0])
            for angle in (2.9, 60.0)
        ),
    ],
)
def test_contacts_by_hand(corners, others, contacts):
    found = told(corners, *others)
    assert [contact[:2] for contact in found] == [contact[:2] for contact in contacts]
    assert [n for _, _, n in found] == [[round(x, 6) for x in n] for _, _, n in contacts]


def test_of_equal_faces_the_level_one_is_taken_also_when_rounding_says_otherwise():
    for right in (40.02, 40.0202, 40.0198):
        assert told(brick + at(right, 50.02), LOW) == [(0, [[right, 50.02]], UP)]
        left = round(40 - right, 6)
        assert told(brick + at(-right, 50.02), LOW) == [(0, [[left, 50.02]], UP)]


def test_a_face_shrinks_to_its_corner_without_a_jump():
    lengths = []
    for angle in np.linspace(0.0, 3.2, 3201):
        ((_, points, _),) = told(turn(brick, angle) + at(0.5, 50.01), brick + at(0.0, 30.0))
        assert points[0] == [0.5, 50.01] or len(points) == 1
        lengths.append(np.hypot(*np.subtract(points[-1], points[0])))
    assert lengths[0] == pytest.approx(39.5)
    assert [lengths[50], lengths[500]] == pytest.approx([39.5, 8.313], rel=0.1)
    assert lengths[-1] == 0.0
    steps = np.diff(lengths)
    assert steps.max() <= 1e-6
    # What is shorter than the tolerance is a point.
    assert steps.min() > -1.0


@pytest.mark.parametrize("lean", [-0.4, 0.4])
def test_the_normal_is_that_of_the_edge_under_the_nearer_end(lean):
    long, short = brick * [3.0, 1.0] - at(60.0, 0.0), brick * [0.1, 1.0] - at(2.0, 0.0)
    own = turn(np.array([[0.0, 1.0]]), lean)[0].tolist()
    up = 50.01 if lean > 0.0 else 50.13
    for upper, lower, expected in (
        (turn(short, lean) + at(0.0, 70.04), long + at(0.0, 50.0), UP),
        (turn(long, lean) + at(0.0, 70.04), short + at(0.0, 50.0), own),
        # Half a brick further: one end is a corner of the upper one, the other of the lower one.
        (turn(brick, lean) + at(20.0, up), LOW, UP if lean > 0.0 else own),
    ):
        ((_, _, normal),) = told(upper, lower)
        assert normal == pytest.approx(expected, abs=1e-6)


def test_a_notch_is_touched_on_both_faces_and_a_flat_bend_is_told_once():
    found = told(diamond + at(0.0, 40.0142), notch, ndigits=3)
    assert [(len(p), n) for _, p, n in found] == [(2, [-0.707, 0.707]), (2, [0.707, 0.707])]
    ((_, points, normal),) = told(spike + at(0.0, 30.31), PEAK)
    assert points == [[0.0, 30.31]]
    assert normal[1] > 0.999
    shallow = PEAK + np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 0.3], [0.0, -0.3], [0.0, 0.3]])
    assert len(told(spike + at(0.0, 30.02), shallow)) == 1


FOOT, BESIDE = brick + at(0.0, 0.01), brick + at(40.01, 0.01)
SETTLED = [
    (FOOT, []),
    (brick + at(40.01, 20.02), [FOOT, BESIDE, brick + at(0.0, 20.02)]),
    *((turn(brick, angle) + at(0.0, 20.02), [FOOT]) for angle in (0.0, 0.03, 3.0)),
    (turn(brick, -3.0) + at(0.0, 25.0), [brick * [2.0, 1.0] + at(0.0, 0.01)]),
    (diamond + at(0.0, 40.0142), [notch]),
    (spike + at(0.0, 40.0142), [notch]),
    (spike + at(40.0, 20.02), [FOOT, BESIDE]),
]


@pytest.mark.parametrize(("corners", "others"), SETTLED)
def test_nothing_jumps_when_a_stone_hardly_moves(corners, others):
    around = no_polygons().added(others)
    still = meetings(corners, around, TOLERANCE)
    rng = np.random.default_rng(1)
    centre = corners.mean(axis=0)
    for _ in range(40):
        moved = turn(corners - centre, rng.uniform(-1e-9, 1e-9)) + centre
        found = meetings(moved + rng.uniform(-1e-9, 1e-9, 2), around, TOLERANCE)
        assert found.others.tolist() == still.others.tolist()
        assert found.counts.tolist() == still.counts.tolist()
        assert found.points == pytest.approx(still.points, abs=1e-6)
        assert found.normals == pytest.approx(still.normals, abs=1e-6)


def test_bad_input():
    for corners in (brick[:2], brick.ravel()):
        with pytest.raises(ValueError, match="three corners"):
            meetings(corners, no_polygons(), 0.1)
    for tolerance in (0.0, -1.0, float("nan")):
        with pytest.raises(ValueError, match="above 0"):
            meetings(brick, no_polygons(), tolerance)
