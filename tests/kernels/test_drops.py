"""Height profiles against polygons cut into columns, stones dropped onto them against loops."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels import drops as module
from drystone.kernels.drops import DropTerms, Wanted
from drystone.kernels.profiles import HeightProfile, bare, extremes, hanging, in_a_row, raised
from tests.naive.drops import all_drops, column_span, height_profile
from tests.polygons import box_of, moved, random_polygon, simple_polygons
from tests.strategies import repeatable

CELLS = st.sampled_from([0.5, 1.0, 2.0, 1 / 0.35, 40.0])
# GEOS cuts wrongly at 1e-307.
LEFTS = st.floats(-20.0, 20.0).map(lambda x: round(x, 9))


@given(polygon=simple_polygons(), cell=CELLS, left=LEFTS)
def test_extremes_are_those_of_the_polygon_cut_into_columns(polygon, cell, left):
    columns = 9
    bottoms, tops = extremes(polygon, left, cell, columns)
    for column, low, high in zip(range(columns), bottoms, tops, strict=True):
        span = column_span(polygon, left + column * cell, left + (column + 1) * cell)
        assert (low, high) == pytest.approx(span or (np.inf, -np.inf), abs=1e-8)


@given(data=st.data(), cell=CELLS)
def test_a_profile_is_raised_where_a_polygon_is_higher(data, cell):
    at = st.tuples(st.floats(-10.0, 40.0).map(lambda x: round(x, 6)), st.floats(0.0, 20.0))
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
    assert profile.boxes.tolist() == [list(map(float, box)) for box in boxes]


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
    assert np.isfinite([stone.bottoms, stone.tops]).all()
    for column, (low, high) in enumerate(zip(stone.bottoms, stone.tops, strict=True)):
        x = np.linspace(left + column * cell, min(right, left + (column + 1) * cell), 7)[1:-1]
        for at in x:
            span = column_span(polygon, at - 1e-6, at + 1e-6)
            assert span is None or low - 1e-8 <= span[0] <= span[1] <= high + 1e-8


def test_profiles_at_the_edges_of_columns_and_of_heights():
    # Columns into which a polygon reaches by little are not under it.
    for reach, taken in ((0.0, [1, 2]), (1e-10, [1, 2]), (0.49, [1, 2]), (0.51, [0, 1, 2, 3])):
        profile = raised(bare(6), box_of(2.0 - reach, 0.0, 4.0 + 2 * reach, 3.0), 0, 2.0)
        assert profile.tops.tolist() == [3.0 * (column in taken) for column in range(6)]
    # Of equal heights the first owns the column, and the ground before all.
    profile = raised(bare(2), box_of(0.0, 0.0, 4.0, 3.0), 0, 2.0)
    profile = raised(profile, box_of(2.0, 1.0, 2.0, 2.0), 1, 2.0)
    assert profile.owners.tolist() == [0, 0]
    assert raised(bare(1), box_of(0.0, -1.0, 1.0, 1.0), 0, 2.0).owners.tolist() == [-1]
    # What is beside the columns is ignored.
    for left in (-1e300, -50.0, 50.0, 1e300):
        assert not raised(bare(4), box_of(left, 0.0, 3.0, 3.0), 0, 2.0).tops.any()
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


def drops(profile, stone, terms, constant, count, apart_px):
    wanted = Wanted(count, np.array([apart_px]), np.array([7]))
    places, limit = module.drops(profile, in_a_row([stone]), terms, np.array([constant]), wanted)
    assert limit == np.inf
    return places[0]


def terms_of(**changes):
    """A wall of 40 x 20 px, nothing of which the others could fill; only what is given costs."""
    terms = DropTerms(
        2.0, 40.0, 20.0, 0.0, 0.0, 5.0, 4.0, 32.0, *[0.0] * 8, np.arange(21), np.arange(11)
    )
    return terms._replace(**changes)


@st.composite
def batches(draw, fewest=0):
    """A wall of a few stones that were dropped at random, some others, and random weights.

    The others are in groups, of whose drops so many are wanted.  Half the walls and half the
    others are bricks on the grid, which makes equal costs.  Some profiles are read from the end.
    """
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    cell = draw(st.sampled_from([0.5, 1.0, 2.0, 1 / 0.35]))
    columns = draw(st.integers(1, 30))
    bricks = draw(st.booleans())
    profile = bare(columns)
    for index in range(draw(st.integers(0, 7))):
        polygon = _stone(rng, cell, bricks)
        hung = hanging(polygon, cell)
        n = len(hung.bottoms)
        if n <= columns:
            place = int(rng.integers(0, columns - n + 1))
            lift = float((profile.tops[place : place + n] - hung.bottoms).max())
            profile = raised(profile, moved(polygon, place * cell - hung.left, lift), index, cell)
    if draw(st.booleans()):
        backwards = (part[::-1].copy()[::-1] for part in profile[:2])
        profile = HeightProfile(*backwards, profile.boxes)
    weights = rng.choice([0.0, 0.5, 1.5], 8)
    if draw(st.integers(0, 3)) == 0:
        weights[rng.integers(0, 8)] = -0.5
    high = float(max(profile.tops.max(), 4.0 * cell))
    rest = rng.integers(0, 9, (2, 40))
    terms = DropTerms(
        cell,
        (columns - draw(st.sampled_from([0.0, 0.4]))) * cell,
        high * draw(st.sampled_from([0.7, 1.3, 2.0])),
        draw(st.sampled_from([0.0, 1.0])) * cell,
        draw(st.sampled_from([0.0, 0.02])),
        *(rng.choice([0.5, 3.0]) * cell, 4.0 * cell, 16.0 * cell**2),
        *weights.tolist(),
        rest[0, : draw(st.integers(1, 40))],
        rest[1, : draw(st.integers(1, 40))],
    )
    bricks, size = draw(st.booleans()), draw(st.integers(0, 8))
    stones = [hanging(_stone(rng, cell, bricks), cell) for _ in range(size)]
    wanted = Wanted(
        draw(st.integers(0, 5)),
        rng.choice([0.0, 1.0, 3.5, 5.0], size) * cell,
        rng.integers(0, 3, size),
        draw(st.integers(fewest, 12)),
        draw(st.integers(1, 4)),
    )
    return profile, stones, terms, rng.choice([-2.0, 0.0, 0.5, 3.0], size), wanted


def _stone(rng, cell, brick):
    if brick:
        width, height = rng.integers(1, 7, 2) * cell
        return box_of(-width / 2, -height / 2, width, height)
    return random_polygon(rng, int(rng.integers(3, 12)), float(rng.uniform(1.5, 12.0)) * cell)


@repeatable(80)
@given(batch=batches())
def test_the_cheapest_places_of_each_stone_are_those_of_a_loop_over_all(batch):
    """Of equal costs the lower one comes first, then the one further left."""
    profile, stones, terms, constants, wanted = batch
    row, wanted = in_a_row(stones), wanted._replace(cheapest=0)
    everywhere = wanted._replace(spots=len(profile.tops), apart_px=np.zeros(len(stones)))
    every, _ = module.drops(profile, row, terms, constants, everywhere)
    places, limit = module.drops(profile, row, terms, constants, wanted)
    assert limit == np.inf
    for stone, left, found, constant, apart_px in zip(
        stones, every, places, constants, wanted.apart_px, strict=True
    ):
        rows = left.tolist()
        assert rows == sorted(rows, key=lambda one: (one[2], one[1], one[0]))
        free = {x: told for x, *told in rows}
        for place, drop in enumerate(all_drops(profile, stone, terms, constant)):
            if drop is not None:
                lift, cost, lean = drop
                y, *told = free.pop(place * terms.cell_px)
                assert y == lift + terms.clearance_px
                assert told == pytest.approx((cost, lean), abs=1e-9)
        assert free == {}
        expected, apart = [], max(1, round(apart_px / terms.cell_px, 9)) * terms.cell_px
        for one in rows:
            if all(abs(one[0] - other[0]) >= apart - 1e-9 for other in expected):
                expected.append(one)
        assert found.tolist() == expected[: wanted.spots]


@repeatable(120)
@given(batch=batches(fewest=1))
def test_the_cheapest_drops_are_all_there_up_to_the_limit(batch):
    profile, stones, terms, constants, wanted = batch
    row = in_a_row(stones)
    every, _ = module.drops(profile, row, terms, constants, wanted._replace(cheapest=0))
    found, limit = module.drops(profile, row, terms, constants, wanted)
    costs = {}
    for mine, known, group in zip(found, every, wanted.groups.tolist(), strict=True):
        assert mine.tobytes() == known[: len(mine)].tobytes()
        assert (known[len(mine) :, 2] > limit + 1e-9).all()
        costs.setdefault(group, []).extend(known[:, 2].tolist())
    counting = sorted(c for group in costs.values() for c in sorted(group)[: wanted.each])
    full = len(counting) >= wanted.cheapest
    assert limit == (counting[wanted.cheapest - 1] if full else np.inf)


def foot(end):
    """What is 9 px high up to 14 and 2 px high from there to an end."""
    return [np.array([[10.0, 0.0], [end, 0.0], [end, 2.0], [14.0, 2.0], [14.0, 9.0], [10.0, 9.0]])]


LOW, HIGH, UNDER = box_of(0, 0, 10, 4), box_of(4, 4, 6, 3), box_of(14, 0, 20, 2)
ONE, TWO, THREE = box_of(14, 0, 8, 2), box_of(22, 0, 4, 2), box_of(26, 0, 8, 2)


@pytest.mark.parametrize(
    ("name", "x", "polygons", "cost"),
    [
        # The gap ends at what is as high as the middle of the stone.
        ("gap", 6.0, [box_of(0, 0, 4, 3)], 6 * 2 / 32),
        # A neighbour may end below the middle; of those that end at one place the highest counts.
        ("step", 16.0, foot(20.0), 1.0),
        ("step", 16.0, foot(20.1), 0.0),
        ("step", 10.0, [HIGH, LOW], 1.0),
        # A stone less than half a pixel up stands on the ground.
        ("joint", 16.0, [box_of(16, 0, 12, 0.9)], 0.5),
        ("joint", 16.0, [box_of(16, 0, 12, 1)], 1 - (1.0 + 8 / 12) / 2),
        # Joints up to the middle of the stone count; of equally near ones that of the first stone.
        ("joint", 16.0, [UNDER, box_of(8, 0, 6, 5)], 1 - (2 / 6 + 10 / 20) / 2),
        ("joint", 16.0, [ONE, THREE, TWO], 1 - (6 / 8 + 2 / 8) / 2),
        # What is a column and a half above something is not on it.
        ("unbalanced", 12.0, [box_of(10, 0, 4, 3)], 2 / 8),
        ("unbalanced", 12.0, [box_of(10, 0, 4, 2.9)], 0.0),
    ],
)
def test_costs_at_their_edges(name, x, polygons, cost):
    """Of a block of 8 x 6 px that comes down with its left end at x."""
    profile, stone = bare(20), hanging(box_of(-4, -3, 8, 6), 2.0)
    for index, polygon in enumerate(polygons):
        profile = raised(profile, polygon, index, 2.0)
    terms = terms_of(**{name: 1.0}, mean_height_px=1.0, height_px=40.0)
    places = {row[0]: row[2] for row in drops(profile, stone, terms, 0.0, 20, 0.0).tolist()}
    assert places[x] == cost


def test_a_stone_fits_between_the_ends_of_the_wall_and_below_its_height():
    for width, expected in ((38.0, [0.0, 2.0]), (40.0 + 1e-10, [0.0]), (40.1, [])):
        stone = hanging(box_of(-width / 2, -3.0, width, 6.0), 2.0)
        assert drops(bare(20), stone, terms_of(), 0.0, 9, 0.0)[:, 0].tolist() == expected
        assert drops(bare(19), stone, terms_of(), 0.0, 9, 0.0).shape == (len(expected[1:]), 4)
    for height, slack, fits in ((20, 0, 1), (21, 0, 0), (21, 1, 1)):
        # What stands out has no room over it.
        terms = terms_of(slack_px=slack, headroom=1.0)
        found = drops(bare(20), hanging(box_of(-4, -3, 8, height), 2.0), terms, 0.0, 1, 0.0)
        assert found[:, 2].tolist() == [0.0] * fits


def test_what_cannot_be_is_refused():
    stone, terms = hanging(box_of(-4, -3, 8, 6), 2.0), terms_of(joint=1.0)
    one, two = np.zeros(1), np.zeros(2)
    none = np.zeros(1, np.int64)
    for constants, wanted, words in (
        (two, Wanted(1, one, none), r"\[1, 2\] stones"),
        (one, Wanted(1, two, none), r"\[1, 2\] stones"),
        (one, Wanted(1, one, none[1:]), r"\[0, 1\] stones"),
        (one, Wanted(1, one, none, 3, 0), "0 of a group"),
    ):
        with pytest.raises(ValueError, match=words):
            module.drops(bare(20), in_a_row([stone]), terms, constants, wanted)
    tops, owners = np.zeros(20), np.full(20, 3, np.int32)
    with pytest.raises(ValueError, match="polygon 3"):
        drops(HeightProfile(tops, owners, np.zeros((3, 4))), stone, terms, 0.0, 1, 0.0)
    with pytest.raises(ValueError, match="19 tops have 20 owners"):
        drops(HeightProfile(tops[1:], owners, np.ones((4, 4))), stone, terms, 0.0, 1, 0.0)
    for name in ("rest_width_px", "rest_height_px"):
        nothing = terms._replace(**{name: np.zeros(0, np.int64)})
        with pytest.raises(ValueError, match="not known for any length"):
            drops(bare(20), stone, nothing, 0.0, 1, 0.0)
